// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/geometry/pose.hpp"
#include "prodomos/sensors/reading.hpp"

#include <cmath>
#include <numbers>
#include <vector>

/// What a level laser sees of upright walls.
namespace prodomos::test {

class FlatWorld {
 public:
  void addWall(const Eigen::Vector2d& from, const Eigen::Vector2d& to) { walls_.push_back({from, to}); }
  /// All four sides of a box, with x along it from its middle.
  void addBox(const geometry::Pose2& middle, double length, double thickness) {
    const Eigen::Vector2d along = 0.5 * length * Eigen::Vector2d(std::cos(middle.theta), std::sin(middle.theta));
    const Eigen::Vector2d across = 0.5 * thickness * Eigen::Vector2d(-std::sin(middle.theta), std::cos(middle.theta));
    const Eigen::Vector2d at(middle.x, middle.y);
    addWall(at - along - across, at + along - across);
    addWall(at - along + across, at + along + across);
    addWall(at - along - across, at - along + across);
    addWall(at + along - across, at + along + across);
  }

  /// Of a sensor at T_body_sensor (level) on a robot at T_world_body: 541 beams over 270 degrees, 1 cm of noise.
  sensors::LaserScan scan(const geometry::Pose2& T_world_body, base::Random* noise = nullptr,
                          const geometry::Pose3& T_body_sensor = level(0.35)) const {
    sensors::LaserScan scan;
    scan.T_body_sensor = T_body_sensor;
    scan.firstAngle = -0.75 * std::numbers::pi;
    scan.angleStep = 1.5 * std::numbers::pi / 540.0;
    scan.maxRange = 30.0;
    const auto T_world_sensor = T_world_body * geometry::toPose2(T_body_sensor);
    const Eigen::Vector2d from(T_world_sensor.x, T_world_sensor.y);
    for (int i = 0; i <= 540; ++i) {
      const double angle = T_world_sensor.theta + scan.firstAngle + i * scan.angleStep;
      double range = rangeAlong(from, {std::cos(angle), std::sin(angle)});
      if (noise != nullptr && std::isfinite(range)) range += noise->normal(0.0, 0.01);
      scan.ranges.push_back(static_cast<float>(range));
    }
    return scan;
  }

  static geometry::Pose3 level(double height) { return geometry::Pose3(Eigen::Translation3d(0.0, 0.0, height)); }

 private:
  struct Wall {
    Eigen::Vector2d from, to;
  };

  double rangeAlong(const Eigen::Vector2d& from, const Eigen::Vector2d& ray) const {
    double nearest = sensors::LaserScan::kNoReturn;
    for (const auto& wall : walls_) {
      const Eigen::Vector2d along = wall.to - wall.from;
      const Eigen::Vector2d between = wall.from - from;
      const double across = ray.x() * along.y() - ray.y() * along.x();
      if (std::abs(across) < 1e-12) continue;
      const double range = (between.x() * along.y() - between.y() * along.x()) / across;
      const double share = (between.x() * ray.y() - between.y() * ray.x()) / across;
      if (range > 0.0 && share >= 0.0 && share <= 1.0) nearest = std::min(nearest, range);
    }
    return nearest;
  }

  std::vector<Wall> walls_;
};

}  // namespace prodomos::test

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/geometry/pose.hpp"
#include "prodomos/localization/submap_matcher.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

/// Buildings of straight walls, seen from above by a laser whose ranges are true, up to the noise that is asked for.
namespace prodomos::test {

using geometry::Pose2;

constexpr double kDegree = std::numbers::pi / 180.0;

inline Eigen::Vector2d apply(const Pose2& T_a_b, const Eigen::Vector2d& point_in_b) {
  return Eigen::Rotation2Dd(T_a_b.theta) * point_in_b + Eigen::Vector2d(T_a_b.x, T_a_b.y);
}

/// How far two poses are apart.
struct PoseError {
  double metres;
  double radians;
};
inline PoseError errorOf(const Pose2& estimated, const Pose2& truth) {
  const auto off = geometry::inverse(truth) * estimated;
  return {std::hypot(off.x, off.y), std::abs(off.theta)};
}

class FlatBuilding {
 public:
  void addWall(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { walls_.push_back({a, b}); }

  /// A rectangle of walls, as of a room or of a cupboard.
  void addBox(const Pose2& T_building_box, double length, double width) {
    const auto corner = [&](double x, double y) { return apply(T_building_box, {0.5 * length * x, 0.5 * width * y}); };
    addWall(corner(-1, -1), corner(1, -1));
    addWall(corner(1, -1), corner(1, 1));
    addWall(corner(1, 1), corner(-1, 1));
    addWall(corner(-1, 1), corner(-1, -1));
  }

  /// A wall along x or y from `from` to `to`, with doors of a metre.
  void addWallWithDoors(Eigen::Vector2d from, const Eigen::Vector2d& to, const std::vector<double>& doors) {
    const Eigen::Vector2d along = (to - from).normalized();
    const Eigen::Vector2d begin = from;
    for (const double door : doors) {
      addWall(from, begin + (door - 0.5) * along);
      from = begin + (door + 0.5) * along;
    }
    addWall(from, to);
  }

  /// Pieces of furniture in a rectangle around the origin, some askew; none in the way of who stands at `clear`.
  void addFurniture(base::Random& random, int count, double length, double width, std::span<const Pose2> clear) {
    while (count > 0) {
      const Pose2 piece{random.uniform(-0.45, 0.45) * length, random.uniform(-0.45, 0.45) * width,
                        random.integer(0, 3) == 0 ? random.uniform(0.0, 1.5) : 0.0};
      const bool isInTheWay = std::ranges::any_of(
          clear, [&](const Pose2& place) { return std::hypot(place.x - piece.x, place.y - piece.y) < 0.9; });
      if (isInTheWay) continue;
      addBox(piece, random.uniform(0.3, 1.2), random.uniform(0.3, 0.7));
      --count;
    }
  }

  double range(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& wall : walls_) {
      const Eigen::Vector2d along = wall.b - wall.a;
      const double cross = direction.x() * along.y() - direction.y() * along.x();
      if (std::abs(cross) < 1e-12) continue;
      const Eigen::Vector2d offset = wall.a - origin;
      const double distance = (offset.x() * along.y() - offset.y() * along.x()) / cross;
      const double share = (offset.x() * direction.y() - offset.y() * direction.x()) / cross;
      if (distance > 0.0 && share >= 0.0 && share <= 1.0) nearest = std::min(nearest, distance);
    }
    return nearest;
  }

  /// A look all around, or ahead.
  sensors::LaserScan scan(const Pose2& T_building_body, base::Random* noise = nullptr, double sigma = 0.01,
                          double fieldOfView = 2.0 * std::numbers::pi) const {
    sensors::LaserScan scan;
    scan.maxRange = 12.0;
    scan.angleStep = kDegree;
    scan.firstAngle = -0.5 * fieldOfView;
    for (int i = 0; i < static_cast<int>(std::lround(fieldOfView / kDegree)); ++i) {
      const double angle = T_building_body.theta + scan.firstAngle + i * scan.angleStep;
      const double exact = range({T_building_body.x, T_building_body.y}, {std::cos(angle), std::sin(angle)});
      if (exact > scan.maxRange) {
        scan.ranges.push_back(sensors::LaserScan::kNoReturn);
      } else {
        scan.ranges.push_back(
            static_cast<float>(noise != nullptr ? std::max(0.0, noise->normal(exact, sigma)) : exact));
      }
    }
    return scan;
  }

 private:
  struct Wall {
    Eigen::Vector2d a;
    Eigen::Vector2d b;
  };
  std::vector<Wall> walls_;
};

/// End points of a scan's beams.
inline std::vector<Eigen::Vector2d> pointsOf(const sensors::LaserScan& scan) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double angle = scan.firstAngle + static_cast<double>(i) * scan.angleStep;
    const double range = static_cast<double>(scan.ranges[i]);
    if (std::isfinite(range)) points.emplace_back(range * std::cos(angle), range * std::sin(angle));
  }
  return points;
}

/// What a robot that has stood at these places keeps of a building, in a frame of its own.
inline localization::MatchedLayers layersOf(const FlatBuilding& building, std::span<const Pose2> T_building_bodies,
                                            const Pose2& T_building_submap, base::Random* noise = nullptr) {
  auto surface = std::make_shared<map::SurfaceLayer>();
  auto grid = std::make_shared<map::OccupancyGrid>();
  for (const auto& T_building_body : T_building_bodies) {
    const sensors::Reading reading{.time = {}, .sensor = "laser", .data = building.scan(T_building_body, noise)};
    const auto T_submap_body = geometry::toPose3(geometry::inverse(T_building_submap) * T_building_body);
    surface->integrate({.reading = reading, .T_submap_body = T_submap_body});
    grid->integrate({.reading = reading, .T_submap_body = T_submap_body});
  }
  return {surface, grid};
}

/// Places on a straight way, all looking along it.
inline std::vector<Pose2> placesAlong(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double step = 0.25) {
  std::vector<Pose2> places;
  const Eigen::Vector2d way = to - from;
  const int count = std::max(1, static_cast<int>(std::lround(way.norm() / step)));
  for (int i = 0; i <= count; ++i) {
    const Eigen::Vector2d place = from + way * i / count;
    places.push_back({place.x(), place.y(), std::atan2(way.y(), way.x())});
  }
  return places;
}

}  // namespace prodomos::test

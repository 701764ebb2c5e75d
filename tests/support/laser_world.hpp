// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/sensors/reading.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

/// A flat world drawn as text, a robot with a laser and wheels that drift in it, and what they would log. Until the
/// simulator exists, the demo's log comes from here too.
namespace prodomos::testing {

/// '#' is wall, everything else free; the first line is the farthest north. Cells are squares.
class LaserWorld {
 public:
  LaserWorld(std::vector<std::string> lines, double cell) : lines_(std::move(lines)), cell_(cell) {}

  bool isWall(double x, double y) const {
    const int column = static_cast<int>(std::floor(x / cell_));
    const int line = static_cast<int>(lines_.size()) - 1 - static_cast<int>(std::floor(y / cell_));
    if (line < 0 || line >= static_cast<int>(lines_.size())) return true;
    const auto& text = lines_[static_cast<std::size_t>(line)];
    return column < 0 || column >= static_cast<int>(text.size()) || text[static_cast<std::size_t>(column)] == '#';
  }

  /// Distance to the first wall, metres; infinite beyond maxRange.
  double range(double x, double y, double angle, double maxRange) const {
    constexpr double kStep = 0.01;
    for (double distance = 0.0; distance <= maxRange; distance += kStep) {
      if (isWall(x + distance * std::cos(angle), y + distance * std::sin(angle))) return distance;
    }
    return std::numeric_limits<double>::infinity();
  }

 private:
  std::vector<std::string> lines_;
  double cell_;
};

/// How a simulated robot looks and errs.
struct LaserRobot {
  int beams = 181;
  double fieldOfView = std::numbers::pi;
  double maxRange = 12.0;
  double rangeNoise = 0.01;      ///< metres
  double stepLength = 0.1;       ///< metres between scans
  double odometryNoise = 0.002;  ///< metres and radians a step
  double wheelScale = 1.0;       ///< metres told for each one driven
  double wheelTurn = 0.0;        ///< radians told for each metre driven straight on
};

/// Drives from point to point and logs, at each step, odometry and a scan with the same stamp.
inline std::vector<sensors::Reading> driveThrough(const LaserWorld& world, const std::vector<Eigen::Vector2d>& path,
                                                  const LaserRobot& robot = {}, std::uint64_t seed = 1) {
  base::Random random(seed);
  std::vector<sensors::Reading> log;
  geometry::Pose2 T_world_body{path.front().x(), path.front().y(), 0.0};
  geometry::Pose2 T_odom_body;
  base::Time time = base::fromNanoseconds(1'000'000'000'000);

  const auto look = [&] {
    sensors::LaserScan scan;
    scan.firstAngle = -robot.fieldOfView / 2;
    scan.angleStep = robot.fieldOfView / (robot.beams - 1);
    scan.maxRange = robot.maxRange;
    for (int i = 0; i < robot.beams; ++i) {
      const double angle = T_world_body.theta + scan.firstAngle + i * scan.angleStep;
      const double range = world.range(T_world_body.x, T_world_body.y, angle, robot.maxRange);
      const double noisy = std::isfinite(range) ? std::max(0.0, random.normal(range, robot.rangeNoise)) : range;
      scan.ranges.push_back(static_cast<float>(noisy));
    }
    log.push_back({time, "odometry", sensors::Odometry{geometry::toPose3(T_odom_body)}, ""});
    log.push_back({time, "laser", scan, ""});
    time += std::chrono::milliseconds(200);
  };
  const auto move = [&](const geometry::Pose2& step) {
    T_world_body = T_world_body * step;
    const auto noise = [&] { return random.normal(0.0, robot.odometryNoise); };
    const geometry::Pose2 told{robot.wheelScale * step.x + noise(), step.y,
                               step.theta + robot.wheelTurn * step.x + noise()};
    T_odom_body = T_odom_body * told;
    look();
  };

  look();
  for (const auto& target : path) {
    for (;;) {
      const Eigen::Vector2d way = target - Eigen::Vector2d(T_world_body.x, T_world_body.y);
      if (way.norm() < robot.stepLength / 2) break;
      const double turn = geometry::normalizeAngle(std::atan2(way.y(), way.x()) - T_world_body.theta);
      constexpr double kMostTurn = 0.3;  // radians a step
      if (std::abs(turn) > 1e-3) {
        move({0.0, 0.0, std::clamp(turn, -kMostTurn, kMostTurn)});
      } else {
        move({std::min(robot.stepLength, way.norm()), 0.0, 0.0});
      }
    }
  }
  return log;
}

/// A corridor 2 m wide around a block of 12 m by 5 m, with rooms off it of which no two are alike; cells of 0.25 m.
inline LaserWorld corridorAroundBlock() {
  constexpr double kCell = 0.25;
  std::vector<std::string> lines(68, std::string(100, '#'));
  const auto carve = [&](double x, double y, double width, double height) {
    for (int row = 0; row < static_cast<int>(height / kCell); ++row) {
      auto& line = lines[lines.size() - 1 - static_cast<std::size_t>(y / kCell) - static_cast<std::size_t>(row)];
      line.replace(static_cast<std::size_t>(x / kCell), static_cast<std::size_t>(width / kCell),
                   static_cast<std::size_t>(width / kCell), '.');
    }
  };
  carve(4, 4, 16, 2);  // the corridor
  carve(18, 4, 2, 9);
  carve(4, 11, 16, 2);
  carve(4, 4, 2, 9);
  carve(7, 1.5, 2.5, 2.5);  // rooms to the south
  carve(12.5, 2.75, 1, 1.25);
  carve(16, 2, 3, 2);
  carve(20, 6, 1.5, 1.25);  // to the east
  carve(20, 9, 3.5, 2.5);
  carve(14, 13, 4, 2.25);  // to the north
  carve(10, 13, 1.5, 0.75);
  carve(6, 13, 2, 3);
  carve(2.5, 9, 1.5, 1);  // to the west
  carve(1, 5, 3, 2.5);
  return {std::move(lines), kCell};
}

/// Once around, and on until well behind where the drive began.
inline std::vector<Eigen::Vector2d> lapAroundBlock() {
  return {{6.0, 5.0}, {19.0, 5.0}, {19.0, 12.0}, {5.0, 12.0}, {5.0, 5.0}, {16.0, 5.0}};
}

/// Four rooms on a corridor, cells of 0.25 m.
inline LaserWorld fourRooms() {
  std::vector<std::string> lines = {"################################################################",
                                    "#..............#...............#...............#...............#",
                                    "#..............#...............#...............#...............#",
                                    "#....##........#...............#.......##......#...............#",
                                    "#....##........#......###......#.......##......#....#..........#",
                                    "#..............#......###......#...............#....#..........#",
                                    "#..............#...............#...............#....#####......#",
                                    "#..............#...............#...............#...............#",
                                    "#..............#...............#...............#...............#",
                                    "#..............#...............#...............#...............#",
                                    "#..............#...............#...............#...............#",
                                    "#..............#...............#...............#...............#",
                                    "######....############....############....############....######",
                                    "#..............................................................#",
                                    "#..............................................................#",
                                    "#..............................................................#",
                                    "#..............................................................#",
                                    "#..............................................................#",
                                    "#..............................................................#",
                                    "#..............................................................#",
                                    "################################################################"};
  return {std::move(lines), 0.25};
}

/// Along the corridor, into each room and back to the start.
inline std::vector<Eigen::Vector2d> tourOfFourRooms() {
  return {{1.0, 1.0},  {1.9, 1.1},  {1.9, 3.8},  {1.2, 3.0},  {1.9, 1.1},  {6.0, 1.1},  {6.0, 3.4},
          {7.0, 3.4},  {6.0, 1.1},  {10.0, 1.1}, {10.0, 3.5}, {11.2, 4.5}, {10.0, 3.5}, {10.0, 1.1},
          {14.0, 1.1}, {14.0, 2.8}, {15.2, 4.4}, {14.0, 2.8}, {14.0, 1.1}, {1.0, 1.0}};
}

}  // namespace prodomos::testing

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/leaf_ways.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prodomos::simulation {

std::vector<LeafLine> leafLines(const Door& door, double angle) {
  std::vector<double> hinges;
  if (door.leaves == 2) {
    hinges = {1.0, -1.0};
  } else if (door.leaves == 1) {
    hinges = {door.hingeSide == map::HingeSide::kRight ? -1.0 : 1.0};
  }
  const Eigen::Vector2d normal(std::cos(door.pose.theta), std::sin(door.pose.theta));
  const Eigen::Vector2d left(-normal.y(), normal.x());
  const Eigen::Vector2d outward = door.opensAlongNormal ? normal : Eigen::Vector2d(-normal);
  std::vector<LeafLine> lines;
  for (const double side : hinges) {
    const Eigen::Vector2d hinge =
        Eigen::Vector2d(door.pose.x, door.pose.y) + outward * door.wallThickness / 2.0 + left * side * door.width / 2.0;
    const Eigen::Vector2d leaf = -side * std::cos(angle) * left + std::sin(angle) * outward;
    lines.push_back({hinge, hinge + leaf * door.width / door.leaves});
  }
  return lines;
}

bool standsOpen(const Door& door) {
  return leastAngle(door) > std::numbers::pi / 4.0;
}

double leastAngle(const Door& door) {
  return door.swings.empty() ? 0.0 : std::ranges::min_element(door.swings, {}, &Swing::angle)->angle;
}

Eigen::Vector2d inDoor(const Door& door, const Eigen::Vector2d& point) {
  const auto point_in_door = geometry::inverse(door.pose) * geometry::Pose2{point.x(), point.y(), 0.0};
  return {point_in_door.x, point_in_door.y};
}

bool liesInOpening(const Door& door, const Eigen::Vector2d& point, double depth) {
  const Eigen::Vector2d point_in_door = inDoor(door, point);
  return std::abs(point_in_door.y()) < door.width / 2.0 &&
         std::abs(point_in_door.x()) <= door.wallThickness / 2.0 + depth;
}

bool joinsRooms(const Door& door) {
  return door.rooms[0] != kOutside && door.rooms[1] != kOutside;
}

}  // namespace prodomos::simulation

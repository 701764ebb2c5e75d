// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/ways/passing.hpp"

#include "simulation/shell/door_swings.hpp"
#include "simulation/shell/openings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prodomos::simulation {

std::vector<LeafLine> leafLines(const Building& building, const Door& door, double angle) {
  std::vector<LeafLine> lines;
  if (isLiftDoor(building, door)) return lines;
  const double face = (door.opensAlongNormal ? 0.5 : -0.5) * door.wallThickness;
  for (const auto& hinge : hingesOf(door)) {
    const Eigen::Vector2d hinge_in_door(face, hinge.y_in_door);
    const double closed = hinge.y_in_door > 0.0 ? -std::numbers::pi / 2.0 : std::numbers::pi / 2.0;
    const double heading = closed + hinge.turn * angle;
    const Eigen::Vector2d edge_in_door =
        hinge_in_door + leafWidthOf(door) * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    lines.push_back({door.pose * hinge_in_door, door.pose * edge_in_door});
  }
  return lines;
}

double leastAngle(const Door& door) {
  return door.swings.empty() ? 0.0 : std::ranges::min_element(door.swings, {}, &Swing::angle)->angle;
}

double passingAngle(const Building& building, const Door& door) {
  return std::min(std::numbers::pi / 2.0, widestAngle(building, door));
}

bool canBePassed(const Building& building, const Door& door) {
  constexpr double kFarEnough = 75.0 * std::numbers::pi / 180.0;
  if (std::ranges::count(door.rooms, kOutside) > 0) return false;
  return door.leaves == 0 || isLiftDoor(building, door) || passingAngle(building, door) >= kFarEnough;
}

bool liesInOpening(const Door& door, const Eigen::Vector2d& point) {
  const Eigen::Vector2d point_in_door = geometry::inverse(door.pose) * point;
  return std::abs(point_in_door.x()) <= door.wallThickness / 2.0 && std::abs(point_in_door.y()) < door.width / 2.0;
}

}  // namespace prodomos::simulation

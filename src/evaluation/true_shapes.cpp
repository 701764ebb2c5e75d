// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/true_shapes.hpp"

#include <numbers>

namespace prodomos::evaluation {

std::vector<Hinge> hingesOf(const TrueDoor& door) {
  const auto hinge = [&](double side, double width) {
    return Hinge{{door.leafOffset, side * 0.5 * door.width, -side * std::numbers::pi / 2}, width};
  };
  if (door.leaves == 0) return {};
  if (door.leaves > 1) return {hinge(1.0, 0.5 * door.width), hinge(-1.0, 0.5 * door.width)};
  if (door.hingeSide == map::HingeSide::kLeft) return {hinge(1.0, door.width)};
  if (door.hingeSide == map::HingeSide::kRight) return {hinge(-1.0, door.width)};
  return {hinge(1.0, door.width), hinge(-1.0, door.width)};
}

std::vector<geometry::OrientedBox> leavesAt(const TrueDoor& door, double angle) {
  std::vector<geometry::OrientedBox> leaves;
  for (const auto& hinge : hingesOf(door)) {
    for (const double turn : {angle, -angle}) {
      const auto T_hinge_leaf = geometry::Pose2{0.0, 0.0, turn} * geometry::Pose2{0.5 * hinge.width, 0.0, 0.0};
      leaves.push_back({door.T_world_door * geometry::toPose3(hinge.T_door_hinge * T_hinge_leaf, 0.5 * door.height),
                        {hinge.width, 2.0 * kHalfLeaf, door.height}});
      if (turn == 0.0) break;
    }
  }
  return leaves;
}

std::vector<geometry::OrientedBox> stepsOf(const TrueStaircase& stairs) {
  const auto T_world_foot = geometry::fromYawPitchRoll(stairs.foot, stairs.direction, 0.0, 0.0);
  std::vector<geometry::OrientedBox> steps;
  for (int i = 0; i < stairs.stepCount; ++i) {
    const double height = (i + 1) * stairs.stepHeight;
    steps.push_back({T_world_foot * Eigen::Translation3d((i + 0.5) * stairs.stepDepth, 0.0, 0.5 * height),
                     {stairs.stepDepth, stairs.width, height}});
  }
  return steps;
}

}  // namespace prodomos::evaluation

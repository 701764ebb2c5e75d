// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/shell/openings.hpp"

#include "simulation/polygons.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prodomos::simulation {

std::optional<Opening> openingIn(const Polygon& outline, const Door& door, int side) {
  constexpr double kLeastCosine = 0.94;  // 20°
  constexpr double kFaceTolerance = 0.3;
  constexpr double kEndTolerance = 1e-6;
  const double sign = side == 0 ? -1.0 : 1.0;
  const geometry::Pose2 T_door_world = geometry::inverse(door.pose);
  std::optional<Opening> best;
  double bestOffset = kFaceTolerance;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Edge edge = edgeOf(outline, i);
    const Eigen::Vector2d from = T_door_world * edge.from;
    const Eigen::Vector2d along = T_door_world * edge.to - from;
    const double length = along.norm();
    // The inside of room 0 lies at x < 0: its edges run upwards along y, those of room 1 downwards.
    if (length == 0.0 || -sign * along.y() < kLeastCosine * length) continue;
    const auto shareAt = [&](double y) { return (y - from.y()) / along.y(); };
    const double low = shareAt(-door.width / 2.0);
    const double high = shareAt(door.width / 2.0);
    if (std::min(low, high) * length < -kEndTolerance || (std::max(low, high) - 1.0) * length > kEndTolerance) continue;
    const std::array face{from.x() + low * along.x(), from.x() + high * along.x()};
    const double offset = std::abs((face[0] + face[1]) / 2.0 - sign * door.wallThickness / 2.0);
    if (offset >= bestOffset) continue;
    bestOffset = offset;
    best = Opening{i, std::min(low, high) * length, std::max(low, high) * length, face};
  }
  return best;
}

std::array<double, 2> faceOf(const Building& building, const Door& door, int side) {
  const int room = door.rooms[static_cast<std::size_t>(side)];
  if (room != kOutside) {
    const auto opening = openingIn(building.rooms[static_cast<std::size_t>(room)].outline, door, side);
    if (opening) return opening->face_in_door;
  }
  const double face = (side == 0 ? -1.0 : 1.0) * door.wallThickness / 2.0;
  return {face, face};
}

std::vector<Hinge> hingesOf(const Door& door) {
  // A leaf hung on the left, seen along the normal, turns counter-clockwise where it opens that way.
  const double ofLeft = door.opensAlongNormal ? 1.0 : -1.0;
  const Hinge left{door.width / 2.0, ofLeft};
  const Hinge right{-door.width / 2.0, -ofLeft};
  if (door.leaves <= 0) return {};
  if (door.leaves >= 2) return {left, right};
  return {door.hingeSide == map::HingeSide::kRight ? right : left};
}

double leafWidthOf(const Door& door) {
  return door.width / std::max(door.leaves, 1);
}

}  // namespace prodomos::simulation

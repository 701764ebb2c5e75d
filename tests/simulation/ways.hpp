// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"
#include "prodomos/simulation/tour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

/// What ways are measured by, point by point and wall by wall.
namespace prodomos::test {

/// A wall seen from above, without the openings in it.
struct WallPiece {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

inline bool isInOpening(const simulation::Building& building, int storey, const Eigen::Vector2d& point) {
  return std::ranges::any_of(building.doors, [&](const simulation::Door& door) {
    const Eigen::Vector2d point_in_door = geometry::inverse(door.pose) * point;
    constexpr double kRounding = 1e-6;
    return door.storey == storey && std::abs(point_in_door.x()) <= door.wallThickness / 2.0 + kRounding &&
           std::abs(point_in_door.y()) < door.width / 2.0;
  });
}

/// All walls of a storey, in pieces of two centimetres.
inline std::vector<WallPiece> wallsOf(const simulation::Building& building, int storey) {
  constexpr double kPiece = 0.02;
  std::vector<WallPiece> walls;
  for (const auto& room : building.rooms) {
    if (room.storey != storey) continue;
    for (std::size_t i = 0; i < room.outline.size(); ++i) {
      const Eigen::Vector2d from = room.outline[i];
      const Eigen::Vector2d to = room.outline[(i + 1) % room.outline.size()];
      const int pieces = static_cast<int>(std::ceil((to - from).norm() / kPiece));
      for (int k = 0; k < pieces; ++k) {
        const WallPiece piece{from + (to - from) * k / pieces, from + (to - from) * (k + 1) / pieces};
        if (!isInOpening(building, storey, (piece.from + piece.to) / 2.0)) walls.push_back(piece);
      }
    }
  }
  return walls;
}

inline double distanceToWalls(const std::vector<WallPiece>& walls, const Eigen::Vector2d& point) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& wall : walls) least = std::min(least, (wall.from - point).squaredNorm());
  return std::sqrt(least);
}

inline bool crosses(const WallPiece& wall, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const auto side = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r) {
    return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
  };
  return side(a, b, wall.from) * side(a, b, wall.to) <= 0.0 &&
         side(wall.from, wall.to, a) * side(wall.from, wall.to, b) <= 0.0;
}

inline bool crossesWalls(const std::vector<WallPiece>& walls, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::ranges::any_of(walls, [&](const WallPiece& wall) { return crosses(wall, a, b); });
}

inline Eigen::Vector2d positionOf(const simulation::TourPose& pose) {
  return pose.T_world_body.translation().head<2>();
}

/// The storey whose floor it stands on; -1 in between.
inline int storeyOf(const simulation::Building& building, const simulation::TourPose& pose) {
  const auto isOn = [&](const simulation::Storey& storey) {
    return std::abs(pose.T_world_body.translation().z() - storey.floor_z) < 1e-6;
  };
  const auto storey = std::ranges::find_if(building.storeys, isOn);
  return storey == building.storeys.end() ? -1 : static_cast<int>(storey - building.storeys.begin());
}

}  // namespace prodomos::test

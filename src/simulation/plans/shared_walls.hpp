// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include "simulation/polygons.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace prodomos::simulation {

inline constexpr double kLeastDoorWidth = 0.6;  ///< metres; what a person still passes

struct Interval {
  double from = 0.0;
  double to = 0.0;

  double length() const { return to - from; }
};

/// A stretch of wall that has one of two rooms on either side. Coordinates along it count from a given origin.
struct SharedWall {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  Eigen::Vector2d along = Eigen::Vector2d::Zero();
  std::array<Edge, 2> faces;   ///< of the first and of the second room
  std::vector<Interval> free;  ///< along it: where an opening may be, frames and corners left aside

  /// From the first room into the second.
  Eigen::Vector2d normal() const { return {along.y(), -along.x()}; }
  /// How far the face of a room stands off the origin along the normal.
  double faceAt(std::size_t side, double position) const;
  double thicknessAt(double position) const { return faceAt(1, position) - faceAt(0, position); }
};

/// All of two rooms, with the openings of the building's doors taken out.
std::vector<SharedWall> sharedWalls(const Building& building, const std::array<int, 2>& rooms,
                                    const Eigen::Vector2d& origin);

}  // namespace prodomos::simulation

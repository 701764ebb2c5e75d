// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/cells.hpp"
#include "prodomos/geometry/skew_normal.hpp"
#include "prodomos/map/prediction.hpp"
#include "prodomos/prediction/surroundings.hpp"

#include <array>
#include <vector>

/// Floor that nobody has seen: where a density says that it is free, cut by what is known.
namespace prodomos::prediction {

/// For each cell that may be claimed the relative density f / max f, 0 for all others.
using Claims = geometry::CellMap<float>;

/// Where one looks from: a door, or the end of a staircase. It looks along the x-axis of `here`.
struct Lookout {
  double width = 0.0;  ///< metres
  double wall = 0.0;   ///< metres: nothing nearer ahead is claimed, nor so near to a wall or a room that is taken
};

/// Unknown cells ahead that one sees from there over what is unknown, or over floor that was seen through the opening:
/// nothing behind a known wall, behind other known floor or in a room that is taken. The wall that the opening is in
/// counts as going on to both sides. `room`: if given, of those the cells with a value of at least `leastProbability`.
Claims claimsAhead(const Surroundings& around, const Lookout& lookout, const geometry::SkewNormal& density,
                   const geometry::CellMap<float>* room, double leastProbability);

/// Adds the unknown cells about a person that it sees over no known wall, but for those right beside one.
void addClaimsAbout(const Eigen::Vector2d& position_in_here, const Surroundings& around,
                    const geometry::SkewNormal& density, Claims& claims);

/// Whether the way between two points leads through no known wall.
bool isWayFree(const Surroundings& around, const Eigen::Vector2d& from_in_here, const Eigen::Vector2d& to_in_here);

/// 002's p_th, ascending.
inline constexpr std::array kThresholds = {0.5, 0.6, 0.7};

/// The claims above each threshold (002 eq. (2), (3), (5)), outlined in `here`: for each piece that hangs together at
/// the least threshold a list by threshold, the greatest first. An area lies within that of the threshold before.
/// Pieces of less than `leastArea` m² are left out.
std::vector<std::vector<map::PredictedArea>> areasOf(const Claims& claims, double leastArea);

}  // namespace prodomos::prediction

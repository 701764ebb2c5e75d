// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

/// The trivial predictor: a half-disc behind each door, kWallHalf beyond its leaf.
namespace prodomos::evaluation {

inline constexpr double kWallHalf = 0.1;  ///< metres from a door's leaf to where a room may begin
inline constexpr std::size_t kRadiusSteps = 300;
inline constexpr double kRadiusStep = 0.05;  ///< metres

/// Something that is summed up over half-discs, by their radius: at [i] within (i + 1) * kRadiusStep.
using ByRadius = std::array<double, kRadiusSteps>;

/// Sums of what was noted at the very radii become sums of all that lies within.
void accumulate(ByRadius& sums);
void add(ByRadius& sums, const ByRadius& others);
/// Of a distance from the door; kRadiusSteps where it is too far.
std::size_t radiusIndex(double distance);

}  // namespace prodomos::evaluation

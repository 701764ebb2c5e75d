// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/cells.hpp"

#include <array>
#include <cstddef>
#include <functional>
#include <optional>

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

/// What became of a cell that was said to be free floor.
enum class CellFate { kRight, kWrong, kNobodyKnows };

/// Cells of half-discs behind many doors, all of one radius.
struct HalfDiscs {
  ByRadius all{};
  ByRadius right{};
  ByRadius wrong{};

  /// Those behind one more door; cells without a fate do not count.
  void addBehind(const geometry::Pose2& T_world_door,
                 const std::function<std::optional<CellFate>(geometry::CellIndex)>& fateOf);
  /// Right / (right + wrong) of those that together have so many cells, whatever their fate; none where there are none,
  /// or nobody knows of any.
  std::optional<double> precisionAt(double cells) const;
  HalfDiscs& operator+=(const HalfDiscs& other);
};

}  // namespace prodomos::evaluation

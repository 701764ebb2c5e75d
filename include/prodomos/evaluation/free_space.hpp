// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/half_disc.hpp"
#include "prodomos/evaluation/scene.hpp"

#include <array>
#include <optional>

/// Predicted free floor against the true one (002 table II). docs/evaluation.md defines every measure.
namespace prodomos::evaluation {

/// 002's p_th.
inline constexpr std::array kThresholds = {0.5, 0.6, 0.7};

/// Of predicted cells that were unknown when they were predicted.
struct CellCounts {
  std::size_t right = 0;      ///< in a room or an opening
  std::size_t wrong = 0;      ///< in a wall, in a closed leaf, outside
  std::size_t furnished = 0;  ///< right, but below furniture

  std::optional<double> precision() const { return shareOf(right, right + wrong); }
  std::optional<double> furnishedPrecision() const { return shareOf(right - furnished, right + wrong); }
  CellCounts& operator+=(const CellCounts& other);
};

/// Null where the prediction tells none at that threshold.
const Polygon* findArea(const ClaimedSpace& space, double threshold);

/// At one threshold.
struct FreeSpaceLevel {
  std::array<CellCounts, 3> byMobility;  ///< of the cause, in the order of map::Mobility
  std::size_t areas = 0;                 ///< predictions that have one
  std::size_t gained = 0;                ///< cells that the map knows only by prediction, in the end, each once
  std::size_t doors = 0;                 ///< predictions by doors that have an area
  HalfDiscs halfDiscs;                   ///< cells that were unknown, behind the same doors

  CellCounts overall() const;
  /// m² of unknown cells that a door gains; none where there is none.
  std::optional<double> areaPerDoor() const;
  /// Of half-discs that together have as many cells as the predictions by doors.
  std::optional<double> halfDiscPrecision() const;
  FreeSpaceLevel& operator+=(const FreeSpaceLevel& other);
};

struct FreeSpaceScore {
  std::array<FreeSpaceLevel, kThresholds.size()> levels;  ///< in the order of kThresholds
  double observedFree = 0.0;                              ///< m² that the map has observed to be free

  /// Of the observed free area; none where nothing was observed or predicted.
  std::optional<double> areaGainPercent(std::size_t level) const;
  FreeSpaceScore& operator+=(const FreeSpaceScore& other);
};

FreeSpaceScore scoreFreeSpace(const Scene& scene);

}  // namespace prodomos::evaluation

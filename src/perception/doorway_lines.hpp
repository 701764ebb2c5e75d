// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/occupancy_grid.hpp"
#include "prodomos/perception/doorway_detector.hpp"

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace prodomos::perception::doorways {

/// Between two obstacles, where the free space is narrower than before and behind.
struct CriticalLine {
  Eigen::Vector2d left = Eigen::Vector2d::Zero();  ///< in the sub-map, metres
  Eigen::Vector2d right = Eigen::Vector2d::Zero();

  double width() const { return (right - left).norm(); }
  Eigen::Vector2d middle() const { return 0.5 * (left + right); }
  double direction() const { return std::atan2(right.y() - left.y(), right.x() - left.x()); }
};

/// Critical lines (Thrun 1998, Learning metric-topological maps for indoor mobile robot navigation, §3) of the widths
/// that doorways may have, the narrowest first; in whatever direction they lie.
std::vector<CriticalLine> criticalLines(const map::OccupancyGrid& grid, const DoorwayDetectorConfig& config);

}  // namespace prodomos::perception::doorways

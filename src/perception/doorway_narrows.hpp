// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/doorway_detector.hpp"

#include "perception/doorway_raster.hpp"

#include <Eigen/Core>

#include <vector>

namespace prodomos::perception::doorways {

struct Opening {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< in the middle of the wall, in the sub-map
  double direction = 0.0;                            ///< of the normal, radians
  double width = 0.0;                                ///< metres
  double sigma = 0.0;                                ///< of place and width, metres
  double evidence = 0.0;                             ///< log-odds
};

/// Narrows in walls along the raster's rows. A narrow is a stack of rows in which the same two jambs bound the free
/// space; before it and behind it the space widens. That is what gaps between collinear walls, gaps beside a
/// perpendicular wall and the ends of corridors that open into halls have in common, and corridors do not have.
void appendOpenings(const Raster& raster, const DoorwayDetectorConfig& config, std::vector<Opening>& openings);

/// The same about a point alone, in a raster whose rows lie along a gap rather than along walls: these must still lead
/// to the gap, though they may do so a little askew.
void appendOpeningsAt(const Eigen::Vector2d& middle, const Raster& raster, const DoorwayDetectorConfig& config,
                      std::vector<Opening>& openings);

}  // namespace prodomos::perception::doorways

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/config.hpp"

namespace prodomos::map {

/// The heights above the floor in which things of 3D sensors are obstacles to the robot.
struct HeightBand {
  double least = 0.15;  ///< metres
  double most = 1.80;   ///< metres
};

struct OccupancyGridConfig {
  double resolution = 0.05;  ///< metres
  double maxRange = 30.0;    ///< metres; beams are used up to here
  double noReturn = 5.0;     ///< metres; a beam without a return passes so far and says nothing beyond
  double hit = 0.7;          ///< P(occupied | an end point lies in the cell)
  double miss = 0.4;         ///< P(occupied | a beam passes the cell)
  double clampLow = 0.12;    ///< least probability
  double clampHigh = 0.97;   ///< greatest probability
  HeightBand heightBand;
};

struct SurfaceLayerConfig {
  double resolution = 0.05;  ///< metres; one mean is kept in each cell
  double maxRange = 30.0;    ///< metres; beams are used up to here
  HeightBand heightBand;     ///< that of the grid
};

struct PointLayerConfig {
  double voxel = 0.10;     ///< metres; one point is kept in each
  double maxRange = 10.0;  ///< metres
};

struct LayersConfig {
  OccupancyGridConfig grid;
  PointLayerConfig points;
  SurfaceLayerConfig surface;
};

void describe(base::ConfigVisitor& visitor, LayersConfig& config);

}  // namespace prodomos::map

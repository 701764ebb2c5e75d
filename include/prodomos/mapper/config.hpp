// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/config.hpp"

namespace prodomos::mapper {

/// When a new sub-map begins (002 §II-A).
struct SubMapConfig {
  double maxDistance = 6.0;  ///< metres travelled within one
  double leastOverlap = 0.35;
  double overlapStep = 0.5;
};

struct FloorConfig {
  double leastHeight = 1.8;
};

struct OdometryNoiseConfig {
  double translationPerMetre = 0.05;
  double rotationPerRadian = 0.05;
  double rotationPerMetre = 0.01;
};

struct MapperConfig {
  SubMapConfig submap;
  FloorConfig floor;
  OdometryNoiseConfig odometry;
  map::LayersConfig layers;
};

void describe(base::ConfigVisitor& visitor, MapperConfig& config);

}  // namespace prodomos::mapper

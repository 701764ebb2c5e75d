// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/localization/laser_odometry.hpp"
#include "prodomos/localization/loop_closer.hpp"
#include "prodomos/localization/rgbd_odometry.hpp"
#include "prodomos/map/config.hpp"
#include "prodomos/perception/config.hpp"
#include "prodomos/prediction/config.hpp"

namespace prodomos::mapper {

/// What of a log is used, and how.
struct InputConfig {
  std::string poses = "auto";  ///< "auto", "estimated", "odometry", "recorded", or the path of a trajectory file
  std::string sensors;         ///< labels with commas between; empty: all
  std::string start;           ///< decimal seconds; empty: from the first
  std::string end;             ///< decimal seconds; empty: to the last
  double fps = 30.0;           ///< of RGB-D folders without time stamps
  double poseGap = 1.0;        ///< seconds; readings farther from any recorded pose are skipped
};

/// When a new sub-map begins (002 §II-A). Crossed doors join these once they are detected.
struct SubMapConfig {
  double maxDistance = 6.0;    ///< metres travelled within
  double leastOverlap = 0.25;  ///< of a reading's end points with cells the sub-map knew after its first overlapStep
  double overlapStep = 0.5;    ///< metres, or radians turned, between two looks at the overlap
};

struct FloorConfig {
  double leastHeight = 1.8;  ///< metres between two floors
};

/// Standard deviations of poses that come from wheels or from elsewhere, after a metre or radian; they grow with its
/// root.
struct OdometryNoiseConfig {
  double translationPerMetre = 0.05;
  double rotationPerMetre = 0.01;   ///< radians
  double rotationPerRadian = 0.05;  ///< radians
};

struct MapperConfig {
  InputConfig input;
  SubMapConfig submap;
  FloorConfig floor;
  OdometryNoiseConfig odometryNoise;
  localization::LaserOdometryConfig laserOdometry;
  localization::RgbdOdometryConfig rgbdOdometry;
  localization::LoopCloserConfig loops;
  map::LayersConfig layers;
  perception::PerceptionConfig perception;
  prediction::PredictionConfig prediction;
};

void describe(base::ConfigVisitor& visitor, MapperConfig& config);

}  // namespace prodomos::mapper

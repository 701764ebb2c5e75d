// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/config.hpp"
#include "prodomos/base/progress.hpp"
#include "prodomos/evaluation/truth.hpp"
#include "prodomos/sensors/source.hpp"
#include "prodomos/simulation/building.hpp"
#include "prodomos/simulation/depth_noise.hpp"
#include "prodomos/simulation/label_degradation.hpp"
#include "prodomos/simulation/range_sensors.hpp"
#include "prodomos/simulation/tour.hpp"
#include "prodomos/simulation/wheels.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

/// Honest recordings: a building and a robot go in; what its sensors would log, and all that is true, come out.
namespace prodomos::simulation {

enum class Labels { kNone, kTrue, kDegraded };

/// Where a sensor sits on the robot, and how often it reads.
struct Mount {
  double rate = 5.0;     ///< readings a second; 0: not on board
  double height = 1.2;   ///< above the floor, metres
  double forward = 0.1;  ///< ahead of the robot's middle, metres
  double pitch = 0.0;    ///< downwards, degrees
};

struct SimulationConfig {
  double speed = 0.6;     ///< of the robot, m/s
  double turnRate = 0.8;  ///< rad/s
  Mount camera{};
  double shutter = 0.0;  ///< seconds that it is open: what motion blurs; 0: nothing
  DepthNoise depthNoise{};
  Mount laser{.rate = 10.0, .height = 0.35, .forward = 0.2};
  LaserModel laserModel{};
  Mount lidar{.rate = 0.0, .height = 1.0, .forward = 0.0};
  int lidarRings = 0;       ///< 0: 16 of them, 1: 64
  LidarModel lidarModel{};  ///< but for its elevations
  double wheelRate = 20.0;
  WheelModel wheels{};
  LabelDegradation degradation{};
};

void describe(base::ConfigVisitor& visitor, SimulationConfig& config);

struct SimulationOptions {
  std::uint64_t seed = 0;
  int frames = 600;  ///< of the camera
  Labels labels = Labels::kNone;
  bool recordsPoses = false;  ///< the true ones, as another system would
  std::vector<Stop> path;     ///< empty: the robot's way is drawn by seed
  int threads = 0;            ///< 0: as many as there are cores; the log is the same
};

/// A floor plan (XML), a world (Gazebo) or a scene file (YAML), recognised by content. `storeys`: how many of the same
/// plan lie above each other, or how many of the world's are wanted; 0: as the scene has it. Throws base::FileError for
/// anything else, saying what was looked for.
Building openScene(const std::filesystem::path& scene, std::uint64_t seed, int storeys = 0);

/// Furnishes and peoples the building, sends the robot through it, writes what it senses and returns what is true. The
/// same building, seed and configuration give the same readings, bit by bit. Throws base::UsageError for a path that
/// cannot be driven, and what the sink throws.
evaluation::Truth simulate(Building building, const SimulationOptions& options, const SimulationConfig& config,
                           sensors::SensorSink& sink, const base::ProgressListener& onProgress = {});

}  // namespace prodomos::simulation

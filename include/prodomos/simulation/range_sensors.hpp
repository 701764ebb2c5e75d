// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/geometry/pose.hpp"
#include "prodomos/sensors/reading.hpp"
#include "prodomos/simulation/ray_scene.hpp"

#include <numbers>
#include <vector>

namespace prodomos::simulation {

/// What a laser's light does at a surface, and how well its return is timed.
struct RangeNoise {
  double sigma = 0.01;        ///< of a range, metres
  double leastRange = 0.1;    ///< metres; what is nearer says nothing
  double maxRange = 30.0;     ///< metres
  double leastSignal = 5e-4;  ///< that must come back: infrared share · cosine / range², range in metres
  double missing = 0.002;     ///< share of beams whose measurement fails, and is flagged so
};

/// A scanner in its own x-y-plane. The default is like Hokuyo's UTM-30LX, every second beam of it.
struct LaserModel {
  int beams = 541;
  double firstAngle = -0.75 * std::numbers::pi;  ///< radians, counter-clockwise from the sensor's x-axis
  double aperture = 1.5 * std::numbers::pi;      ///< radians, from the first beam to the last
  RangeNoise noise{};
};

/// Of the rings of a scanner like Velodyne's VLP-16: -15° to 15°, radians.
std::vector<double> elevations16();
/// Like Velodyne's HDL-64E: -24.8° to 2°, closer in the upper half.
std::vector<double> elevations64();

/// A scanner of several rings that turns about its z-axis.
struct LidarModel {
  std::vector<double> elevations = elevations16();  ///< of the rings, radians
  int columns = 900;                                ///< a turn
  RangeNoise noise{.sigma = 0.02, .leastRange = 0.5, .maxRange = 100.0, .leastSignal = 5e-5};
};

/// Beams that no light comes back from - nothing within range, or it is black, glass or grazed - have no return.
sensors::LaserScan castLaser(const RayScene& scene, const geometry::Pose3& T_world_sensor,
                             const geometry::Pose3& T_body_sensor, const LaserModel& model, base::Random& random);

/// One turn, ring by ring, with the classes of what was met and the strength of each return.
sensors::PointCloud castLidar(const RayScene& scene, const geometry::Pose3& T_world_sensor,
                              const geometry::Pose3& T_body_sensor, const LidarModel& model, base::Random& random);

}  // namespace prodomos::simulation

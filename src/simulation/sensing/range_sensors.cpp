// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/range_sensors.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace prodomos::simulation {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

std::vector<double> evenly(double first, double last, int count) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) values.push_back(first + (last - first) * i / (count - 1));
  return values;
}

/// Unit directions, in the sensor's axes, cast into the scene.
std::vector<Hit> castAll(const RayScene& scene, const geometry::Pose3& T_world_sensor,
                         const std::vector<Eigen::Vector3d>& directions, double maxRange) {
  std::vector<Ray> rays;
  rays.reserve(directions.size());
  for (const auto& direction : directions) {
    rays.push_back({.origin = T_world_sensor.translation().cast<float>(),
                    .direction = (T_world_sensor.linear() * direction).cast<float>(),
                    .maxDistance = static_cast<float>(maxRange)});
  }
  std::vector<Hit> hits(rays.size());
  scene.cast(rays, hits);
  return hits;
}

/// Share of the light that comes back, falling off with distance left out.
double reflected(const Hit& hit, const Eigen::Vector3d& direction_in_world) {
  return hit.surface->material.infrared * std::abs(hit.normal.cast<double>().dot(direction_in_world));
}

/// The measured range, or what stands in a scan for none. Draws the same numbers whatever is met, so that a change in
/// one beam changes no other.
float measure(const Hit& hit, double reflected, const RangeNoise& noise, base::Random& random) {
  const double error = random.normal(0.0, noise.sigma);
  const bool lost = random.uniform() < noise.missing;
  if (lost) return sensors::LaserScan::kInvalid;
  if (!hit) return sensors::LaserScan::kNoReturn;
  const double range = hit.distance;
  if (reflected / (range * range) < noise.leastSignal) return sensors::LaserScan::kNoReturn;
  if (range < noise.leastRange) return sensors::LaserScan::kInvalid;
  const double measured = range + error;
  return measured > noise.maxRange ? sensors::LaserScan::kNoReturn
                                   : static_cast<float>(std::max(measured, noise.leastRange));
}

}  // namespace

std::vector<double> elevations16() {
  return evenly(-15.0 * kDegree, 15.0 * kDegree, 16);
}

std::vector<double> elevations64() {
  std::vector<double> elevations = evenly(-24.8 * kDegree, -8.83 * kDegree, 32);
  const auto upper = evenly(-8.33 * kDegree, 2.0 * kDegree, 32);
  elevations.insert(elevations.end(), upper.begin(), upper.end());
  return elevations;
}

sensors::LaserScan castLaser(const RayScene& scene, const geometry::Pose3& T_world_sensor,
                             const geometry::Pose3& T_body_sensor, const LaserModel& model, base::Random& random) {
  sensors::LaserScan scan{.T_body_sensor = T_body_sensor,
                          .firstAngle = model.firstAngle,
                          .angleStep = model.beams > 1 ? model.aperture / (model.beams - 1) : 0.0,
                          .maxRange = model.noise.maxRange};
  std::vector<Eigen::Vector3d> directions;
  for (int beam = 0; beam < model.beams; ++beam) {
    const double angle = scan.firstAngle + beam * scan.angleStep;
    directions.emplace_back(std::cos(angle), std::sin(angle), 0.0);
  }
  const std::vector<Hit> hits = castAll(scene, T_world_sensor, directions, model.noise.maxRange);
  for (std::size_t beam = 0; beam < hits.size(); ++beam) {
    const double light = hits[beam] ? reflected(hits[beam], T_world_sensor.linear() * directions[beam]) : 0.0;
    scan.ranges.push_back(measure(hits[beam], light, model.noise, random));
  }
  return scan;
}

sensors::PointCloud castLidar(const RayScene& scene, const geometry::Pose3& T_world_sensor,
                              const geometry::Pose3& T_body_sensor, const LidarModel& model, base::Random& random) {
  std::vector<Eigen::Vector3d> directions;
  for (const double elevation : model.elevations) {
    for (int column = 0; column < model.columns; ++column) {
      // Clockwise seen from above, as they turn.
      const double azimuth = -2.0 * std::numbers::pi * column / model.columns;
      directions.emplace_back(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                              std::sin(elevation));
    }
  }
  const std::vector<Hit> hits = castAll(scene, T_world_sensor, directions, model.noise.maxRange);
  sensors::PointCloud cloud{.T_body_sensor = T_body_sensor};
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const double light = hits[i] ? reflected(hits[i], T_world_sensor.linear() * directions[i]) : 0.0;
    const float range = measure(hits[i], light, model.noise, random);
    if (!std::isfinite(range) || range <= 0.0F) continue;
    cloud.points_in_sensor.emplace_back(range * directions[i].cast<float>());
    cloud.intensity.push_back(static_cast<float>(std::min(1.0, light)));
    cloud.labels.push_back(hits[i].surface->classId);
  }
  return cloud;
}

}  // namespace prodomos::simulation

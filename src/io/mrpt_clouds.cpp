// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/mrpt_readings.hpp"
#include "io/mrpt_values.hpp"

#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <cmath>

namespace prodomos::io {

namespace {

std::uint8_t toByte(float unit) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(unit, 0.0F, 1.0F) * 255.0F));
}

}  // namespace

Conversion convertVelodyne(const mrpt::obs::CObservationVelodyneScan& observation) {
  // generatePointCloud() writes into the observation, which is not ours.
  mrpt::obs::CObservationVelodyneScan sweep = observation;
  if (!sweep.scan_packets.empty()) {
    mrpt::obs::CObservationVelodyneScan::TGeneratePointCloudParameters parameters;
    parameters.minDistance = static_cast<float>(sweep.minRange);
    parameters.maxDistance = static_cast<float>(sweep.maxRange);
    sweep.generatePointCloud(parameters);
  }
  const auto& points = sweep.point_cloud;
  sensors::PointCloud cloud;
  cloud.T_body_sensor = toPose3(sweep.sensorPose);
  cloud.points_in_sensor.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f point(points.x[i], points.y[i], points.z[i]);
    if (!point.allFinite()) continue;
    cloud.points_in_sensor.push_back(point);
    if (points.intensity.size() == points.size()) {
      cloud.intensity.push_back(static_cast<float>(points.intensity[i]) / 255.0F);
    }
  }
  return Converted{std::move(cloud)};
}

Conversion convertPointCloud(const mrpt::obs::CObservation& observation) {
  const auto& source = dynamic_cast<const mrpt::obs::CObservationPointCloud&>(observation);
  if (!source.pointcloud) return NotConverted{"empty CObservationPointCloud"};
  const auto& points = *source.pointcloud;
  const auto* colored = dynamic_cast<const mrpt::maps::CColouredPointsMap*>(&points);
  const auto* intense = dynamic_cast<const mrpt::maps::CPointsMapXYZI*>(&points);

  sensors::PointCloud cloud;
  cloud.T_body_sensor = toPose3(source.sensorPose);
  cloud.points_in_sensor.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::Vector3f point;
    points.getPointFast(i, point.x(), point.y(), point.z());
    if (!point.allFinite()) continue;  // how organised clouds mark a missing return
    cloud.points_in_sensor.push_back(point);
    if (colored != nullptr) {
      float r = 0.0F;
      float g = 0.0F;
      float b = 0.0F;
      colored->getPointColor_fast(i, r, g, b);
      cloud.color.push_back({toByte(r), toByte(g), toByte(b)});
    }
    if (intense != nullptr) cloud.intensity.push_back(intense->getPointIntensity_fast(i));
  }
  return Converted{std::move(cloud)};
}

}  // namespace prodomos::io

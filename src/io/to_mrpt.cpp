// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/to_mrpt.hpp"

#include "prodomos/base/error.hpp"

#include "io/images.hpp"
#include "io/mrpt_values.hpp"

#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <cmath>

namespace prodomos::io {

namespace {

using mrpt::obs::CObservation;

/// MRPT's fans are symmetric about the sensor's x-axis: a fan that is not turns the sensor instead.
CObservation::Ptr convert(const sensors::LaserScan& scan) {
  auto observation = std::make_shared<mrpt::obs::CObservation2DRangeScan>();
  const double aperture = scan.ranges.empty() ? 0.0 : scan.angleStep * static_cast<double>(scan.ranges.size() - 1);
  const double middle = scan.firstAngle + aperture / 2.0;
  observation->sensorPose = toMrpt(scan.T_body_sensor * geometry::toPose3({0.0, 0.0, middle}));
  observation->aperture = static_cast<float>(std::abs(aperture));
  observation->rightToLeft = aperture >= 0.0;
  observation->maxRange = static_cast<float>(scan.maxRange);
  observation->resizeScan(scan.ranges.size());
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const float range = scan.ranges[i];
    const bool none = range == sensors::LaserScan::kNoReturn;
    const bool invalid = range == sensors::LaserScan::kInvalid;
    observation->setScanRange(i, none ? observation->maxRange : invalid ? 0.0F : range);
    observation->setScanRangeValidity(i, !none && !invalid);
  }
  return observation;
}

CObservation::Ptr convert(const sensors::Odometry& odometry) {
  auto observation = std::make_shared<mrpt::obs::CObservationOdometry>();
  observation->odometry = planarPose(odometry);
  return observation;
}

CObservation::Ptr convert(const sensors::RecordedPose& pose) {
  auto observation = std::make_shared<mrpt::obs::CObservationRobotPose>();
  observation->pose.mean = toMrpt(pose.T_world_body);
  return observation;
}

CObservation::Ptr convert(const sensors::PointCloud& cloud) {
  auto observation = std::make_shared<mrpt::obs::CObservationPointCloud>();
  observation->sensorPose = toMrpt(cloud.T_body_sensor);
  const auto& points = cloud.points_in_sensor;
  const auto fill = [&](auto map, const auto& setRest) {
    map->resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      map->setPointFast(i, points[i].x(), points[i].y(), points[i].z());
      setRest(*map, i);
    }
    observation->pointcloud = map;
  };
  if (!cloud.color.empty()) {
    constexpr float kUnit = 1.0F / 255.0F;
    fill(std::make_shared<mrpt::maps::CColouredPointsMap>(), [&](auto& map, std::size_t i) {
      const auto [r, g, b] = cloud.color[i];
      map.setPointColor_fast(i, static_cast<float>(r) * kUnit, static_cast<float>(g) * kUnit,
                             static_cast<float>(b) * kUnit);
    });
  } else if (!cloud.intensity.empty()) {
    fill(std::make_shared<mrpt::maps::CPointsMapXYZI>(),
         [&](auto& map, std::size_t i) { map.setPointIntensity(i, cloud.intensity[i]); });
  } else {
    fill(std::make_shared<mrpt::maps::CSimplePointsMap>(), [](auto&, std::size_t) {});
  }
  return observation;
}

/// Class k as bit k - 1 of the pixel, see the reader.
void addLabels(const sensors::LabelImage& labels, const sensors::ClassTable& classes,
               mrpt::obs::CObservation3DRangeScan& observation) {
  using Labels = mrpt::obs::TPixelLabelInfo<8>;
  constexpr int kMostClasses = 64;
  auto info = std::make_shared<Labels>();
  info->setSize(labels.classes.height(), labels.classes.width());
  for (int y = 0; y < labels.classes.height(); ++y) {
    for (int x = 0; x < labels.classes.width(); ++x) {
      const int id = labels.classes(x, y);
      if (id > kMostClasses) {
        throw base::Error(base::expectedFound("rawlog", "class ids up to 64 in label images", std::to_string(id)));
      }
      if (id > 0) info->setLabel(y, x, static_cast<std::uint8_t>(id - 1));
    }
  }
  for (const auto& [id, name] : classes) {
    if (id > 0 && id <= kMostClasses) info->setLabelName(static_cast<unsigned>(id - 1), name);
  }
  observation.pixelLabels = info;
}

void addDepth(const sensors::Image<float>& depth, mrpt::obs::CObservation3DRangeScan& observation) {
  constexpr float kUnit = 0.001F;  // metres
  constexpr float kMost = 65535.0F;
  observation.hasRangeImage = true;
  observation.range_is_depth = true;
  observation.rangeUnits = kUnit;
  observation.rangeImage_setSize(depth.height(), depth.width());
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      const float units = std::round(depth(x, y) / kUnit);
      observation.rangeImage(y, x) =
          units > 0.0F && units <= kMost ? static_cast<std::uint16_t>(units) : std::uint16_t{0};
    }
  }
}

CObservation::Ptr convert(const sensors::RgbdFrame& frame, const sensors::ClassTable& classes) {
  auto observation = std::make_shared<mrpt::obs::CObservation3DRangeScan>();
  const bool hasDepth = !frame.depth.empty();
  const int width = hasDepth ? frame.depth.width() : frame.color.width();
  const int height = hasDepth ? frame.depth.height() : frame.color.height();
  observation->cameraParams = toMrpt(frame.camera, width, height);
  observation->cameraParamsIntensity = observation->cameraParams;
  observation->sensorPose = toMrpt(frame.T_body_camera * sensors::cameraAxesInBody().inverse());
  observation->relativePoseIntensityWRTDepth = toMrpt(sensors::cameraAxesInBody());
  if (hasDepth) addDepth(frame.depth, *observation);
  if (!frame.color.empty()) {
    observation->hasIntensityImage = true;
    observation->intensityImage = mrpt::img::CImage(toBgr(frame.color), mrpt::img::DEEP_COPY);
  }
  if (frame.labels) addLabels(*frame.labels, classes, *observation);
  return observation;
}

}  // namespace

mrpt::poses::CPose2D planarPose(const sensors::Odometry& odometry) {
  constexpr double kTolerance = 1e-6;  // metres, radians
  const auto& pose = odometry.T_odom_body;
  const auto planar = geometry::toPose2(pose);
  if (!pose.matrix().isApprox(geometry::toPose3(planar).matrix(), kTolerance)) {
    throw base::Error(base::expectedFound("rawlog", "odometry in the plane", "a height, pitch or roll"));
  }
  return {planar.x, planar.y, planar.theta};
}

mrpt::obs::CObservation::Ptr toMrpt(const sensors::Reading& reading, const sensors::ClassTable& classes) {
  auto observation = std::visit(
      [&](const auto& data) -> CObservation::Ptr {
        if constexpr (requires { convert(data); }) {
          return convert(data);
        } else if constexpr (requires { convert(data, classes); }) {
          return convert(data, classes);
        } else {
          throw base::Error(base::expectedFound("rawlog", "a reading that MRPT has a class for",
                                                std::string(sensors::kindName(reading.data))));
        }
      },
      reading.data);
  observation->timestamp = toMrpt(reading.time);
  observation->sensorLabel = reading.sensor;
  return observation;
}

}  // namespace prodomos::io

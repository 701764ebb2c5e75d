// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/mrpt_readings.hpp"

#include "prodomos/io/from_mrpt.hpp"

#include "io/mrpt_values.hpp"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CObservationStereoImages.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <cmath>

namespace prodomos::io {

namespace {

Conversion checkedPose(const geometry::Pose3& pose, sensors::ReadingData data) {
  if (geometry::isFinite(pose)) return Converted{std::move(data)};
  return NotConverted{"damaged pose", "expected a finite pose, found NaN or infinity"};
}

/// Tells the classes that prodomos reads from the others, and their default labels.
struct KnownClass {
  const char* label = nullptr;
  Conversion conversion;
};

KnownClass convert(const mrpt::obs::CObservation& observation) {
  using namespace mrpt::obs;  // NOLINT(google-build-using-namespace): six long names in one table
  if (const auto* scan = dynamic_cast<const CObservation2DRangeScan*>(&observation)) {
    return {"laser", convertScan(*scan)};
  }
  if (const auto* odometry = dynamic_cast<const CObservationOdometry*>(&observation)) {
    const auto pose = toPose3(odometry->odometry);
    return {"odometry", checkedPose(pose, sensors::Odometry{pose})};
  }
  if (const auto* image = dynamic_cast<const CObservation3DRangeScan*>(&observation)) {
    return {"camera", convertRangeImage(*image)};
  }
  if (const auto* sweep = dynamic_cast<const CObservationVelodyneScan*>(&observation)) {
    return {"lidar", convertVelodyne(*sweep)};
  }
  if (dynamic_cast<const CObservationPointCloud*>(&observation) != nullptr) {
    return {"point_cloud", convertPointCloud(observation)};
  }
  if (const auto* pair = dynamic_cast<const CObservationStereoImages*>(&observation)) {
    return {"stereo", convertStereo(*pair)};
  }
  if (const auto* robot = dynamic_cast<const CObservationRobotPose*>(&observation)) {
    const auto pose = toPose3(robot->pose.mean);
    return {"robot_pose", checkedPose(pose, sensors::RecordedPose{pose})};
  }
  return {"", NotConverted{"unsupported " + className(observation)}};
}

}  // namespace

std::string className(const mrpt::rtti::CObject& object) {
  const std::string name = object.GetRuntimeClass()->className;
  return name.substr(name.find_last_of(':') + 1);
}

sensors::SourceItem toItem(const mrpt::obs::CObservation& observation, base::Time time, const std::string& place) {
  auto [defaultLabel, conversion] = convert(observation);
  const auto faultOf = [&](const std::string& damage) { return damage.empty() ? "" : place + ": " + damage; };
  if (const auto* nothing = std::get_if<NotConverted>(&conversion)) {
    return sensors::Skipped{nothing->reason, faultOf(nothing->damage), time};
  }
  auto& converted = std::get<Converted>(conversion);
  const auto& label = observation.sensorLabel;
  return sensors::Reading{time, label.empty() ? defaultLabel : label, std::move(converted.data),
                          faultOf(converted.damage)};
}

sensors::SourceItem fromMrpt(const ::mrpt::obs::CObservation& observation) {
  const auto time = toTime(observation.timestamp);
  const auto place = className(observation) + " `" + observation.sensorLabel + "`";
  if (!time) return sensors::Skipped{"no time stamp", place + ": expected a time stamp, found none", {}};
  try {
    const MrptScope quiet;
    observation.load();
    return toItem(observation, *time, place);
  } catch (const std::exception&) {
    return sensors::Skipped{"unreadable " + className(observation), place + ": expected readable content, found damage",
                            *time};
  }
}

}  // namespace prodomos::io

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/mapper/mapper.hpp"

#include "support/laser_world.hpp"

#include <numeric>
#include <vector>

/// Drives through four rooms, for tests of the mapper.
namespace prodomos::mapper {

inline testing::LaserRobot coarseRobot() {
  testing::LaserRobot robot;
  robot.beams = 91;
  robot.rangeNoise = 0.0;
  robot.odometryNoise = 0.0;
  return robot;
}

/// Along the corridor and into the first room: 25 m, wheels and laser without fault.
inline std::vector<sensors::Reading> shortDrive() {
  return driveThrough(testing::fourRooms(), {{1.0, 1.0}, {13.0, 1.0}, {6.0, 1.1}, {6.0, 3.4}, {7.0, 3.4}},
                      coarseRobot());
}

/// Wheels that tell a tenth too much and turn 2° a metre; a laser that errs by a centimetre.
inline testing::LaserRobot slippingRobot() {
  testing::LaserRobot robot;
  robot.beams = 121;
  robot.fieldOfView = 4.0;
  robot.wheelScale = 1.1;
  robot.wheelTurn = 0.035;
  return robot;
}

/// Through all four rooms and back, by a robot whose wheels slip.
inline const std::vector<sensors::Reading>& slippingTour() {
  static const auto kLog = driveThrough(testing::fourRooms(), testing::tourOfFourRooms(), slippingRobot());
  return kLog;
}

/// Where the robot of a drive truly is at each of its scans, from where it began.
inline std::vector<geometry::Pose2> truthOf(const std::vector<Eigen::Vector2d>& path) {
  testing::LaserRobot robot;
  robot.beams = 2;
  robot.odometryNoise = 0.0;
  std::vector<geometry::Pose2> truth;
  for (const auto& reading : driveThrough(testing::LaserWorld({}, 1.0), path, robot)) {
    if (const auto* wheels = std::get_if<sensors::Odometry>(&reading.data))
      truth.push_back(geometry::toPose2(wheels->T_odom_body));
  }
  return truth;
}

/// Poses as the wheels tell them.
inline MapperConfig byWheels() {
  MapperConfig config;
  config.input.poses = "odometry";
  return config;
}

inline sensors::SourceInfo liveInfo(bool hasRecordedPoses = false) {
  sensors::SourceInfo info;
  info.path = "memory.log";
  info.kind = "readings in memory";
  info.hasRecordedPoses = hasRecordedPoses;
  return info;
}

inline std::int64_t skippedOf(const Report& report) {
  return std::accumulate(report.skippedByReason.begin(), report.skippedByReason.end(), std::int64_t{0},
                         [](std::int64_t sum, const auto& reason) { return sum + reason.second; });
}

}  // namespace prodomos::mapper

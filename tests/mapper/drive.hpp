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

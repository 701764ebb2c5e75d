// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pose.hpp"
#include "prodomos/simulation/building.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace prodomos::simulation {

/// A point of a given path.
struct Stop {
  int storey = 0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
};

struct TourOptions {
  std::uint64_t seed = 0;
  double duration = 120.0;        ///< seconds
  double speed = 0.6;             ///< at most, m/s
  double turnRate = 0.8;          ///< at most, rad/s
  double acceleration = 0.5;      ///< m/s²
  double turnAcceleration = 1.6;  ///< rad/s²
  double robotRadius = 0.25;      ///< metres
  std::vector<Stop> path;         ///< driven straight from point to point; empty: the robot explores by seed
};

struct TourPose {
  double time = 0.0;                                           ///< seconds
  geometry::Pose3 T_world_body = geometry::Pose3::Identity();  ///< x ahead; on the floor, below the robot's middle
};

struct Tour {
  std::vector<TourPose> poses;       ///< from 0 to the duration, at most 0.02 s apart
  std::vector<std::string> remarks;  ///< what the tour could not do, and why
};

/// Between two poses it moves evenly; before the first and after the last it stands.
geometry::Pose3 poseAt(const Tour& tour, double time);

/// The way of a robot that explores: it sees the corridors first, passes their doors, then enters some rooms and turns
/// round in them, and by the middle of the time changes floor by a lift or is carried over the stairs. Doors that it
/// passes are opened for it in time and closed some time later, and some others open while it is elsewhere: their
/// swings are added to the building. It stops for people who walk into its way, and those it comes close to step aside:
/// their ways are changed (call populate() before). Same building and options, same tour. Throws base::UsageError for a
/// time or limit that is not positive and for a given path that cannot be driven, naming the point, and base::Error
/// where the robot can stand nowhere.
Tour planTour(Building& building, const TourOptions& options);

}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/time.hpp"
#include "prodomos/geometry/pose.hpp"
#include "prodomos/map/records.hpp"

#include <optional>
#include <vector>

namespace prodomos::evaluation {

/// Where something was, in a frame that does not move.
struct TimedPose {
  base::Time time{};
  geometry::Pose3 pose = geometry::Pose3::Identity();
};

/// Which poses of a map are meant: as refined, or as the robot believed them while it travelled.
enum class Poses { kRefined, kTravelled };

/// The body's way through all sessions, in the order of time.
std::vector<TimedPose> bodyPoses(const std::vector<map::TrajectoryPoint>& trajectory, Poses which);

/// The one nearest in time, the earlier of two; null where none is within `tolerance`. `poses` ascend in time.
const TimedPose* findNearest(const std::vector<TimedPose>& poses, base::Time time, base::Duration tolerance);

}  // namespace prodomos::evaluation

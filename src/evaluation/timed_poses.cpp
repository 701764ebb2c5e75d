// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/timed_poses.hpp"

#include <algorithm>

namespace prodomos::evaluation {

std::vector<TimedPose> bodyPoses(const std::vector<map::TrajectoryPoint>& trajectory, Poses which) {
  std::vector<TimedPose> poses;
  poses.reserve(trajectory.size());
  for (const auto& point : trajectory) {
    poses.push_back({point.time, which == Poses::kRefined ? point.T_map_body : point.T_travel_body});
  }
  std::ranges::stable_sort(poses, {}, &TimedPose::time);
  return poses;
}

const TimedPose* findNearest(const std::vector<TimedPose>& poses, base::Time time, base::Duration tolerance) {
  const auto after = std::ranges::lower_bound(poses, time, {}, &TimedPose::time);
  const TimedPose* nearest = after == poses.end() ? nullptr : &*after;
  if (after != poses.begin()) {
    const auto& before = *std::prev(after);
    if (nearest == nullptr || time - before.time <= nearest->time - time) nearest = &before;
  }
  if (nearest == nullptr || std::chrono::abs(nearest->time - time) > tolerance) return nullptr;
  return nearest;
}

}  // namespace prodomos::evaluation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/pose_track.hpp"

#include "mapper/graph_bytes.hpp"

#include <algorithm>

namespace prodomos::mapper {

namespace {
constexpr base::Duration kMargin = std::chrono::seconds(2);
}

std::deque<PoseTrack::TimedPose>::const_iterator PoseTrack::firstFrom(base::Time time) const {
  return std::ranges::lower_bound(poses_, time, {}, &TimedPose::time);
}

void PoseTrack::add(base::Time time, const geometry::Pose3& pose) {
  const auto at = poses_.begin() + (firstFrom(time) - poses_.cbegin());
  if (at != poses_.end() && at->time == time) {
    at->pose = pose;
  } else {
    poses_.insert(at, {time, pose});
  }
}

geometry::Pose3 PoseTrack::at(base::Time time) const {
  if (empty()) return geometry::Pose3::Identity();
  const auto after = firstFrom(time);
  if (after == poses_.end()) return poses_.back().pose;
  if (after == poses_.begin() || after->time == time) return after->pose;
  const auto& before = *std::prev(after);
  return geometry::interpolate(before.pose, after->pose,
                               base::seconds(time - before.time) / base::seconds(after->time - before.time));
}

std::optional<base::Duration> PoseTrack::distanceTo(base::Time time) const {
  if (empty()) return std::nullopt;
  const auto after = firstFrom(time);
  if (after == poses_.end()) return time - poses_.back().time;
  if (after == poses_.begin()) return after->time - time;
  return std::min(after->time - time, time - std::prev(after)->time);
}

void PoseTrack::forgetAllBut(std::size_t count) {
  while (poses_.size() > count) poses_.pop_front();
}

void PoseTrack::forgetBefore(base::Time time) {
  while (poses_.size() > 2 && poses_[1].time < time - kMargin) poses_.pop_front();
}

void PoseTrack::save(base::ByteWriter& out) const {
  out << static_cast<std::uint64_t>(poses_.size());
  for (const auto& [time, pose] : poses_) {
    saveTime(out, time);
    savePose(out, pose);
  }
}

void PoseTrack::load(base::ByteReader& in) {
  poses_.clear();
  for (auto left = in.read<std::uint64_t>(); left > 0; --left) {
    const auto time = loadTime(in);
    poses_.push_back({time, loadPose(in)});
  }
}

}  // namespace prodomos::mapper

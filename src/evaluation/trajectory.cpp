// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/trajectory.hpp"

#include <algorithm>

namespace prodomos::evaluation {

namespace {

/// How far apart in time a pose and its truth may be: evaluate_rpe.py takes twice the truth's median interval.
base::Duration mostApart(const std::vector<TimedPose>& truth) {
  std::vector<base::Duration> intervals;
  for (std::size_t i = 1; i < truth.size(); ++i) intervals.push_back(truth[i].time - truth[i - 1].time);
  if (intervals.empty()) return {};
  std::ranges::sort(intervals);
  return intervals[(intervals.size() - 1) / 2] + intervals[intervals.size() / 2];
}

}  // namespace

std::vector<PositionPair> associate(const std::vector<TimedPose>& estimate, const std::vector<TimedPose>& truth,
                                    base::Duration tolerance) {
  struct Candidate {
    base::Duration apart;
    std::size_t estimated;
    std::size_t actual;
    auto operator<=>(const Candidate&) const = default;
  };
  std::vector<Candidate> candidates;
  std::size_t first = 0;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    while (first < truth.size() && truth[first].time <= estimate[i].time - tolerance) ++first;
    for (std::size_t j = first; j < truth.size() && truth[j].time < estimate[i].time + tolerance; ++j) {
      candidates.push_back({std::chrono::abs(truth[j].time - estimate[i].time), i, j});
    }
  }
  std::ranges::sort(candidates);

  std::vector<const TimedPose*> truthOf(estimate.size(), nullptr);
  std::vector<bool> used(truth.size(), false);
  for (const auto& candidate : candidates) {
    if (truthOf[candidate.estimated] != nullptr || used[candidate.actual]) continue;
    truthOf[candidate.estimated] = &truth[candidate.actual];
    used[candidate.actual] = true;
  }
  std::vector<PositionPair> pairs;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    if (truthOf[i] != nullptr) pairs.emplace_back(estimate[i].pose.translation(), truthOf[i]->pose.translation());
  }
  return pairs;
}

geometry::Pose3 alignment(const std::vector<PositionPair>& pairs) {
  if (pairs.empty()) return geometry::Pose3::Identity();
  Eigen::Matrix3Xd estimated(3, pairs.size());
  Eigen::Matrix3Xd truth(3, pairs.size());
  for (Eigen::Index i = 0; i < estimated.cols(); ++i) {
    estimated.col(i) = pairs[static_cast<std::size_t>(i)].first;
    truth.col(i) = pairs[static_cast<std::size_t>(i)].second;
  }
  return geometry::Pose3(Eigen::umeyama(estimated, truth, false));
}

std::vector<double> absoluteErrors(const std::vector<PositionPair>& pairs) {
  const geometry::Pose3 T_truth_estimate = alignment(pairs);
  std::vector<double> errors;
  errors.reserve(pairs.size());
  for (const auto& [estimated, truth] : pairs) errors.push_back((T_truth_estimate * estimated - truth).norm());
  return errors;
}

RelativeErrors relativeErrors(const std::vector<TimedPose>& estimate, const std::vector<TimedPose>& truth,
                              base::Duration delta) {
  RelativeErrors errors;
  const base::Duration tolerance = mostApart(truth);
  for (const auto& begin : estimate) {
    const auto* end = findNearest(estimate, begin.time + delta, base::Duration::max());
    // The last pose is the nearest to all times beyond it too: evaluate_rpe.py leaves it out. It does not leave out the
    // stretch from a pose to itself, where the next is far: an error of zero that says nothing.
    if (end == &estimate.back() || end == &begin) continue;
    const auto* trueBegin = findNearest(truth, begin.time, tolerance);
    const auto* trueEnd = findNearest(truth, end->time, tolerance);
    if (trueBegin == nullptr || trueEnd == nullptr) continue;
    const geometry::Pose3 T_end_begin = end->pose.inverse() * begin.pose;
    const geometry::Pose3 T_trueBegin_trueEnd = trueBegin->pose.inverse() * trueEnd->pose;
    const geometry::Pose3 error = T_end_begin * T_trueBegin_trueEnd;
    errors.translation.push_back(error.translation().norm());
    errors.rotation.push_back(geometry::rotationAngle(error));
  }
  return errors;
}

}  // namespace prodomos::evaluation

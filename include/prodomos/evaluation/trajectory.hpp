// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/statistics.hpp"
#include "prodomos/evaluation/timed_poses.hpp"

#include <utility>
#include <vector>

/// A way against its truth, as evaluate_ate.py and evaluate_rpe.py of the TUM RGB-D benchmark (Sturm et al. 2012)
/// define it. Estimate and truth must be of the same frame on the robot (a camera, the body); the frames that they are
/// given in may differ.
namespace prodomos::evaluation {

/// An estimated position and the true one.
using PositionPair = std::pair<Eigen::Vector3d, Eigen::Vector3d>;

/// Each pose with the true one nearest in time, nearest pairs first, each pose once, none `tolerance` or more apart.
std::vector<PositionPair> associate(const std::vector<TimedPose>& estimate, const std::vector<TimedPose>& truth,
                                    base::Duration tolerance = std::chrono::milliseconds(20));

/// The T_truth_estimate of the least sum of squared distances (Horn 1987), without scale.
geometry::Pose3 alignment(const std::vector<PositionPair>& pairs);

/// Absolute trajectory error: distances in metres after alignment, in the order of time.
std::vector<double> absoluteErrors(const std::vector<PositionPair>& pairs);

/// How much a stretch of the way differs from the true one.
struct RelativeErrors {
  std::vector<double> translation;  ///< metres
  std::vector<double> rotation;     ///< radians
};

/// Relative pose error over stretches that are nearest to `delta` long: evaluate_rpe.py --fixed_delta --delta_unit s.
RelativeErrors relativeErrors(const std::vector<TimedPose>& estimate, const std::vector<TimedPose>& truth,
                              base::Duration delta = std::chrono::seconds(1));

}  // namespace prodomos::evaluation

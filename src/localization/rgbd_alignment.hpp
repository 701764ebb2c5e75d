// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/geometry/plane.hpp"
#include "prodomos/map/topological_graph.hpp"
#include "prodomos/sensors/depth_grid.hpp"

#include "localization/rgbd_features.hpp"

#include <optional>
#include <span>
#include <vector>

namespace prodomos::localization::rgbd {

using sensors::DepthGrid;
using sensors::depthSigma;

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// What is known of a frame once it was looked at.
struct View {
  Camera camera;
  std::vector<KeyPoint> points;
  DepthGrid depth;
};

struct MatchedPose {
  geometry::Pose3 T_reference_current = geometry::Pose3::Identity();
  int inliers = 0;
};

/// The pose from matches alone, three at a time (RANSAC); none where fewer than twelve agree. Chance is drawn from
/// `random` alone.
std::optional<MatchedPose> poseFromMatches(const View& reference, const View& current, std::span<const Match> matches,
                                           base::Random& random);

/// A view whose pose is known, and what of it was found again.
struct Reference {
  const View* view = nullptr;
  geometry::Pose3 T_world_camera = geometry::Pose3::Identity();
  std::vector<Match> matches;
};

/// What speaks for a pose besides the images.
struct Belief {
  geometry::Pose3 T_world_camera = geometry::Pose3::Identity();
  Vector6 sigma = Vector6::Constant(1.0);  ///< metres, radians; in the camera's own axes
};

/// A plane seen in the frame that must be the world's floor.
struct FloorSeen {
  geometry::Plane plane_in_camera;  ///< its normal points up
  double tiltSigma = 0.03;          ///< radians
  double heightSigma = 0.05;        ///< metres
};

struct Alignment {
  geometry::Pose3 T_world_camera = geometry::Pose3::Identity();
  map::Matrix6 information = map::Matrix6::Zero();  ///< of (m, rad) in the camera's own axes
  int pointInliers = 0;                             ///< matches that agree
  double depthInliers = 0.0;                        ///< share of depths that fall onto known surfaces and agree
  int depthCount = 0;                               ///< depths that fall onto known surfaces

  /// For comparing two poses of one frame.
  double quality() const;
  /// Whether images can agree so well by chance.
  bool isConvincing() const;
};

/// The pose that agrees best with all references at once: reprojection and depth of the matches, distances of the
/// depths from the references' surfaces (point to plane, projective association), what is believed, and the floor.
/// Gauss-Newton with robust weights from `start` on.
Alignment align(const View& current, std::span<const Reference> references, const geometry::Pose3& start,
                const Belief& belief, const std::optional<FloorSeen>& floor);

/// exp of (translation, rotation vector); the translation is not curved.
geometry::Pose3 smallMotion(const Vector6& motion);

/// The share of the current depths that fall onto surfaces seen by the other.
double overlap(const View& current, const View& other, const geometry::Pose3& T_other_current);

}  // namespace prodomos::localization::rgbd

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pose.hpp"
#include "prodomos/map/surface_layer.hpp"

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

/// Scans and sub-maps in the plane: `body` is what the points are given in, `map` what the surface is given in.
namespace prodomos::localization {

/// What is known of the pose before the match.
struct PosePrior {
  geometry::Pose2 T_map_body;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of x, y (metres), theta (radians) in the body's own axes
};

struct Match {
  geometry::Pose2 T_map_body;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the points alone, as that of PosePrior
  double explained = 0.0;                                 ///< share of the points that lie on a surface, 0 … 1
  double residual = 0.0;                                  ///< root mean square distance of these, metres
};

struct ScanMatcherConfig {
  double noise = 0.03;   ///< metres from the surface, of one end point, the map's own faults included
  double outlier = 0.1;  ///< metres; farther ones count ever less
  int iterations = 20;
};

/// Gauss-Newton on the distances of points to the surface around them. Converges from some 0.2 m and 10 degrees away.
Match matchScan(std::span<const Eigen::Vector2d> points_in_body, const map::SurfaceLayer& surface,
                const PosePrior& prior, const ScanMatcherConfig& config = {});

}  // namespace prodomos::localization

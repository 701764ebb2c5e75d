// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/plane.hpp"
#include "prodomos/geometry/pose.hpp"
#include "prodomos/sensors/depth_grid.hpp"

#include <optional>
#include <span>

namespace prodomos::localization::rgbd {

using sensors::DepthGrid;
using sensors::depthSigma;

/// A depth grid with normals, and where it was taken.
struct PosedDepth {
  const DepthGrid* depth = nullptr;
  geometry::Pose3 T_world_camera = geometry::Pose3::Identity();
};

/// The floor in the world's frame, its normal up: up is where most normals within 50° of `up_in_world` point; the floor
/// is the lowest level surface under the cameras with next to nothing below it. None where too little level is seen.
std::optional<geometry::Plane> findFloor(std::span<const PosedDepth> views, const Eigen::Vector3d& up_in_world);

/// The floor again, in the camera's frame, only where a large plane lies level within 3° at z = 0 within a tenth of a
/// metre: a ramp, stairs, a table or another storey is none.
std::optional<geometry::Plane> confirmFloor(const DepthGrid& depth, const geometry::Pose3& T_world_camera);

/// The camera's pose over the floor: z up, origin on the floor below it, x along `ahead_in_camera`.
geometry::Pose3 poseOverFloor(const Eigen::Vector3d& up_in_camera, double height,
                              const Eigen::Vector3d& ahead_in_camera);

}  // namespace prodomos::localization::rgbd

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/reading.hpp"

#include <Eigen/Core>

namespace prodomos::simulation {

/// Pixel (0, 0) is the middle of the upper left one. The default is an Xtion's, without distortion.
struct CameraModel {
  int width = 640;
  int height = 480;
  sensors::CameraIntrinsics intrinsics{525.0, 525.0, 319.5, 239.5, {}};
};

/// Where the point, in camera axes and before the camera, appears.
Eigen::Vector2d project(const CameraModel& camera, const Eigen::Vector3d& point_in_camera);

/// The inverse: of all points that appear at the pixel that one with z = 1.
Eigen::Vector3d directionThrough(const CameraModel& camera, const Eigen::Vector2d& pixel);

}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/camera_model.hpp"

#include "prodomos/sensors/lens.hpp"

#include <Eigen/Geometry>

namespace prodomos::simulation {

Eigen::Vector2d project(const CameraModel& camera, const Eigen::Vector3d& point_in_camera) {
  const auto& in = camera.intrinsics;
  const Eigen::Vector2d point = sensors::distorted(in.distortion, point_in_camera.hnormalized());
  return {in.fx * point.x() + in.cx, in.fy * point.y() + in.cy};
}

Eigen::Vector3d directionThrough(const CameraModel& camera, const Eigen::Vector2d& pixel) {
  const auto& in = camera.intrinsics;
  const Eigen::Vector2d seen((pixel.x() - in.cx) / in.fx, (pixel.y() - in.cy) / in.fy);
  // A lens bends little: subtracting what it adds converges to the pixel's own accuracy in a few rounds.
  constexpr int kRounds = 20;
  Eigen::Vector2d point = seen;
  for (int round = 0; round < kRounds; ++round) point += seen - sensors::distorted(in.distortion, point);
  return point.homogeneous();
}

}  // namespace prodomos::simulation

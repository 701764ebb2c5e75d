// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/camera_model.hpp"

#include <Eigen/Geometry>

#include <array>

namespace prodomos::simulation {
namespace {

/// The radial-tangential model of OpenCV, on the plane z = 1.
Eigen::Vector2d distorted(const std::array<double, 5>& distortion, const Eigen::Vector2d& point) {
  const auto [k1, k2, p1, p2, k3] = distortion;
  const double x = point.x();
  const double y = point.y();
  const double r2 = point.squaredNorm();
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

}  // namespace

Eigen::Vector2d project(const CameraModel& camera, const Eigen::Vector3d& point_in_camera) {
  const auto& in = camera.intrinsics;
  const Eigen::Vector2d point = distorted(in.distortion, point_in_camera.hnormalized());
  return {in.fx * point.x() + in.cx, in.fy * point.y() + in.cy};
}

Eigen::Vector3d directionThrough(const CameraModel& camera, const Eigen::Vector2d& pixel) {
  const auto& in = camera.intrinsics;
  const Eigen::Vector2d seen((pixel.x() - in.cx) / in.fx, (pixel.y() - in.cy) / in.fy);
  // A lens bends little: subtracting what it adds converges to the pixel's own accuracy in a few rounds.
  constexpr int kRounds = 20;
  Eigen::Vector2d point = seen;
  for (int round = 0; round < kRounds; ++round) point += seen - distorted(in.distortion, point);
  return point.homogeneous();
}

}  // namespace prodomos::simulation

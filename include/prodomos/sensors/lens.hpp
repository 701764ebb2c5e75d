// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>

namespace prodomos::sensors {

/// Where a lens shows a point of the plane one metre ahead of the camera, on that plane: the radial-tangential model of
/// OpenCV with the coefficients of CameraIntrinsics.
inline Eigen::Vector2d distorted(const std::array<double, 5>& distortion, const Eigen::Vector2d& point) {
  const auto& [k1, k2, p1, p2, k3] = distortion;
  const double x = point.x();
  const double y = point.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

}  // namespace prodomos::sensors

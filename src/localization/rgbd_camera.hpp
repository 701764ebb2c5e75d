// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/reading.hpp"

#include <Eigen/Core>

namespace prodomos::localization::rgbd {

/// A pinhole camera with distortion; a `ray` is a point of the plane one metre ahead of it.
class Camera {
 public:
  Camera() = default;
  Camera(const sensors::CameraIntrinsics& intrinsics, int width, int height)
      : intrinsics_(intrinsics), width_(width), height_(height) {}

  const sensors::CameraIntrinsics& intrinsics() const { return intrinsics_; }
  int width() const { return width_; }
  int height() const { return height_; }
  /// Pixels a radian at the centre.
  double focalLength() const { return 0.5 * (intrinsics_.fx + intrinsics_.fy); }
  bool operator==(const Camera&) const = default;

  Eigen::Vector2d pixel(const Eigen::Vector2d& ray) const {
    const auto& [k1, k2, p1, p2, k3] = intrinsics_.distortion;
    const double x = ray.x();
    const double y = ray.y();
    const double r2 = x * x + y * y;
    const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
    return {intrinsics_.fx * (x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x)) + intrinsics_.cx,
            intrinsics_.fy * (y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y) + intrinsics_.cy};
  }

  /// Fixed-point iteration, as OpenCV's undistortPoints.
  Eigen::Vector2d ray(const Eigen::Vector2d& pixel) const {
    Eigen::Vector2d distorted((pixel.x() - intrinsics_.cx) / intrinsics_.fx,
                              (pixel.y() - intrinsics_.cy) / intrinsics_.fy);
    if (intrinsics_.distortion == std::array<double, 5>{}) return distorted;
    Eigen::Vector2d ray = distorted;
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector2d again = this->pixel(ray);
      ray += distorted - Eigen::Vector2d((again.x() - intrinsics_.cx) / intrinsics_.fx,
                                         (again.y() - intrinsics_.cy) / intrinsics_.fy);
    }
    return ray;
  }

 private:
  sensors::CameraIntrinsics intrinsics_;
  int width_ = 0;
  int height_ = 0;
};

/// Standard deviation, metres, of a depth from structured light (Nguyen, Izadi, Lovell 2012).
inline double depthSigma(double depth) {
  const double beyond = depth - 0.4;
  return 0.0012 + 0.0019 * beyond * beyond;
}

}  // namespace prodomos::localization::rgbd

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/lens.hpp"
#include "prodomos/sensors/reading.hpp"

#include <Eigen/Core>

namespace prodomos::sensors {

/// A pinhole camera with distortion; a `ray` is a point of the plane one metre ahead of it.
class Camera {
 public:
  Camera() = default;
  Camera(const CameraIntrinsics& intrinsics, int width, int height)
      : intrinsics_(intrinsics), width_(width), height_(height) {}

  const CameraIntrinsics& intrinsics() const { return intrinsics_; }
  int width() const { return width_; }
  int height() const { return height_; }
  /// Pixels a radian at the centre.
  double focalLength() const { return 0.5 * (intrinsics_.fx + intrinsics_.fy); }
  bool operator==(const Camera&) const = default;

  Eigen::Vector2d pixel(const Eigen::Vector2d& ray) const {
    const Eigen::Vector2d seen = distorted(intrinsics_.distortion, ray);
    return {intrinsics_.fx * seen.x() + intrinsics_.cx, intrinsics_.fy * seen.y() + intrinsics_.cy};
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
  CameraIntrinsics intrinsics_;
  int width_ = 0;
  int height_ = 0;
};

/// Standard deviation, metres, of a depth from structured light (Nguyen, Izadi, Lovell 2012).
inline double depthSigma(double depth) {
  const double beyond = depth - 0.4;
  return 0.0012 + 0.0019 * beyond * beyond;
}

}  // namespace prodomos::sensors

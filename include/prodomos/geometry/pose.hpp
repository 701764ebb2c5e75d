// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <array>

namespace prodomos::geometry {

/// A rigid transform or pose in 3D. Named `T_a_b`: maps b-coordinates (metres) into a, p_a = T_a_b * p_b.
using Pose3 = Eigen::Isometry3d;

/// A pose in the plane: metres and radians.
struct Pose2 {
  double x = 0.0;
  double y = 0.0;
  double theta = 0.0;

  bool operator==(const Pose2&) const = default;
};

/// In (-pi, pi].
double normalizeAngle(double radians);

Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c);
Eigen::Vector2d operator*(const Pose2& T_a_b, const Eigen::Vector2d& point_in_b);
Pose2 inverse(const Pose2& T_a_b);

/// The plane's pose at height z.
Pose3 toPose3(const Pose2& pose, double z = 0.0);
/// Position and heading seen from above; roll, pitch and height are dropped.
Pose2 toPose2(const Pose3& pose);

/// Heading of the x-axis seen from above, radians.
double yaw(const Pose3& pose);

/// Z-Y-X angles in radians, metres.
Pose3 fromYawPitchRoll(const Eigen::Vector3d& translation, double yaw, double pitch, double roll);
/// The quaternion need not be of length one, but must not be zero.
Pose3 fromQuaternion(const Eigen::Vector3d& translation, const Eigen::Quaterniond& rotation);

/// From a (t = 0) to b (t = 1); t outside of [0, 1] extrapolates.
Pose3 interpolate(const Pose3& a, const Pose3& b, double t);

/// Same position and heading, z-axis up.
Pose3 levelled(const Pose3& pose);

/// Angle of the rotation, radians in [0, pi].
double rotationAngle(const Pose3& pose);

/// Maps small motions (metres, then a rotation vector in radians) in the axes of b into those of a; of covariances:
/// adjoint * covariance * adjoint^T.
Eigen::Matrix<double, 6, 6> adjoint(const Pose3& T_a_b);

/// Rows and columns of x, y and yaw in a 6x6 of (translation, rotation vector).
inline constexpr std::array<int, 3> kPlanarAxes = {0, 1, 5};

bool isFinite(const Pose3& pose);

}  // namespace prodomos::geometry

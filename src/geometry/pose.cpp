// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/pose.hpp"

#include <cmath>
#include <numbers>

namespace prodomos::geometry {

double normalizeAngle(double radians) {
  const double wrapped = std::remainder(radians, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c) {
  const double c = std::cos(T_a_b.theta);
  const double s = std::sin(T_a_b.theta);
  return {T_a_b.x + c * T_b_c.x - s * T_b_c.y, T_a_b.y + s * T_b_c.x + c * T_b_c.y,
          normalizeAngle(T_a_b.theta + T_b_c.theta)};
}

Eigen::Vector2d operator*(const Pose2& T_a_b, const Eigen::Vector2d& point_in_b) {
  return Eigen::Rotation2Dd(T_a_b.theta) * point_in_b + Eigen::Vector2d(T_a_b.x, T_a_b.y);
}

Pose2 inverse(const Pose2& T_a_b) {
  const double c = std::cos(T_a_b.theta);
  const double s = std::sin(T_a_b.theta);
  return {-c * T_a_b.x - s * T_a_b.y, s * T_a_b.x - c * T_a_b.y, normalizeAngle(-T_a_b.theta)};
}

Pose3 toPose3(const Pose2& pose, double z) {
  Pose3 lifted = Pose3::Identity();
  lifted.translation() = Eigen::Vector3d(pose.x, pose.y, z);
  lifted.linear() = Eigen::AngleAxisd(pose.theta, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return lifted;
}

Pose2 toPose2(const Pose3& pose) {
  return {pose.translation().x(), pose.translation().y(), yaw(pose)};
}

double yaw(const Pose3& pose) {
  return std::atan2(pose.linear()(1, 0), pose.linear()(0, 0));
}

Pose3 fromYawPitchRoll(const Eigen::Vector3d& translation, double yaw, double pitch, double roll) {
  Pose3 pose = Pose3::Identity();
  pose.translation() = translation;
  pose.linear() =
      (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  return pose;
}

Pose3 fromQuaternion(const Eigen::Vector3d& translation, const Eigen::Quaterniond& rotation) {
  Pose3 pose = Pose3::Identity();
  pose.translation() = translation;
  pose.linear() = rotation.normalized().toRotationMatrix();
  return pose;
}

Pose3 interpolate(const Pose3& a, const Pose3& b, double t) {
  Pose3 pose = Pose3::Identity();
  pose.translation() = a.translation() + t * (b.translation() - a.translation());
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(a.linear().transpose() * b.linear()));
  pose.linear() = a.linear() * Eigen::AngleAxisd(t * turn.angle(), turn.axis()).toRotationMatrix();
  return pose;
}

Pose3 levelled(const Pose3& pose) {
  return toPose3(toPose2(pose), pose.translation().z());
}

double rotationAngle(const Pose3& pose) {
  return Eigen::AngleAxisd(pose.linear()).angle();
}

Eigen::Matrix<double, 6, 6> adjoint(const Pose3& T_a_b) {
  const Eigen::Matrix3d rotation = T_a_b.linear();
  const Eigen::Vector3d t = T_a_b.translation();
  Eigen::Matrix3d cross;
  cross << 0.0, -t.z(), t.y(), t.z(), 0.0, -t.x(), -t.y(), t.x(), 0.0;
  Eigen::Matrix<double, 6, 6> adjoint;
  adjoint << rotation, cross * rotation, Eigen::Matrix3d::Zero(), rotation;
  return adjoint;
}

bool isFinite(const Pose3& pose) {
  return pose.matrix().allFinite();
}

}  // namespace prodomos::geometry

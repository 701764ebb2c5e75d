// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pose.hpp"
#include "prodomos/localization/pose_graph.hpp"

#include <cmath>

namespace prodomos::localization {

/// What the solver needs to know of a kind of pose: a form that is quick to compute with, how it moves, and how far a
/// measurement is off. Motions are in a pose's own axes, as in MotionMatrix.
template <typename Pose>
struct PoseSpace;

/// The deviation of a measured pose from the one that two states stand in, and how it changes as they move.
template <int D>
struct LinearizedError {
  Eigen::Matrix<double, D, 1> error;
  Eigen::Matrix<double, D, D> byFrom;
  Eigen::Matrix<double, D, D> byTo;
};

template <>
struct PoseSpace<geometry::Pose2> {
  static constexpr int kAxes = 2;
  using Motion = Eigen::Vector3d;

  struct State {
    Eigen::Vector2d translation = Eigen::Vector2d::Zero();
    double theta = 0.0;
    double cosine = 1.0;
    double sine = 0.0;

    Eigen::Matrix2d rotation() const { return (Eigen::Matrix2d() << cosine, -sine, sine, cosine).finished(); }
  };

  static State stateOf(const geometry::Pose2& pose) {
    return {{pose.x, pose.y}, pose.theta, std::cos(pose.theta), std::sin(pose.theta)};
  }

  static State stateOf(const Eigen::Matrix2d& rotation, const Eigen::Vector2d& translation) {
    return stateOf({translation.x(), translation.y(), std::atan2(rotation(1, 0), rotation(0, 0))});
  }

  static Eigen::Matrix2d rotationOf(const State& state) { return state.rotation(); }

  static geometry::Pose2 poseOf(const State& state) {
    return {state.translation.x(), state.translation.y(), geometry::normalizeAngle(state.theta)};
  }

  static State moved(const State& state, const Motion& motion) {
    const Eigen::Vector2d translation = state.translation + state.rotation() * motion.head<2>();
    return stateOf({translation.x(), translation.y(), state.theta + motion.z()});
  }

  /// T_a_c from T_b_a and T_b_c.
  static State between(const State& a, const State& c) { return stateOf(geometry::inverse(poseOf(a)) * poseOf(c)); }

  static Motion error(const State& from, const State& to, const State& measured) {
    const Eigen::Vector2d to_in_from = from.rotation().transpose() * (to.translation - from.translation);
    Motion result;
    result.head<2>() = measured.rotation().transpose() * (to_in_from - measured.translation);
    result.z() = geometry::normalizeAngle(to.theta - from.theta - measured.theta);
    return result;
  }

  static void linearize(const State& from, const State& to, const State& measured, LinearizedError<3>& linear) {
    const Eigen::Matrix2d R_measured_from = measured.rotation().transpose();
    const Eigen::Vector2d to_in_from = from.rotation().transpose() * (to.translation - from.translation);
    linear.error.head<2>() = R_measured_from * (to_in_from - measured.translation);
    linear.error.z() = geometry::normalizeAngle(to.theta - from.theta - measured.theta);
    linear.byFrom.setZero();
    linear.byFrom.topLeftCorner<2, 2>() = -R_measured_from;
    linear.byFrom.topRightCorner<2, 1>() = R_measured_from * Eigen::Vector2d(to_in_from.y(), -to_in_from.x());
    linear.byFrom(2, 2) = -1.0;
    linear.byTo.setZero();
    linear.byTo.topLeftCorner<2, 2>() = R_measured_from * from.rotation().transpose() * to.rotation();
    linear.byTo(2, 2) = 1.0;
  }
};

template <>
struct PoseSpace<geometry::Pose3> {
  static constexpr int kAxes = 3;
  using Motion = Eigen::Matrix<double, 6, 1>;

  struct State {
    Eigen::Vector3d translation = Eigen::Vector3d::Zero();
    Eigen::Quaterniond quaternion = Eigen::Quaterniond::Identity();
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  };

  static State stateOf(const geometry::Pose3& pose) {
    const Eigen::Quaterniond quaternion = Eigen::Quaterniond(pose.linear()).normalized();
    return {pose.translation(), quaternion, quaternion.toRotationMatrix()};
  }

  static State stateOf(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
    return {translation, Eigen::Quaterniond(rotation).normalized(), rotation};
  }

  static const Eigen::Matrix3d& rotationOf(const State& state) { return state.rotation; }

  static geometry::Pose3 poseOf(const State& state) {
    return geometry::fromQuaternion(state.translation, state.quaternion);
  }

  static State moved(const State& state, const Motion& motion) {
    // (1, w/2) normalised turns by w up to third order and by no more than half a turn: no step is too long for it.
    const Eigen::Vector3d half = 0.5 * motion.tail<3>();
    const Eigen::Quaterniond turn = Eigen::Quaterniond(1.0, half.x(), half.y(), half.z());
    State result;
    result.translation = state.translation + state.rotation * motion.head<3>();
    result.quaternion = (state.quaternion * turn).normalized();
    result.rotation = result.quaternion.toRotationMatrix();
    return result;
  }

  /// T_a_c from T_b_a and T_b_c.
  static State between(const State& a, const State& c) {
    State result;
    result.translation = a.rotation.transpose() * (c.translation - a.translation);
    result.quaternion = a.quaternion.conjugate() * c.quaternion;
    result.rotation = result.quaternion.toRotationMatrix();
    return result;
  }

  static Motion error(const State& from, const State& to, const State& measured) {
    const Eigen::Vector3d to_in_from = from.rotation.transpose() * (to.translation - from.translation);
    Motion result;
    result.head<3>() = measured.rotation.transpose() * (to_in_from - measured.translation);
    result.tail<3>() = 2.0 * turnBetween(from, to, measured).vec();
    return result;
  }

  static void linearize(const State& from, const State& to, const State& measured, LinearizedError<6>& linear) {
    const Eigen::Matrix3d R_measured_from = measured.rotation.transpose();
    const Eigen::Vector3d to_in_from = from.rotation.transpose() * (to.translation - from.translation);
    const Eigen::Quaterniond turn = turnBetween(from, to, measured);
    const Eigen::Matrix3d real = turn.w() * Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d imaginary = cross(turn.vec());
    linear.error.head<3>() = R_measured_from * (to_in_from - measured.translation);
    linear.error.tail<3>() = 2.0 * turn.vec();
    linear.byFrom.topLeftCorner<3, 3>() = -R_measured_from;
    linear.byFrom.topRightCorner<3, 3>() = R_measured_from * cross(to_in_from);
    linear.byFrom.bottomLeftCorner<3, 3>().setZero();
    linear.byFrom.bottomRightCorner<3, 3>() = (imaginary - real) * R_measured_from;
    linear.byTo.topLeftCorner<3, 3>() = R_measured_from * from.rotation.transpose() * to.rotation;
    linear.byTo.topRightCorner<3, 3>().setZero();
    linear.byTo.bottomLeftCorner<3, 3>().setZero();
    linear.byTo.bottomRightCorner<3, 3>() = real + imaginary;
  }

 private:
  /// The shorter way round.
  static Eigen::Quaterniond turnBetween(const State& from, const State& to, const State& measured) {
    const Eigen::Quaterniond turn = measured.quaternion.conjugate() * (from.quaternion.conjugate() * to.quaternion);
    return turn.w() < 0.0 ? Eigen::Quaterniond(-turn.coeffs()) : turn;
  }

  static Eigen::Matrix3d cross(const Eigen::Vector3d& v) {
    return (Eigen::Matrix3d() << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0).finished();
  }
};

}  // namespace prodomos::localization

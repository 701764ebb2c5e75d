// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pose.hpp"
#include "prodomos/simulation/building.hpp"

#include "simulation/people/gait.hpp"

#include <Eigen/Core>

#include <array>

namespace prodomos::simulation {

/// An arm from shoulder to wrist or a leg from hip to ankle.
struct Limb {
  Eigen::Vector3d root;
  Eigen::Vector3d middle;
  Eigen::Vector3d end;
  Eigen::Vector3d hinge;      ///< axis of elbow or knee, unit length, to the person's left; the limb bends about it
  Eigen::Vector3d rootHinge;  ///< the same axis at its root: flesh twists between
};

/// How a body stands, in the frame `floor`: the world's, with z = 0 on the person's floor. Frames of the body have x
/// ahead, y to the left, z up along the spine.
struct Posture {
  geometry::Pose2 pose;  ///< of the body on the floor
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
  geometry::Pose3 T_floor_pelvis = geometry::Pose3::Identity();  ///< between the hip joints
  geometry::Pose3 T_floor_chest = geometry::Pose3::Identity();   ///< at the neck's base
  geometry::Pose3 T_floor_head = geometry::Pose3::Identity();    ///< at the neck's base, turned as the head is
  std::array<Limb, 2> arms;                                      ///< by Side
  std::array<Limb, 2> legs;
  std::array<Foot, 2> feet;
};

/// Lengths of a body, as shares of its height (Drillis and Contini 1966).
struct Proportions {
  double hipHeight = 0.530;
  double halfHips = 0.055;  ///< from the middle to a hip joint
  double thigh = 0.245;
  double shank = 0.246;
  double shoulderHeight = 0.797;
  double halfShoulders = 0.103;
  double upperArm = 0.174;
  double forearm = 0.146;
  double neckHeight = 0.845;
  double ankleHeight = 0.039;
};
inline constexpr Proportions kProportions;
/// Of the hip joints of a person on a chair, metres: a seat of 0.45 m and what is between.
inline constexpr double kSeatedHipHeight = 0.53;

/// Of a person that checkPerson() accepts.
Posture postureOf(const Person& person, double time);

}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/truth.hpp"
#include "prodomos/simulation/building.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

/// People that walk, stand and sit (docs/people.md). All is a function of the person and the time: nothing is kept.
namespace prodomos::simulation {

/// The joints of pose estimators trained on AI Challenger's key points, in their order. Right and left are the
/// person's.
enum Joint : std::uint8_t {
  kHeadTop,
  kNeck,
  kRightShoulder,
  kRightElbow,
  kRightWrist,
  kLeftShoulder,
  kLeftElbow,
  kLeftWrist,
  kRightHip,
  kRightKnee,
  kRightAnkle,
  kLeftHip,
  kLeftKnee,
  kLeftAnkle,
};
inline constexpr std::array<std::string_view, evaluation::kJointCount> kJointNames = {
    "head_top",   "neck",      "right_shoulder", "right_elbow", "right_wrist", "left_shoulder", "left_elbow",
    "left_wrist", "right_hip", "right_knee",     "right_ankle", "left_hip",    "left_knee",     "left_ankle"};

/// World coordinates.
struct PersonState {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< on the floor
  double heading = 0.0;                                ///< of the torso, in (-pi, pi]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< derivative of the position, m/s
  std::array<Eigen::Vector3d, evaluation::kJointCount> joints{};
};

/// Throws base::Error that names the person where its way is empty, not ascending in time or not finite, or where it is
/// no human's height.
void checkPerson(const Person& person);

/// Both throw as checkPerson() does. `floorZ` is the height of the floor that the person is on.
PersonState stateOf(const Person& person, double floorZ, double time);
/// The body in world coordinates, class "person", one surface a material. At all times it has the same triangles and
/// materials: vertices and normals alone move.
std::vector<Surface> bodyAt(const Person& person, double floorZ, double time, std::uint16_t instance);

}  // namespace prodomos::simulation

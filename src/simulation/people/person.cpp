// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/person.hpp"

#include "prodomos/base/error.hpp"

#include "simulation/people/body.hpp"
#include "simulation/people/posture.hpp"

#include <cmath>
#include <string>

namespace prodomos::simulation {

namespace {

constexpr double kLeastHeight = 0.9;
constexpr double kMostHeight = 2.3;

/// Of the head's frame, metres of a person of 1 m.
const Eigen::Vector3d kTopOfHead(0.006, 0.0, 0.153);

}  // namespace

void checkPerson(const Person& person) {
  const auto refuse = [&](const std::string& place, const std::string& expected, const std::string& found) {
    throw base::Error(base::expectedFound("person \"" + person.id + "\", " + place, expected, found));
  };
  if (person.way.empty()) refuse("way", "at least one point", "none");
  for (std::size_t i = 0; i < person.way.size(); ++i) {
    const auto& [time, position] = person.way[i];
    const std::string place = "way point " + std::to_string(i + 1);
    if (!std::isfinite(time) || !position.allFinite()) refuse(place, "finite time and position", "others");
    if (i > 0 && time <= person.way[i - 1].time) {
      refuse(place, "a time after " + std::to_string(person.way[i - 1].time) + " s", std::to_string(time) + " s");
    }
  }
  if (!std::isfinite(person.heading)) refuse("heading", "a finite angle", std::to_string(person.heading));
  if (!(person.height >= kLeastHeight && person.height <= kMostHeight)) {
    refuse("height", "0.9 to 2.3 m", std::to_string(person.height) + " m");
  }
}

PersonState stateOf(const Person& person, double floorZ, double time) {
  checkPerson(person);
  const Posture posture = postureOf(person, time);
  PersonState state;
  state.position = {posture.pose.x, posture.pose.y, floorZ};
  state.heading = geometry::normalizeAngle(posture.pose.theta);
  state.velocity.head<2>() = posture.velocity;

  auto& joints = state.joints;
  joints[kHeadTop] = posture.T_floor_head * Eigen::Vector3d(person.height * kTopOfHead);
  joints[kNeck] = posture.T_floor_chest.translation();
  const auto set = [&](Joint first, const Limb& limb) {
    joints[first] = limb.root;
    joints[first + 1U] = limb.middle;
    joints[first + 2U] = limb.end;
  };
  set(kRightShoulder, posture.arms[kRight]);
  set(kLeftShoulder, posture.arms[kLeft]);
  set(kRightHip, posture.legs[kRight]);
  set(kLeftHip, posture.legs[kLeft]);
  for (auto& joint : joints) joint.z() += floorZ;
  return state;
}

std::vector<Surface> bodyAt(const Person& person, double floorZ, double time, std::uint16_t instance) {
  checkPerson(person);
  geometry::Pose3 T_world_floor = geometry::Pose3::Identity();
  T_world_floor.translation().z() = floorZ;
  std::vector<Surface> body = bodyOf(postureOf(person, time), lookOf(person.look), person.height);
  for (auto& surface : body) {
    surface = transformed(T_world_floor, std::move(surface));
    surface.classId = classId("person");
    surface.instance = instance;
  }
  return body;
}

}  // namespace prodomos::simulation

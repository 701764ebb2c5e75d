// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/truth.hpp"

#include <array>
#include <concepts>
#include <type_traits>

/// What the truth file says of each thing: the one description that reading and writing share.
namespace prodomos::evaluation {

/// Names of an enumeration's values, in their order.
template <typename Enum>
struct Names;
template <>
struct Names<map::HingeSide> {
  static constexpr std::array kValues = {map::HingeSide::kUnknown, map::HingeSide::kLeft, map::HingeSide::kRight};
};
template <>
struct Names<map::DoorState> {
  static constexpr std::array kValues = {map::DoorState::kUnknown, map::DoorState::kClosed, map::DoorState::kAjar,
                                         map::DoorState::kOpen};
};
template <>
struct Names<map::Mobility> {
  static constexpr std::array kValues = {map::Mobility::kStatic, map::Mobility::kQuasiStatic, map::Mobility::kDynamic};
};

template <typename T, typename U>
concept Is = std::same_as<std::remove_const_t<T>, U>;

void describe(auto& key, Is<TrueStorey> auto& storey) {
  key("floor_z", storey.floor_z);
  key("ceiling_height", storey.ceilingHeight);
}

void describe(auto& key, Is<TrueRoom> auto& room) {
  key("id", room.id);
  key("storey", room.storey);
  key("label", room.label);
  key("use", room.use);
  key("outline", room.outline);
  key("entered", room.entered);
}

void describe(auto& key, Is<TrueDoorState> auto& state) {
  key("time", state.time);
  key("angle", state.angle);
  key("state", state.state);
}

void describe(auto& key, Is<Sighting> auto& sighting) {
  key("share", sighting.share);
  key("visible", sighting.visible);
  key("since", sighting.since);
  key("passed", sighting.passed);
  key("images", sighting.images);
}

void describe(auto& key, Is<TrueDoor> auto& door) {
  key("id", door.id);
  key("instance", door.instance);
  key("storey", door.storey);
  key("rooms", door.rooms);
  key("pose", door.T_world_door);
  key("width", door.width);
  key("height", door.height);
  key("wall_thickness", door.wallThickness);
  key("leaf_offset", door.leafOffset);
  key("leaves", door.leaves);
  key("hinge_side", door.hingeSide);
  key("states", door.states);
  key("sighting", door.sighting);
}

void describe(auto& key, Is<TrueStaircase> auto& stairs) {
  key("id", stairs.id);
  key("instance", stairs.instance);
  key("storeys", stairs.storeys);
  key("rooms", stairs.rooms);
  key("foot", stairs.foot);
  key("head", stairs.head);
  key("direction", stairs.direction);
  key("width", stairs.width);
  key("step_depth", stairs.stepDepth);
  key("step_height", stairs.stepHeight);
  key("step_count", stairs.stepCount);
  key("sighting", stairs.sighting);
}

void describe(auto& key, Is<TrueObjectPose> auto& pose) {
  key("time", pose.time);
  key("pose", pose.T_world_object);
}

void describe(auto& key, Is<TrueObject> auto& object) {
  key("id", object.id);
  key("instance", object.instance);
  key("class", object.classId);
  key("storey", object.storey);
  key("mobility", object.mobility);
  key("size", object.size);
  key("poses", object.poses);
  key("seen", object.seen);
}

void describe(auto& key, Is<TruePersonState> auto& state) {
  key("time", state.time);
  key("position", state.position);
  key("heading", state.heading);
  key("velocity", state.velocity);
  key("joints", state.joints);
  key("pixels", state.pixels);
}

void describe(auto& key, Is<TruePerson> auto& person) {
  key("id", person.id);
  key("instance", person.instance);
  key("states", person.states);
}

void describe(auto& key, Is<TruePlane> auto& plane) {
  key("id", plane.id);
  key("class", plane.classId);
  key("storey", plane.storey);
  key("pose", plane.T_world_plane);
  key("outline", plane.outline_in_plane);
  key("seen", plane.seen);
}

void describe(auto& key, Is<TrueLift> auto& lift) {
  key("id", lift.id);
  key("rooms", lift.rooms);
  key("outline", lift.outline);
}

void describe(auto& key, Is<TimedPose> auto& pose) {
  key("time", pose.time);
  key("pose", pose.pose);
}

void describe(auto& key, Is<Truth> auto& truth) {
  key("building", truth.building);
  key("seed", truth.seed);
  key("labels", truth.labels);
  key("classes", truth.classes);
  key("storeys", truth.storeys);
  key("rooms", truth.rooms);
  key("doors", truth.doors);
  key("stairs", truth.stairs);
  key("objects", truth.objects);
  key("people", truth.people);
  key("planes", truth.planes);
  key("lifts", truth.lifts);
  key("trajectory", truth.trajectory);
}

}  // namespace prodomos::evaluation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include <numbers>
#include <string>
#include <utility>

namespace prodomos::test {

/// Walls between neighbouring rooms of these buildings, metres.
inline constexpr double kWall = 0.2;

inline simulation::Polygon rectangle(const Eigen::Vector2d& least, const Eigen::Vector2d& most) {
  return {least, {most.x(), least.y()}, most, {least.x(), most.y()}};
}

/// Its index.
inline int addRoom(simulation::Building& building, const std::string& label, const Eigen::Vector2d& least,
                   const Eigen::Vector2d& most, int storey = 0) {
  const auto index = static_cast<int>(building.rooms.size());
  building.rooms.push_back({.id = "r" + std::to_string(index + 1),
                            .storey = storey,
                            .label = label,
                            .use = simulation::useOfLabel(label),
                            .outline = rectangle(least, most)});
  return index;
}

/// In the middle of the wall at (x, y), its normal along `theta` from the first room into the second; closed, one leaf.
inline simulation::Door& addDoor(simulation::Building& building, int from, int to, double x, double y, double theta) {
  building.doors.push_back({.id = "d" + std::to_string(building.doors.size() + 1),
                            .storey = building.rooms[static_cast<std::size_t>(from)].storey,
                            .rooms = {from, to},
                            .pose = {x, y, theta},
                            .wallThickness = kWall});
  return building.doors.back();
}

inline void addThing(simulation::Building& building, const std::string& kind, const Eigen::Vector2d& middle,
                     const Eigen::Vector3d& size, double heading = 0.0, int storey = 0) {
  const double floor_z = building.storeys[static_cast<std::size_t>(storey)].floor_z;
  building.things.push_back(
      {.id = "t" + std::to_string(building.things.size() + 1),
       .kind = kind,
       .storey = storey,
       .T_world_thing = geometry::toPose3({middle.x(), middle.y(), heading}, floor_z + size.z() / 2.0),
       .size = size});
}

/// A corridor of 12 x 2 m and two rooms of 5.9 x 4 m on its left, with a door each.
inline simulation::Building corridorWithTwoRooms() {
  constexpr double kUp = std::numbers::pi / 2.0;
  simulation::Building building{.name = "two rooms", .storeys = {{}}};
  const int corridor = addRoom(building, "CORRIDOR", {0.0, 0.0}, {12.0, 2.0});
  const int first = addRoom(building, "OFFICE", {0.0, 2.0 + kWall}, {5.9, 6.2});
  const int second = addRoom(building, "OFFICE", {6.1, 2.0 + kWall}, {12.0, 6.2});
  addDoor(building, corridor, first, 3.0, 2.1, kUp);
  addDoor(building, corridor, second, 9.0, 2.1, kUp);
  return building;
}

/// A corridor of 30 m with a side corridor of 12 m, and rooms of 5 x 4 m along both sides, all doors closed.
inline void addOfficeFloor(simulation::Building& building, int storey) {
  constexpr double kUp = std::numbers::pi / 2.0;
  const int corridor = addRoom(building, "CORRIDOR", {0.0, 0.0}, {30.0, 2.0}, storey);
  const int side = addRoom(building, "CORRIDOR", {14.1, 2.0 + kWall}, {15.9, 14.2}, storey);
  addDoor(building, corridor, side, 15.0, 2.1, kUp).leaves = 0;
  building.doors.back().width = 1.6;
  for (int i = 0; i < 6; ++i) {
    const double x = 5.0 * i;
    const int below = addRoom(building, "OFFICE", {x, -4.2}, {x + 4.8, -kWall}, storey);
    addDoor(building, corridor, below, x + 1.5, -0.1, -kUp);
  }
  for (const double x : {0.0, 5.0, 16.1, 21.1}) {
    const int above = addRoom(building, "OFFICE", {x, 2.0 + kWall}, {x + 4.8, 6.2}, storey);
    addDoor(building, corridor, above, x + 3.0, 2.1, kUp).hingeSide = map::HingeSide::kRight;
  }
  const int end = addRoom(building, "OFFICE", {16.1, 10.0}, {21.0, 14.0}, storey);
  addDoor(building, side, end, 16.0, 12.0, 0.0);
}

inline simulation::Building office() {
  simulation::Building building{.name = "office", .storeys = {{}}};
  addOfficeFloor(building, 0);
  return building;
}

/// From the end of the corridor of an office floor upwards, in a stairwell of its own on both storeys.
inline void addStairs(simulation::Building& building) {
  const double rise = building.storeys[1].floor_z;
  constexpr int kSteps = 18;
  const int corridors[2] = {simulation::roomAt(building, 0, {1.0, 1.0}), simulation::roomAt(building, 1, {1.0, 1.0})};
  int wells[2];
  for (int storey = 0; storey < 2; ++storey) {
    wells[storey] = addRoom(building, "STAIRS", {-9.2, 0.0}, {-kWall, 3.0}, storey);
    addDoor(building, corridors[storey], wells[storey], -0.1, 1.0, std::numbers::pi).leaves = storey;
  }
  building.stairs.push_back({.id = "s1",
                             .rooms = {wells[0], wells[1]},
                             .foot = {-7.5, 2.2, 0.0},
                             .width = 1.2,
                             .stepHeight = rise / kSteps,
                             .stepCount = kSteps});
}

/// At the other end of the corridor, with a door on each storey.
inline void addLift(simulation::Building& building) {
  simulation::Lift lift{.id = "l1", .outline = rectangle({30.2, 0.0}, {32.0, 2.0})};
  for (int storey = 0; storey < static_cast<int>(building.storeys.size()); ++storey) {
    const int corridor = simulation::roomAt(building, storey, {1.0, 1.0});
    const int cabin = addRoom(building, "ELEVATOR", {30.2, 0.0}, {32.0, 2.0}, storey);
    addDoor(building, corridor, cabin, 30.1, 1.0, 0.0);
    lift.rooms.push_back(cabin);
  }
  building.lifts.push_back(std::move(lift));
}

inline simulation::Building twoStoreyOffice() {
  simulation::Building building{.name = "two storeys", .storeys = {{}, {.floor_z = 3.1}}};
  addOfficeFloor(building, 0);
  addOfficeFloor(building, 1);
  return building;
}

inline simulation::Building officeWithStairs() {
  auto building = twoStoreyOffice();
  addStairs(building);
  return building;
}

inline simulation::Building officeWithLift() {
  auto building = twoStoreyOffice();
  addLift(building);
  return building;
}

}  // namespace prodomos::test

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/claims.hpp"
#include "prodomos/evaluation/known_space.hpp"
#include "prodomos/evaluation/truth.hpp"

#include "support/sample_map.hpp"

#include <memory>
#include <numbers>

/// A building one can reckon with: a corridor of 10 x 2 m (0 … 10, 0 … 2); above it office A of 4 x 4 m behind a closed
/// door at (2, 2.1), office B of 5 x 4 m behind an open doorway at (7, 2.1), walls of 0.2 m between. From the
/// corridor's west end a flight of 3 m leads up to a hall of 6 x 2 m on the floor above, whose foot is at (-0.5, 1).
namespace prodomos::test {

inline base::Time at(double seconds) {
  return base::Time{} + base::fromSeconds(seconds);
}

inline evaluation::Polygon rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

inline constexpr double kQuarter = std::numbers::pi / 2.0;

inline evaluation::TrueDoor trueDoor(const std::string& id, const geometry::Pose2& pose, const std::string& from,
                                     const std::string& to, int leaves) {
  return {.id = id,
          .rooms = {from, to},
          .T_world_door = geometry::toPose3(pose),
          .width = 0.9,
          .height = 2.0,
          .wallThickness = 0.2,
          .leaves = leaves,
          .hingeSide = leaves == 1 ? map::HingeSide::kLeft : map::HingeSide::kUnknown,
          .states = {{at(0), 0.0, leaves == 0 ? map::DoorState::kOpen : map::DoorState::kClosed}},
          .sighting = {.share = 1.0, .visible = true, .since = at(1), .passed = true, .images = {at(1), at(2)}}};
}

inline evaluation::Truth smallBuilding() {
  evaluation::Truth truth;
  truth.building = "small";
  truth.storeys = {{0.0, 2.8}, {3.0, 2.8}};
  truth.rooms = {
      {.id = "corridor", .label = "CORRIDOR", .use = "corridor", .outline = rectangle(0, 0, 10, 2), .entered = at(0)},
      {.id = "A", .label = "OFFICE", .use = "room", .outline = rectangle(0, 2.2, 4, 6.2), .entered = {}},
      {.id = "B", .label = "OFFICE", .use = "room", .outline = rectangle(5, 2.2, 10, 6.2), .entered = {}},
      {.id = "hall",
       .storey = 1,
       .label = "HALL",
       .use = "corridor",
       .outline = rectangle(-8, 0, -2, 2),
       .entered = {}}};
  truth.doors = {trueDoor("dA", {2, 2.1, kQuarter}, "corridor", "A", 1),
                 trueDoor("dB", {7, 2.1, kQuarter}, "corridor", "B", 0)};
  truth.stairs = {{.id = "s",
                   .storeys = {0, 1},
                   .rooms = {"corridor", "hall"},
                   .foot = {-0.5, 1.0, 0.0},
                   .head = {-5.0, 1.0, 3.0},
                   .direction = std::numbers::pi,
                   .width = 1.2,
                   .stepDepth = 0.3,
                   .stepHeight = 0.2,
                   .stepCount = 15,
                   .sighting = {.share = 1.0, .visible = true, .since = at(1), .passed = true, .images = {}}}};
  return truth;
}

inline evaluation::ClaimedDoor claimedDoor(int id, const geometry::Pose2& pose, bool hasLeaf = true) {
  return {.id = {id},
          .T_world_door = pose,
          .door = {.width = 0.9,
                   .height = 2.0,
                   .hasLeaf = hasLeaf,
                   .hingeSide = hasLeaf ? map::HingeSide::kLeft : map::HingeSide::kUnknown,
                   .state = hasLeaf ? map::DoorState::kClosed : map::DoorState::kOpen},
          .firstSeen = at(1),
          .lastSeen = at(9)};
}

inline evaluation::ClaimedStaircase claimedStairs(int id) {
  return {.id = {id},
          .T_world_stairs = {-2.75, 1.0, std::numbers::pi},
          .stairs = {.height = 3.0, .stepWidth = 1.2, .stepHeight = 0.2, .stepDepth = 0.3, .stepCount = 15},
          .foot = Eigen::Vector2d(-0.5, 1.0)};
}

inline evaluation::ClaimedSpace claimedSpace(int id, int cause, double probability = 0.8) {
  return {.id = {id},
          .node = {100 + id},
          .cause = {cause},
          .mobility = map::Mobility::kQuasiStatic,
          .storey = 0,
          .probability = probability,
          .made = at(5),
          .areas_in_world = {}};
}

/// Both doors and the flight are found just where they are (o1, o2, o3), and a space behind each (p1, p2, p3).
inline evaluation::Claims perfectClaims() {
  evaluation::Claims claims;
  claims.doors = {claimedDoor(1, {2, 2.1, kQuarter}), claimedDoor(2, {7, 2.1, kQuarter}, false)};
  claims.stairs = {claimedStairs(3)};
  claims.spaces = {claimedSpace(1, 1), claimedSpace(2, 2), claimedSpace(3, 3)};
  claims.spaces[2].mobility = map::Mobility::kStatic;
  claims.spaces[2].storey = 1;
  return claims;
}

/// A rectangle of free cells of 5 cm, known since `begin`.
inline evaluation::KnownGrid freeRectangle(double x0, double y0, double x1, double y1, base::Time begin = at(0),
                                           int storey = 0) {
  map::OccupancyGridConfig config;
  config.resolution = evaluation::kCell;
  auto grid = std::make_shared<map::OccupancyGrid>(config);
  for (const auto cell : evaluation::cellsIn(rectangle(x0, y0, x1, y1))) {
    const map::OccupancyGrid::Beam beam{.end = evaluation::centreOf(cell), .hit = false};
    grid->insert(beam.end, {&beam, 1});
  }
  return {storey, begin, {}, grid};
}

/// The corridor has been seen, and nothing else.
inline evaluation::KnownSpace corridorKnown() {
  return evaluation::KnownSpace({freeRectangle(0, 0, 10, 2)});
}

}  // namespace prodomos::test

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/truth.hpp"
#include "prodomos/map/map_store.hpp"

#include <string>
#include <utility>
#include <vector>

/// A flat of two rooms that a robot drives through, and maps of it made by hand, in a frame of their own.
namespace prodomos::test {

namespace flat {

constexpr double kFloor = 1.5;  // metres: the world's zero is not where this storey's floor is

inline base::Time at(double seconds) {
  return base::Time{} + base::fromSeconds(100.0 + seconds);
}

/// Rooms of 4 x 4 m, 0.2 m of wall between them, a door in its middle; the way leads through it in 14 s.
inline evaluation::Truth truth() {
  evaluation::Truth truth;
  truth.building = "flat";
  truth.classes = {{0, "unlabeled"}, {1, "wall"}, {2, "floor"}, {3, "chair"}, {4, "table"}, {5, "person"}};
  truth.storeys = {{.floor_z = kFloor - 3.0, .ceilingHeight = 2.8}, {.floor_z = kFloor, .ceilingHeight = 2.8}};
  truth.rooms = {
      {.id = "a", .storey = 1, .label = "OFFICE", .use = "room", .outline = {{0, 0}, {4, 0}, {4, 4}, {0, 4}}},
      {.id = "b", .storey = 1, .label = "OFFICE", .use = "room", .outline = {{4.2, 0}, {8.2, 0}, {8.2, 4}, {4.2, 4}}}};
  truth.doors = {{.id = "d",
                  .storey = 1,
                  .rooms = {"a", "b"},
                  .T_world_door = geometry::toPose3({4.1, 2.0, 0.0}, kFloor),
                  .width = 0.9,
                  .height = 2.0,
                  .wallThickness = 0.2,
                  .leaves = 0}};
  for (int i = 0; i <= 140; ++i) {
    truth.trajectory.push_back({at(0.1 * i), geometry::toPose3({0.5 + 0.05 * i, 2.0, 0.0}, kFloor)});
  }
  return truth;
}

/// Level, but turned and far away.
inline geometry::Pose3 elsewhere() {
  return geometry::fromYawPitchRoll({17.0, -40.0, 5.0}, 2.1, 0.0, 0.0);
}

}  // namespace flat

/// s1 begins where the robot does, s2 at the door. What is added is told in the world.
class FlatMap {
 public:
  explicit FlatMap(const geometry::Pose3& T_map_world = flat::elsewhere(),
                   const evaluation::Truth& truth = flat::truth())
      : T_world_submap_{geometry::toPose3({0.5, 2.0, 0.0}, flat::kFloor),
                        geometry::toPose3({4.0, 2.0, 0.4}, flat::kFloor)} {
    change_.sessions = {{.id = {1},
                         .log = "flat.rawlog",
                         .logKind = "MRPT rawlog",
                         .classes = truth.classes,
                         .begin = flat::at(0),
                         .end = flat::at(14),
                         .state = map::SessionState::kComplete}};
    for (const int id : {1, 2}) {
      map::Node node;
      node.id = {id};
      node.session = {1};
      node.T_map_submap = node.T_travel_submap = T_map_world * T_world_submap_.at(static_cast<std::size_t>(id - 1));
      change_.nodes.push_back(node);
    }
    for (const auto& pose : truth.trajectory) {
      change_.trajectory.push_back({.session = {1},
                                    .time = pose.time,
                                    .submap = {pose.time < flat::at(7) ? 1 : 2},
                                    .T_travel_body = T_map_world * pose.pose});
    }
  }

  /// Everything of s2 lies there in the map, its part of the way too: drift between sub-maps.
  void driftBy(const geometry::Pose3& T_map_map) {
    auto& node = change_.nodes[1];
    node.T_map_submap = T_map_map * node.T_map_submap;
  }

  base::EntityId add(int submap, const geometry::Pose3& T_world_entity, map::EntityAttributes attributes,
                     double seen = 3.0) {
    map::Entity entity;
    entity.id = {static_cast<std::int64_t>(change_.entities.size()) + 1};
    entity.submap = {submap};
    entity.T_submap_entity = T_submap_world(submap) * T_world_entity;
    entity.firstSeen = entity.lastSeen = flat::at(seen);
    entity.confidence = 0.9;
    entity.attributes = std::move(attributes);
    change_.entities.push_back(entity);
    return entity.id;
  }

  void add(const map::Track& track) { change_.tracks.push_back(track); }
  void add(int submap, const map::MapLayer& layer) { change_.layers.emplace_back(base::SubMapId{submap}, &layer); }

  geometry::Pose3 T_submap_world(int submap) const {
    return T_world_submap_.at(static_cast<std::size_t>(submap - 1)).inverse();
  }

  map::MapView view() {
    store_.commit(change_);
    return store_.view();
  }

 private:
  std::vector<geometry::Pose3> T_world_submap_;
  map::MapChange change_;
  map::MapStore store_ = map::MapStore::inMemory();
};

}  // namespace prodomos::test

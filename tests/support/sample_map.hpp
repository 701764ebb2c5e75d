// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/map_store.hpp"
#include "prodomos/map/occupancy_grid.hpp"
#include "prodomos/map/point_layer.hpp"

#include <string_view>
#include <vector>

/// A small map made by hand, for tests that need one with everything in it.
namespace prodomos::test {

/// A grid drawn as text, the first line at the greatest y: '#' occupied, '.' free, ' ' unknown. Its lower left corner
/// lies on the cell `lowerLeft`.
inline map::OccupancyGrid gridFromText(const std::vector<std::string_view>& lines, double resolution,
                                       geometry::CellIndex lowerLeft = {}) {
  map::OccupancyGridConfig config;
  config.resolution = resolution;
  map::OccupancyGrid grid(config);
  for (std::size_t line = 0; line < lines.size(); ++line) {
    for (std::size_t column = 0; column < lines[line].size(); ++column) {
      const char drawn = lines[line][column];
      if (drawn == ' ') continue;
      const Eigen::Vector2d centre(
          geometry::cellCentre(lowerLeft.x + static_cast<int>(column), resolution),
          geometry::cellCentre(lowerLeft.y + static_cast<int>(lines.size() - 1 - line), resolution));
      const map::OccupancyGrid::Beam beam{.end = centre, .hit = drawn == '#'};
      grid.insert(centre, {&beam, 1});
    }
  }
  return grid;
}

/// Two floors of a small building, cells of 0.25 m. Ground floor: a corridor (s1, s2) that an open door (o1) joins to
/// an office (s3); behind a closed door (o2) a predicted room (s6). Stairs (o3) lead from the corridor to a landing
/// (s4) on the floor above, and on to s5; a loop closes from s2 to s1. A person (o4) stands in the office, a cupboard
/// (o5) too.
class SampleMap {
 public:
  SampleMap() : store_(map::MapStore::inMemory()) { store_.commit(makeChange()); }

  map::MapView view() const { return store_.view(); }

  static constexpr double kResolution = 0.25;

 private:
  static base::Time at(double seconds) { return base::Time{} + base::fromSeconds(1'000'000'000.0 + seconds); }

  map::MapChange makeChange() {
    map::MapChange change;
    change.sessions.push_back({.id = {1},
                               .log = "/home/somebody/logs/sample <&> \"map\".rawlog",
                               .logKind = "MRPT rawlog",
                               .config = "grid:\n  resolution: 0.25\n",
                               .poses = "odometry",
                               .version = "0.1.0",
                               .classes = {{0, "unlabeled"}, {1, "cupboard"}},
                               .begin = at(0),
                               .end = at(50),
                               .state = map::SessionState::kComplete,
                               .distance = 31.5});
    change.floors = {{.number = 0, .height = 0.0}, {.number = 1, .height = 3.0}};
    addNodes(change);
    addEdges(change);
    addEntities(change);
    addPrediction(change);
    addTrajectory(change);
    addTracks(change);
    addLayers(change);
    return change;
  }

  static map::Node node(int id, int floor, const geometry::Pose2& pose, double height = 0.0) {
    return {.id = {id},
            .session = {1},
            .floor = floor,
            .place = std::nullopt,
            .T_map_submap = geometry::toPose3(pose, height),
            .T_travel_submap = geometry::toPose3({pose.x + 0.1, pose.y, pose.theta}, height),
            .begin = at(10.0 * (id - 1)),
            .end = at(10.0 * id),
            .distance = 5.0 + id,
            .readings = 10 * id};
  }

  static void addNodes(map::MapChange& change) {
    constexpr double kQuarter = 1.5707963267948966;
    change.nodes = {node(1, 0, {0, 0, 0}), node(2, 0, {5, 0, 0}), node(3, 0, {5, 2.75, kQuarter}),
                    node(4, 1, {-4.5, 0, 0}, 3.0), node(5, 1, {0.5, 0, 0}, 3.0)};
    change.nodes[1].covariance = map::Matrix6::Identity() * 0.01;
    auto predicted = node(6, 0, {9.25, 0, 0});
    predicted.kind = map::SubMapKind::kPredicted;
    predicted.readings = 0;
    change.nodes.push_back(predicted);
  }

  static void addEdges(map::MapChange& change) {
    const auto add = [&change](int id, int from, int to, map::EdgeKind kind, std::optional<base::EntityId> cause) {
      const auto& nodes = change.nodes;
      const auto& T_map_from = nodes.at(static_cast<std::size_t>(from - 1)).T_map_submap;
      const auto& T_map_to = nodes.at(static_cast<std::size_t>(to - 1)).T_map_submap;
      map::Matrix6 information = map::Matrix6::Zero();
      information.diagonal() << 100, 200, 300, 400, 500, 600;
      information(0, 1) = information(1, 0) = 10;
      change.edges.push_back({.id = {id},
                              .from = {from},
                              .to = {to},
                              .kind = kind,
                              .T_from_to = T_map_from.inverse() * T_map_to,
                              .information = information,
                              .cause = cause});
    };
    add(1, 1, 2, map::EdgeKind::kTravelled, std::nullopt);
    add(2, 2, 3, map::EdgeKind::kDoor, base::EntityId{1});
    add(3, 1, 4, map::EdgeKind::kStairs, base::EntityId{3});
    add(4, 4, 5, map::EdgeKind::kTravelled, std::nullopt);
    add(5, 2, 1, map::EdgeKind::kLoop, std::nullopt);
    add(6, 2, 6, map::EdgeKind::kDoor, base::EntityId{2});
  }

  static map::Entity entity(int id, int submap, const geometry::Pose3& T_submap_entity,
                            map::EntityAttributes attributes) {
    return {.id = {id},
            .submap = {submap},
            .T_submap_entity = T_submap_entity,
            .confidence = 0.9,
            .observations = 7,
            .firstSeen = at(1),
            .lastSeen = at(9),
            .attributes = std::move(attributes),
            .points_in_submap = {}};
  }

  static void addEntities(map::MapChange& change) {
    constexpr double kQuarter = 1.5707963267948966;
    const map::Door open{.width = 0.9, .hingeSide = map::HingeSide::kLeft, .state = map::DoorState::kOpen};
    const map::Door closed{.width = 0.9, .hingeSide = map::HingeSide::kRight, .state = map::DoorState::kClosed};
    const map::Staircase stairs{.height = 3.0, .stepWidth = 1.2, .stepHeight = 0.2, .stepDepth = 0.15, .stepCount = 15};
    change.entities = {
        entity(1, 2, geometry::toPose3({0.5, 1.125, kQuarter}, 1.0), open),
        entity(2, 2, geometry::toPose3({2.875, 0, 0}, 1.0), closed),
        entity(3, 1, geometry::toPose3({-1.9, 0, 2 * kQuarter}, 1.5), stairs),
        entity(4, 3, geometry::toPose3({1.0, 1.0, 2.0}), map::Human{}),
        entity(5, 3, geometry::toPose3({1.0, -0.95, 0}, 0.5), map::Cuboid{.classId = 1, .size = {0.5, 1.0, 1.0}}),
    };
  }

  static void addPrediction(map::MapChange& change) {
    const map::PredictedArea wide{.threshold = 0.5, .outline_in_node = {{-1.2, -2}, {2.5, -2}, {2.5, 2}, {-1.2, 2}}};
    const map::PredictedArea narrow{.threshold = 0.7,
                                    .outline_in_node = {{-1.2, -1.2}, {1.6, -1.2}, {1.6, 1.2}, {-1.2, 1.2}}};
    change.predictions.push_back({.id = {1},
                                  .cause = {2},
                                  .submap = {2},
                                  .node = {6},
                                  .T_submap_node = geometry::toPose3({4.25, 0, 0}),
                                  .probability = 0.82,
                                  .expectedArea = 11.5,
                                  .areas = {wide, narrow},
                                  .room_in_node = {{-1.1, -2.2}, {2.6, -2.2}, {2.6, 2.2}, {-1.1, 2.2}},
                                  .made = at(12),
                                  .state = map::PredictionState::kOpen,
                                  .settled = std::nullopt,
                                  .mergedInto = std::nullopt});
  }

  static void addTrajectory(map::MapChange& change) {
    const std::vector<std::pair<int, std::vector<Eigen::Vector2d>>> ways_in_map = {
        {1, {{0, 0}, {2, 0.2}, {4, -0.2}, {5, 0}}},
        {2, {{5, 0}, {5.45, 0.5}, {5.5, 1.5}, {5, 2.75}}},
        {3, {{5, 2.75}, {5.2, 4}, {4.2, 4.2}, {4, 3}, {5.4, 1.6}, {5.2, 0.3}, {0, -0.3}, {-4, 0}}},
        {4, {{-4.5, 0}, {-2, 0.3}, {0.5, 0}}},
        {5, {{0.5, 0}, {2.5, 0.1}}}};
    for (const auto& [id, way] : ways_in_map) {
      const auto& node = change.nodes.at(static_cast<std::size_t>(id - 1));
      const double height = node.T_map_submap.translation().z();
      double second = 0.0;
      for (const auto& position : way) {
        const auto T_map_body = geometry::toPose3({position.x(), position.y(), 0.0}, height);
        change.trajectory.push_back({.session = {1},
                                     .time = node.begin + base::fromSeconds(second),
                                     .submap = node.id,
                                     .T_travel_body = node.T_travel_submap * node.T_map_submap.inverse() * T_map_body,
                                     .T_map_body = {}});
        second += 1.0;
      }
    }
  }

  /// The person of the office came in through its door.
  static void addTracks(map::MapChange& change) {
    map::Track track{.id = {1}, .session = {1}, .className = "human"};
    const auto& office = change.nodes.at(2);
    double second = 1.0;
    for (const auto& position : {Eigen::Vector2d(5.4, 1.9), {5.3, 2.6}, {5.0, 3.4}}) {
      const auto T_map_person =
          geometry::toPose3({position.x(), position.y(), 1.6}, office.T_map_submap.translation().z());
      track.states.push_back({.time = office.begin + base::fromSeconds(second),
                              .submap = office.id,
                              .T_submap_thing = office.T_map_submap.inverse() * T_map_person,
                              .velocity_in_submap = {}});
      second += 1.0;
    }
    change.tracks.push_back(track);
  }

  void addLayers(map::MapChange& change) {
    // clang-format off
    const std::vector<std::string_view> corridor = {
        "########################",
        "........................",
        "........................",
        "........................",
        "........................",
        "........................",
        "........................",
        "........................",
        "........................",
        "########################"};
    const std::vector<std::string_view> corridorWithDoors = {
        "############....########",
        ".......................#",
        ".......................#",
        ".......................#",
        ".......................#",
        ".......................#",
        ".......................#",
        ".......................#",
        ".......................#",
        "########################"};
    const std::vector<std::string_view> office = {
        "##############",
        "#............#",
        "#............#",
        "#............#",
        "#............#",
        "#............#",
        "#............#",
        ".............#",
        ".............#",
        ".............#",
        ".............#",
        "#............#",
        "#............#",
        "##############"};
    // clang-format on
    for (const int id : {1, 4, 5}) grids_.emplace_back(id, gridFromText(corridor, kResolution, {-12, -5}));
    grids_.emplace_back(2, gridFromText(corridorWithDoors, kResolution, {-12, -5}));
    grids_.emplace_back(3, gridFromText(office, kResolution, {-7, -7}));
    for (const auto& [id, grid] : grids_) change.layers.emplace_back(base::SubMapId{id}, &grid);

    points_.insert({1.0F, 2.0F, 0.5F}, {255, 0, 0});
    points_.insert({-1.0F, 0.5F, 1.5F}, {0, 255, 0});
    change.layers.emplace_back(base::SubMapId{3}, &points_);
  }

  map::MapStore store_;
  std::vector<std::pair<int, map::OccupancyGrid>> grids_;
  map::PointLayer points_;
};

}  // namespace prodomos::test

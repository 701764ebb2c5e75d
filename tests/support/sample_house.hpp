// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/map_store.hpp"
#include "prodomos/map/occupancy_grid.hpp"
#include "prodomos/map/point_layer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

/// Small buildings, seen by a laser that never errs, for tests of what reads maps.
namespace prodomos::test {

struct Wall {
  Eigen::Vector2d begin;
  Eigen::Vector2d end;
};

/// Where walls stand exactly on the edges of cells, rounding decides which cell they fill; this keeps them off.
inline const Eigen::Vector2d kOffEdges{0.023, 0.027};

inline double rangeTo(const std::vector<Wall>& walls, const Eigen::Vector2d& origin, double angle, double maxRange) {
  const Eigen::Vector2d ray(std::cos(angle), std::sin(angle));
  double range = maxRange;
  for (const auto& wall : walls) {
    const Eigen::Vector2d along = wall.end - wall.begin;
    const double cross = ray.x() * along.y() - ray.y() * along.x();
    if (std::abs(cross) < 1e-9) continue;
    const Eigen::Vector2d offset = wall.begin + kOffEdges - origin;
    const double t = (offset.x() * along.y() - offset.y() * along.x()) / cross;
    const double s = (offset.x() * ray.y() - offset.y() * ray.x()) / cross;
    if (t > 0.0 && s >= 0.0 && s <= 1.0) range = std::min(range, t);
  }
  return range;
}

/// Looks around from a spot of the map, and puts into the sub-map's layers what is seen.
inline void lookAround(map::SubMap& submap, const std::vector<Wall>& walls, const Eigen::Vector2d& spot_in_map,
                       int beamCount = 720, double maxRange = 8.0) {
  const geometry::Pose3 T_submap_map = submap.node.T_map_submap.inverse();
  const auto inSubMap = [&](const Eigen::Vector2d& point, double height) -> Eigen::Vector3d {
    return T_submap_map * Eigen::Vector3d(point.x(), point.y(), submap.node.T_map_submap.translation().z() + height);
  };
  std::vector<map::OccupancyGrid::Beam> beams;
  auto& grid = dynamic_cast<map::OccupancyGrid&>(*submap.layers[0]);
  auto& points = dynamic_cast<map::PointLayer&>(*submap.layers[1]);
  for (int i = 0; i < beamCount; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / beamCount;
    const double range = rangeTo(walls, spot_in_map, angle, maxRange);
    const Eigen::Vector2d end = spot_in_map + range * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    beams.push_back({inSubMap(end, 0.0).head<2>(), range < maxRange});
    if (range >= maxRange) continue;
    const auto shade = static_cast<std::uint8_t>(120 + 100 * std::abs(std::sin(angle)));
    points.insert(inSubMap(end, 0.5).cast<float>(), {shade, 130, static_cast<std::uint8_t>(255 - shade)});
  }
  const Eigen::Vector2d origin = inSubMap(spot_in_map, 0.0).head<2>();
  grid.insert(origin, beams);
  grid.insert(origin, beams);
}

inline std::vector<Wall> room(double x0, double y0, double x1, double y1) {
  return {{{x0, y0}, {x1, y0}}, {{x1, y0}, {x1, y1}}, {{x1, y1}, {x0, y1}}, {{x0, y1}, {x0, y0}}};
}

inline void append(std::vector<Wall>& walls, const std::vector<Wall>& more) {
  walls.insert(walls.end(), more.begin(), more.end());
}

/// What all sample maps have: one session, nodes numbered from 1 with half a minute each.
class HouseBuilder {
 public:
  explicit HouseBuilder(const std::string& log) {
    map::Session session;
    session.id = {1};
    session.log = log;
    session.logKind = "MRPT rawlog";
    session.poses = "odometry";
    session.version = "0.1.0";
    session.begin = base::fromNanoseconds(976'052'857'000'000'000);
    session.state = map::SessionState::kComplete;
    change.sessions.push_back(session);
  }

  map::SubMap& addSubMap(const geometry::Pose2& pose, std::optional<int> floor, std::optional<int> place,
                         map::SubMapKind kind = map::SubMapKind::kObserved) {
    map::Node node;
    node.id = {static_cast<std::int64_t>(submaps_.size()) + 1};
    node.session = {1};
    node.kind = kind;
    node.floor = floor;
    node.place = place;
    node.T_map_submap = geometry::toPose3(pose, 3.2 * floor.value_or(0));
    node.T_travel_submap = geometry::toPose3({pose.x + 0.02 * pose.y, pose.y - 0.01 * pose.x, pose.theta});
    node.begin = change.sessions[0].begin + base::fromSeconds(30.0 * static_cast<double>(submaps_.size()));
    node.end = node.begin + base::fromSeconds(29.4);
    if (kind == map::SubMapKind::kObserved) {
      node.distance = 6.0;
      node.readings = 147;
    }
    submaps_.push_back(std::make_unique<map::SubMap>(map::makeSubMap(node, {})));
    if (kind == map::SubMapKind::kPredicted) submaps_.back()->layers.clear();
    return *submaps_.back();
  }

  void addEdge(std::int64_t from, std::int64_t to, map::EdgeKind kind, std::optional<base::EntityId> cause = {}) {
    map::Edge edge;
    edge.id = {static_cast<std::int64_t>(change.edges.size()) + 1};
    edge.from = {from};
    edge.to = {to};
    edge.kind = kind;
    edge.cause = cause;
    edge.T_from_to = pose(from).inverse() * pose(to);
    edge.information = map::Matrix6::Identity() * 100.0;
    change.edges.push_back(edge);
  }

  void addEntity(std::int64_t submap, const geometry::Pose2& pose_in_map, map::EntityAttributes attributes) {
    map::Entity entity;
    entity.id = {static_cast<std::int64_t>(change.entities.size()) + 1};
    entity.submap = {submap};
    entity.T_submap_entity = pose(submap).inverse() * geometry::toPose3(pose_in_map, pose(submap).translation().z());
    entity.confidence = 0.93;
    entity.observations = 14;
    entity.firstSeen = change.sessions[0].begin;
    entity.lastSeen = entity.firstSeen + base::fromSeconds(12.0);
    entity.attributes = std::move(attributes);
    change.entities.push_back(entity);
  }

  /// A way through the spots, in steps of 0.1 m.
  void travel(std::int64_t submap, const std::vector<Eigen::Vector2d>& spots) {
    const auto& session = change.sessions[0];
    for (std::size_t i = 1; i < spots.size(); ++i) {
      const Eigen::Vector2d along = spots[i] - spots[i - 1];
      const int steps = std::max(1, static_cast<int>(along.norm() / 0.1));
      for (int step = 0; step < steps; ++step) {
        const Eigen::Vector2d at = spots[i - 1] + along * step / steps;
        map::TrajectoryPoint point;
        point.session = session.id;
        point.submap = {submap};
        point.time = session.begin + base::fromSeconds(0.2 * static_cast<double>(change.trajectory.size()));
        const double heading = std::atan2(along.y(), along.x());
        point.T_map_body = geometry::toPose3({at.x(), at.y(), heading}, pose(submap).translation().z());
        point.T_travel_body = geometry::toPose3({at.x() + 0.02 * at.y(), at.y() - 0.01 * at.x(), heading});
        change.trajectory.push_back(point);
      }
      change.sessions[0].distance += along.norm();
    }
  }

  map::MapStore finish() {
    for (const auto& submap : submaps_) {
      change.nodes.push_back(submap->node);
      for (const auto& layer : submap->layers) change.layers.emplace_back(submap->node.id, layer.get());
    }
    auto store = map::MapStore::inMemory();
    store.commit(change);
    return store;
  }

  const geometry::Pose3& pose(std::int64_t submap) const {
    return submaps_[static_cast<std::size_t>(submap - 1)]->node.T_map_submap;
  }

  map::MapChange change;

 private:
  std::vector<std::unique_ptr<map::SubMap>> submaps_;
};

/// A corridor with two rooms behind doors and stairs to a second corridor: five observed sub-maps on two floors, a
/// sixth predicted behind a closed door, two doors that are open, a staircase, a person, a box.
inline map::MapStore sampleHouse(const std::string& log = "/data/robot/two_floors.rawlog") {
  using Kind = map::EdgeKind;
  HouseBuilder house(log);
  std::vector<Wall> ground = {{{0, 0}, {26, 0}}, {{26, 0}, {26, 3}}, {{0, 0}, {0, 9}},
                              {{0, 9}, {16, 9}}, {{8, 3}, {8, 9}},   {{16, 3}, {16, 9}},
                              {{0, 3}, {4, 3}},  {{5, 3}, {11, 3}},  {{12, 3}, {26, 3}}};
  append(ground, room(1.0, 7.6, 2.6, 8.4));
  append(ground, room(12.5, 6.0, 14.5, 7.0));
  append(ground, room(5.8, 6.8, 6.6, 7.6));
  auto& first = house.addSubMap({1.5, 1.5, 0.0}, 0, 0);
  for (const double x : {1.5, 4.0, 6.5, 8.5}) lookAround(first, ground, {x, 1.5});
  auto& second = house.addSubMap({10.0, 1.4, 0.1}, 0, 0);
  for (const double x : {10.0, 13.0, 16.0, 19.0, 22.0}) lookAround(second, ground, {x, 1.5});
  auto& office = house.addSubMap({4.5, 4.6, 1.57}, 0, 1);
  for (const double y : {4.4, 5.6, 6.5}) lookAround(office, ground, {4.2, y});
  auto& lab = house.addSubMap({11.5, 4.6, 1.4}, 0, 2);
  for (const double y : {4.4, 5.2, 7.8}) lookAround(lab, ground, {11.0, y});
  std::vector<Wall> upper = room(8, 0, 26, 3);
  append(upper, {{{14, 2.2}, {14, 3}}, {{20, 2.2}, {20, 3}}});
  auto& above = house.addSubMap({19.0, 1.5, 3.14}, 1, 3);
  for (const double x : {24.0, 21.0, 18.0, 15.0, 11.0}) lookAround(above, upper, {x, 1.5});
  house.addSubMap({20.5, 5.5, 1.57}, 0, 4, map::SubMapKind::kPredicted);

  using std::numbers::pi;
  const map::Door open{
      .width = 1.0, .height = 2.05, .hingeSide = map::HingeSide::kLeft, .state = map::DoorState::kOpen};
  house.addEntity(1, {4.5, 3.0, pi / 2}, open);
  house.addEntity(2, {11.5, 3.0, pi / 2}, open);
  house.addEntity(2, {20.5, 3.0, pi / 2}, map::Door{.width = 0.92, .height = 2.05, .state = map::DoorState::kClosed});
  house.addEntity(
      2, {24.0, 1.5, 0.0},
      map::Staircase{.height = 3.2, .stepWidth = 1.4, .stepHeight = 0.18, .stepDepth = 0.28, .stepCount = 9});
  house.addEntity(1, {7.2, 0.9, 0.5}, map::Human{.dominantSide = 1, .velocity = {0.6, 0.3, 0.0}});
  house.addEntity(4, {13.5, 6.5, 0.0}, map::Cuboid{.classId = 3, .size = {2.0, 1.0, 0.75}});

  house.addEdge(1, 2, Kind::kTravelled);
  house.addEdge(1, 3, Kind::kDoor, base::EntityId{1});
  house.addEdge(2, 4, Kind::kDoor, base::EntityId{2});
  house.addEdge(2, 5, Kind::kStairs, base::EntityId{4});
  house.addEdge(2, 6, Kind::kDoor, base::EntityId{3});
  house.travel(1, {{1.5, 1.5}, {4.4, 1.6}});
  house.travel(3, {{4.4, 1.6}, {4.5, 4.6}, {3.6, 6.2}, {4.7, 4.5}, {4.6, 2.0}});
  house.travel(1, {{4.6, 2.0}, {10.0, 1.4}});
  house.travel(4, {{10.0, 1.4}, {11.5, 3.0}, {11.4, 5.6}, {10.2, 7.6}, {11.6, 3.2}});
  house.travel(2, {{11.6, 3.2}, {12.4, 1.6}, {23.0, 1.5}});
  house.travel(5, {{23.0, 1.5}, {19.0, 1.5}, {11.0, 1.4}});

  map::Prediction bet;
  bet.id = {1};
  bet.cause = {3};
  bet.submap = {2};
  bet.node = {6};
  bet.T_submap_node = geometry::toPose3({10.0, 1.4, 0.1}).inverse() * geometry::toPose3({20.5, 5.5, 1.57});
  bet.probability = 0.82;
  bet.expectedArea = 17.5;
  bet.made = house.change.sessions[0].begin;
  bet.areas = {{0.5, {{-2.4, 3.6}, {3.8, 3.4}, {5.0, 0.0}, {3.8, -3.4}, {-2.4, -3.6}}},
               {0.7, {{-2.4, 2.2}, {2.2, 2.0}, {3.0, 0.0}, {2.2, -2.0}, {-2.4, -2.2}}}};
  house.change.predictions.push_back(bet);
  house.change.floors = {{0, 0.0}, {1, 3.2}};
  return house.finish();
}

/// A robot's way up and down the aisles of a store house, `count` sub-maps long.
inline map::MapStore sampleStoreHouse(int count) {
  constexpr double kStep = 6.0;
  constexpr int kInAisle = 40;
  HouseBuilder house("/data/robot/store_house.rawlog");
  for (int i = 0; i < count; ++i) {
    const int aisle = i / kInAisle;
    const bool forth = aisle % 2 == 0;
    const int along = forth ? i % kInAisle : kInAisle - 1 - i % kInAisle;
    const Eigen::Vector2d at(along * kStep, aisle * kStep);
    auto& submap = house.addSubMap({at.x(), at.y(), forth ? 0.0 : std::numbers::pi}, std::nullopt, 0);
    std::vector<Wall> shelves;
    for (int row = -1; row <= 1; ++row) {
      for (int column = -2; column <= 2; ++column) {
        const double x = at.x() + column * kStep;
        const double y = at.y() + row * kStep + kStep / 2.0;
        append(shelves, room(x - 2.2 + 0.1 * ((i + column) % 7), y - 0.9, x + 2.2, y + 0.9 - 0.1 * ((i + row) % 5)));
      }
    }
    for (const double shift : {0.0, 2.0, 4.0}) lookAround(submap, shelves, {at.x() + shift, at.y()}, 540, 12.0);
    if (i > 0) {
      house.addEdge(i, i + 1, map::EdgeKind::kTravelled);
      house.travel(i + 1, {house.pose(i).translation().head<2>(), at});
    }
    if (aisle > 0 && i % 5 == 0) house.addEdge(i + 1 - 2 * (i % kInAisle) - 1, i + 1, map::EdgeKind::kLoop);
  }
  return house.finish();
}

}  // namespace prodomos::test

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/surroundings.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace prodomos::mapper {
namespace {

using map::CellState;

/// A sub-map whose robot stood at its origin and looked 2 m ahead.
map::SubMap submapAt(std::int64_t id, const geometry::Pose2& T_map_submap, int floor = 0) {
  map::Node node;
  node.id = base::SubMapId{id};
  node.session = base::SessionId{0};
  node.floor = floor;
  node.T_map_submap = node.T_travel_submap = geometry::toPose3(T_map_submap);
  node.begin = base::Time{} + std::chrono::seconds(10 * id);
  node.end = node.begin + std::chrono::seconds(10);
  auto submap = map::makeSubMap(node, {});
  for (auto& layer : submap.layers) {
    auto* grid = dynamic_cast<map::OccupancyGrid*>(layer.get());
    if (grid != nullptr) grid->insert({0.0, 0.0}, std::vector<map::OccupancyGrid::Beam>{{{2.0, 0.0}, true}});
  }
  return submap;
}

class Store {
 public:
  explicit Store(const std::vector<map::SubMap>& submaps) : store(map::MapStore::inMemory()) {
    map::MapChange change;
    change.sessions.emplace_back().id = base::SessionId{0};
    change.floors = {{0, 0.0}, {1, 3.0}};
    for (const auto& submap : submaps) {
      change.nodes.push_back(submap.node);
      for (const auto& layer : submap.layers) change.layers.emplace_back(submap.node.id, layer.get());
    }
    store.commit(change);
  }

  map::MapStore store;
};

std::vector<map::SubMap> submaps(std::initializer_list<geometry::Pose2> poses) {
  std::vector<map::SubMap> all;
  for (const auto& pose : poses) all.push_back(submapAt(static_cast<std::int64_t>(all.size()), pose));
  return all;
}

TEST(Surroundings, AddWhatANeighbourHasSeen) {
  const auto finished = submaps({{0.0, 0.0, 0.0}, {4.0, 0.0, 3.14159265}});
  const Store file(finished);
  GraphRefiner graph({}, file.store);
  const auto running = submapAt(2, {0.0, 1.0, 0.0});
  graph.add(running.node, std::nullopt);
  Surroundings surroundings(file.store, graph);
  const auto around = surroundings.of(base::SubMapId{0}, running);
  ASSERT_TRUE(around);
  EXPECT_EQ(around->submap, base::SubMapId{0});
  const auto stateAt = [&](double x, double y) { return around->grid.state(around->grid.cellAt({x, y})); };
  EXPECT_EQ(stateAt(1.0, 0.0), CellState::kFree) << "its own";
  EXPECT_EQ(stateAt(3.0, -0.02), CellState::kFree) << "the neighbour's, seen from behind the obstacle";
  EXPECT_EQ(stateAt(1.0, 1.0), CellState::kFree) << "that of the running one, which is in no file yet";
  EXPECT_EQ(around->begin, finished[0].node.begin);
  EXPECT_EQ(around->end, running.node.end);
}

TEST(Surroundings, AreThoseOfTheRunningSubMapToo) {
  const Store file(submaps({{0.0, 0.0, 0.0}}));
  GraphRefiner graph({}, file.store);
  const auto running = submapAt(1, {0.0, 1.0, 0.0});
  graph.add(running.node, std::nullopt);
  Surroundings surroundings(file.store, graph);
  const auto around = surroundings.of(base::SubMapId{1}, running);
  ASSERT_TRUE(around);
  EXPECT_EQ(around->grid.state(around->grid.cellAt({1.0, 0.0})), CellState::kFree);
  EXPECT_EQ(around->grid.state(around->grid.cellAt({1.0, -1.0})), CellState::kFree) << "of the one before";
}

TEST(Surroundings, EndSomeMetresBeyondWhatTheSubMapKnowsAndOnItsFloor) {
  auto finished = submaps({{0.0, 0.0, 0.0}, {7.0, 0.0, 0.0}, {30.0, 0.0, 0.0}});
  finished.push_back(submapAt(3, {0.0, 1.0, 0.0}, 1));
  const Store file(finished);
  GraphRefiner graph({}, file.store);
  const auto running = submapAt(4, {50.0, 0.0, 0.0});
  graph.add(running.node, std::nullopt);
  Surroundings surroundings(file.store, graph);
  const auto around = surroundings.of(base::SubMapId{0}, running);
  ASSERT_TRUE(around);
  EXPECT_EQ(around->grid.knownBox(), finished[0].findLayer<map::OccupancyGrid>()->knownBox());
  EXPECT_EQ(around->end, finished[1].node.end) << "it was asked, and had nothing to add";
}

TEST(Surroundings, OfASubMapWithoutAGridThereAreNone) {
  const Store file({});
  GraphRefiner graph({}, file.store);
  map::SubMap running;
  running.node.session = base::SessionId{0};
  graph.add(running.node, std::nullopt);
  Surroundings surroundings(file.store, graph);
  EXPECT_FALSE(surroundings.of(running.node.id, running));
}

}  // namespace
}  // namespace prodomos::mapper

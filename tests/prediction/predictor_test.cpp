// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/prediction/predictor.hpp"

#include "prodomos/base/error.hpp"

#include "support/sample_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>

namespace prodomos::prediction {
namespace {

using map::PredictionState;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kResolution = 0.1;

/// A room that was seen, with walls about it and, in the wall below, a gap of so many cells in its middle.
std::vector<std::string> roomWithGap(std::size_t columns, std::size_t rows, std::size_t gap) {
  std::vector<std::string> lines(rows, '#' + std::string(columns - 2, '.') + '#');
  lines.front() = lines.back() = std::string(columns, '#');
  lines.back().replace((columns - gap) / 2, gap, gap, '.');
  return lines;
}

/// A corridor along x, 2 m wide and 20 m long, that was seen.
class World {
 public:
  World() {
    store_.commit({.sessions = {{.id = {1}, .log = "log", .config = ""}}, .floors = {{0, 0.0}}});
    addSubMap({0.0, 0.0, 0.0}, roomWithGap(200, 22, 0), {-100, -11});
  }

  base::SubMapId addSubMap(const geometry::Pose2& pose, const std::vector<std::string>& lines,
                           geometry::CellIndex lowerLeft) {
    map::Node node;
    node.id = {nextNode_++};
    node.session = {1};
    node.floor = 0;
    node.T_map_submap = node.T_travel_submap = geometry::toPose3(pose);
    nodes_.push_back(node);
    grids_.push_back({node.id, node.T_map_submap,
                      std::make_shared<map::OccupancyGrid>(
                          test::gridFromText({lines.begin(), lines.end()}, kResolution, lowerLeft))});
    store_.commit({.nodes = {node}});
    return node.id;
  }

  /// In the corridor's upper wall, to the room above; its sub-map is the first.
  base::EntityId addDoor(double x, bool hasLeaf = true) {
    map::Entity door;
    door.id = {static_cast<std::int64_t>(entities_.size()) + 1};
    door.submap = nodes_.front().id;
    door.T_submap_entity = geometry::toPose3({x, 1.0, std::numbers::pi / 2.0});
    door.confidence = 0.95;
    door.observations = 9;
    door.attributes = map::Door{.width = 0.9, .hasLeaf = hasLeaf};
    entities_.push_back(door);
    store_.commit({.entities = {door}});
    return door.id;
  }

  /// In the lower wall of a corridor, to the room below it.
  base::EntityId addDoorBack(base::SubMapId submap, double x) {
    auto door = entities_.front();
    door.id = {static_cast<std::int64_t>(entities_.size()) + 1};
    door.submap = submap;
    door.T_submap_entity = geometry::toPose3({x, -1.0, -std::numbers::pi / 2.0});
    entities_.push_back(door);
    store_.commit({.entities = {door}});
    return door.id;
  }

  base::EntityId addStairs(double height) {
    map::Entity stairs;
    stairs.id = {static_cast<std::int64_t>(entities_.size()) + 1};
    stairs.submap = nodes_.front().id;
    stairs.T_submap_entity = geometry::toPose3({6.0, 0.0, 0.0}, height / 2.0);
    stairs.confidence = 0.95;
    stairs.attributes =
        map::Staircase{.height = height, .stepWidth = 1.4, .stepHeight = 0.17, .stepDepth = 0.28, .stepCount = 18};
    entities_.push_back(stairs);
    store_.commit({.entities = {stairs}});
    return stairs.id;
  }

  /// Which knows nothing of the entities of the one before.
  void beginAnotherSession() {
    session_ = {session_.value + 1};
    store_.commit({.sessions = {{.id = session_, .log = "another log", .config = ""}}});
    entities_.clear();
  }

  void remove(base::EntityId id) {
    std::erase_if(entities_, [id](const map::Entity& entity) { return entity.id == id; });
  }
  void move(const geometry::Pose2& T_after_before) {
    for (auto& node : nodes_) node.T_map_submap = geometry::toPose3(T_after_before) * node.T_map_submap;
    for (std::size_t i = 0; i < grids_.size(); ++i) grids_[i].T_map_submap = nodes_[i].T_map_submap;
    store_.commit({.nodes = nodes_});
  }

  /// As the mapper does at the end of a sub-map.
  map::MapChange update(Predictor& predictor, double now) {
    predictor.update(known(now), std::nullopt);
    return commit(predictor);
  }
  /// As it does on the way; the map is told later.
  void look(Predictor& predictor, double now) { predictor.glance(known(now), nodes_.back().id); }
  map::MapChange glance(Predictor& predictor, double now) {
    predictor.glance(known(now), nodes_.back().id);
    return commit(predictor);
  }
  map::MapView view() const { return store_.view(); }
  const std::vector<PlacedGrid>& grids() const { return grids_; }

 private:
  prediction::World known(double now) {
    return {.now = base::fromNanoseconds(std::int64_t(now * 1e9)),
            .session = session_,
            .entities = entities_,
            .nodes = nodes_,
            .gridsNear = [this](const Eigen::Vector3d&) { return grids_; },
            .newNodeId = [this] { return base::SubMapId{nextNode_++}; },
            .newEdgeId = [this] { return base::EdgeId{nextEdge_++}; }};
  }
  map::MapChange commit(Predictor& predictor) {
    map::MapChange change;
    predictor.addTo(change);
    map::MapChange copy;
    copy.nodes = change.nodes;
    copy.edges = change.edges;
    copy.predictions = change.predictions;
    copy.removedNodes = change.removedNodes;
    copy.events = change.events;
    store_.commit(change);
    return copy;
  }

  map::MapStore store_ = map::MapStore::inMemory();
  std::vector<map::Node> nodes_;
  std::vector<PlacedGrid> grids_;
  std::vector<map::Entity> entities_;
  base::SessionId session_{1};
  std::int64_t nextNode_ = 1;
  std::int64_t nextEdge_ = 1;
};

TEST(Predictor, BetsOnTheRoomBehindAClosedDoor) {
  World world;
  const auto door = world.addDoor(0.0);
  Predictor predictor({}, world.view());
  world.update(predictor, 5.0);
  const auto view = world.view();
  ASSERT_THAT(view.predictions(), SizeIs(1));
  const auto& bet = view.predictions()[0];
  EXPECT_EQ(bet.cause, door);
  EXPECT_EQ(bet.state, PredictionState::kOpen);
  EXPECT_GT(bet.probability, 0.5);
  EXPECT_GT(bet.expectedArea, 2.0);
  EXPECT_FALSE(bet.areas.empty());
  const auto& node = view.graph().getNode(bet.node);
  EXPECT_EQ(node.kind, map::SubMapKind::kPredicted);
  EXPECT_GT(node.T_map_submap.translation().y(), 1.0);  // on the far side
  EXPECT_EQ(node.floor, 0);
  ASSERT_THAT(view.graph().edgesOf(bet.node), SizeIs(1));
  const auto& edge = view.graph().getEdge(view.graph().edgesOf(bet.node)[0]);
  EXPECT_EQ(edge.kind, map::EdgeKind::kDoor);
  EXPECT_EQ(edge.cause, door);
  EXPECT_THAT(view.graph().places(), SizeIs(2));
}

TEST(Predictor, SaysEachThingOnce) {
  World world;
  world.addDoor(0.0);
  Predictor predictor({}, world.view());
  EXPECT_THAT(world.update(predictor, 5.0).events, SizeIs(1));
  EXPECT_THAT(world.update(predictor, 6.0).events, IsEmpty());
  EXPECT_THAT(world.view().predictions(), SizeIs(1));
}

TEST(Predictor, ClaimsNothingThatIsKnown) {
  World world;
  world.addDoor(0.0);
  world.addDoor(4.0, false);
  Predictor predictor({}, world.view());
  world.update(predictor, 5.0);
  const auto view = world.view();
  ASSERT_THAT(view.predictions(), SizeIs(2));
  for (const auto& bet : view.predictions()) {
    const Surroundings around(view.T_map_node(bet), world.grids());
    auto outlines = std::vector<geometry::Polygon>{bet.room_in_node};
    for (const auto& area : bet.areas) outlines.push_back(area.outline_in_node);
    for (const auto& outline : outlines) {
      for (const auto cell : geometry::cellsIn(outline, 0.1)) {
        EXPECT_EQ(around.state(geometry::centreOf(cell, 0.1)), map::CellState::kUnknown) << cell.x << ' ' << cell.y;
      }
    }
  }
}

TEST(Predictor, TwoDoorsDoNotShareTheirFloor) {
  World world;
  world.addDoor(0.0);
  world.addDoor(3.0);
  Predictor predictor({}, world.view());
  world.update(predictor, 5.0);
  world.update(predictor, 6.0);
  const auto view = world.view();
  ASSERT_THAT(view.predictions(), SizeIs(2));
  geometry::CellMap<std::uint8_t> taken({{-200, -200}, {200, 200}}, 0);
  taken.fill(geometry::transformed(view.T_map_node(view.predictions()[0]), view.predictions()[0].room_in_node), 1, 0.1);
  const auto other = geometry::transformed(view.T_map_node(view.predictions()[1]), view.predictions()[1].room_in_node);
  const auto cells = geometry::cellsIn(other, 0.1);
  const auto shared = std::ranges::count_if(cells, [&](auto cell) { return taken.at(cell) != 0; });
  EXPECT_LT(static_cast<double>(shared), 0.02 * static_cast<double>(cells.size()));
}

TEST(Predictor, TwoDoorsIntoOneRoomLeadToOneNode) {
  World world;
  const auto first = world.addDoor(0.0);
  Predictor predictor({}, world.view());
  world.update(predictor, 5.0);
  // A second corridor runs behind the room, and a door of it leads back into the room.
  const auto depth = [&] {
    const auto view = world.view();
    const auto& bet = view.predictions().at(0);
    double farthest = 0.0;
    for (const auto& corner : bet.room_in_node) farthest = std::max(farthest, corner.x());
    return bet.T_submap_node.translation().y() + farthest;
  }();
  const auto behind = world.addSubMap({0.0, depth + 1.2, 0.0}, roomWithGap(200, 22, 0), {-100, -11});
  const auto second = world.addDoorBack(behind, 0.3);
  world.update(predictor, 6.0);
  world.update(predictor, 7.0);
  const auto view = world.view();
  ASSERT_THAT(view.predictions(), SizeIs(1));
  const auto node = view.predictions()[0].node;
  const auto ways = view.graph().edgesOf(node);
  ASSERT_THAT(ways, SizeIs(2));
  EXPECT_EQ(view.graph().getEdge(ways[0]).cause, first);
  EXPECT_EQ(view.graph().getEdge(ways[1]).cause, second);
  const auto& way = view.graph().getEdge(ways[1]);
  EXPECT_EQ(way.from, behind);
  EXPECT_TRUE((view.graph().getNode(behind).T_map_submap * way.T_from_to)
                  .isApprox(view.graph().getNode(node).T_map_submap, 1e-9));
  // The door turns out to be none.
  world.remove(second);
  world.update(predictor, 8.0);
  EXPECT_EQ(world.view().predictions()[0].state, PredictionState::kOpen);
  EXPECT_THAT(world.view().graph().edgesOf(node), SizeIs(1));
}

TEST(Predictor, ALaterSessionKeepsTheWaysOfEarlierOnes) {
  World world;
  world.addDoor(0.0);
  Predictor predictor({}, world.view());
  world.update(predictor, 5.0);
  const auto bet = world.view().predictions().at(0);
  double farthest = 0.0;
  for (const auto& corner : bet.room_in_node) farthest = std::max(farthest, corner.x());
  const double depth = bet.T_submap_node.translation().y() + farthest;
  const auto behind = world.addSubMap({0.0, depth + 1.2, 0.0}, roomWithGap(200, 22, 0), {-100, -11});
  world.addDoorBack(behind, 0.3);
  world.update(predictor, 6.0);
  ASSERT_THAT(world.view().graph().edgesOf(bet.node), SizeIs(2));
  world.beginAnotherSession();
  Predictor later({}, world.view());
  world.update(later, 7.0);
  EXPECT_THAT(world.view().graph().edgesOf(bet.node), SizeIs(2));
}

TEST(Predictor, SaysNothingOfDoorsThatWereGivenUpBeforeAnybodyHeardOfThem) {
  World world;
  const auto first = world.addDoor(0.0);
  Predictor predictor({}, world.view());
  world.look(predictor, 5.0);
  world.remove(first);
  const auto second = world.addDoor(6.0);
  const auto change = world.update(predictor, 6.0);
  ASSERT_THAT(change.predictions, SizeIs(1));
  EXPECT_EQ(change.predictions[0].cause, second);
  EXPECT_THAT(change.events, SizeIs(1));
  EXPECT_THAT(change.removedNodes, IsEmpty());
}

TEST(Predictor, TakesThePlannersWord) {
  World world;
  world.addDoor(0.0);
  Predictor predictor({}, world.view());
  world.update(predictor, 5.0);
  const auto id = world.view().predictions().at(0).id;
  const auto at = [](double seconds) { return base::fromNanoseconds(std::int64_t(seconds * 1e9)); };
  predictor.tell(id, map::Finding::kBlocked, {1}, at(6.0));
  world.update(predictor, 7.0);
  EXPECT_EQ(world.view().predictions().at(0).state, PredictionState::kOpen);
  EXPECT_EQ(world.view().predictions().at(0).blocked, at(6.0));
  predictor.tell(id, map::Finding::kRefuted, {1}, at(8.0));
  world.update(predictor, 9.0);
  EXPECT_EQ(world.view().predictions().at(0).state, PredictionState::kRefuted);
  EXPECT_EQ(world.view().predictions().at(0).settled, at(8.0));
  EXPECT_THAT(world.view().graph().nodes(), SizeIs(1));
  EXPECT_THROW(predictor.tell(id, map::Finding::kBlocked, {1}, at(9.0)), base::Error) << "it is settled";
  EXPECT_THROW(predictor.tell({77}, map::Finding::kBlocked, {1}, at(9.0)), base::Error);
}

TEST(Predictor, SaysWhereToStand) {
  World world;
  world.addDoor(0.0);
  Predictor predictor({}, world.view());
  world.update(predictor, 5.0);
  const auto view = world.view();
  const auto viewpoint = view.predictions().at(0).viewpoint_in_submap;
  ASSERT_TRUE(viewpoint);
  EXPECT_NEAR(viewpoint->x, 0.0, 0.15);
  EXPECT_NEAR(viewpoint->y, 0.2, 0.15) << "0.8 m before the wall";
  EXPECT_NEAR(viewpoint->theta, std::numbers::pi / 2.0, 0.2);
}

TEST(Predictor, BetsWhileTheRobotIsStillInTheSubMap) {
  World world;
  world.addDoor(0.0);
  Predictor predictor({}, world.view());
  world.glance(predictor, 5.0);
  EXPECT_THAT(world.view().predictions(), SizeIs(1));
}

TEST(Predictor, WinsWhereTheRoomIsSeen) {
  World world;
  world.addDoor(0.0);
  Predictor predictor({}, world.view());
  world.update(predictor, 5.0);
  // The door opens, and the robot looks in.
  world.addSubMap({0.0, 0.0, 0.0}, roomWithGap(41, 32, 9), {-20, 10});
  const auto change = world.update(predictor, 9.0);
  const auto view = world.view();
  ASSERT_THAT(view.predictions(), SizeIs(1));
  EXPECT_EQ(view.predictions()[0].state, PredictionState::kConfirmed);
  EXPECT_EQ(view.predictions()[0].settled, base::fromNanoseconds(9'000'000'000));
  EXPECT_FALSE(view.graph().hasNode(view.predictions()[0].node));
  EXPECT_THAT(change.removedNodes, ElementsAre(view.predictions()[0].node));
  world.update(predictor, 12.0);
  EXPECT_THAT(world.view().predictions(), SizeIs(1));
}

TEST(Predictor, HandsOverToTheSubMapThatBeginsThere) {
  World world;
  world.addDoor(0.0);
  Predictor predictor({}, world.view());
  world.update(predictor, 5.0);
  const auto room = world.addSubMap({0.0, 2.5, 0.0}, roomWithGap(21, 22, 9), {-10, -15});
  world.update(predictor, 9.0);
  const auto view = world.view();
  ASSERT_THAT(view.predictions(), SizeIs(1));
  EXPECT_EQ(view.predictions()[0].state, PredictionState::kMerged);
  EXPECT_EQ(view.predictions()[0].mergedInto, room);
}

TEST(Predictor, LosesWhereThereIsNoRoom) {
  World world;
  world.addDoor(0.0);
  Predictor predictor({}, world.view());
  world.update(predictor, 5.0);
  world.addSubMap({0.0, 0.0, 0.0}, roomWithGap(13, 9, 9), {-6, 10});  // a cupboard
  world.update(predictor, 9.0);
  ASSERT_THAT(world.view().predictions(), SizeIs(1));
  EXPECT_EQ(world.view().predictions()[0].state, PredictionState::kRefuted);
}

TEST(Predictor, LosesWhereTheDoorIsNone) {
  World world;
  const auto door = world.addDoor(0.0);
  Predictor predictor({}, world.view());
  world.update(predictor, 5.0);
  world.remove(door);
  world.update(predictor, 9.0);
  const auto view = world.view();
  ASSERT_THAT(view.predictions(), SizeIs(1));
  EXPECT_EQ(view.predictions()[0].state, PredictionState::kRefuted);
  EXPECT_THAT(view.graph().nodes(), SizeIs(1));
}

TEST(Predictor, DoesNotBetOnWhatIsSeenAlready) {
  World world;
  world.addSubMap({0.0, 0.0, 0.0}, roomWithGap(41, 32, 9), {-20, 10});
  world.addDoor(0.0, false);
  Predictor predictor({}, world.view());
  world.update(predictor, 5.0);
  EXPECT_THAT(world.view().predictions(), IsEmpty());
}

TEST(Predictor, RoomsMoveWithTheirDoors) {
  World world;
  world.addDoor(0.0);
  Predictor predictor({}, world.view());
  world.update(predictor, 5.0);
  const auto before = world.view();
  const auto node = before.predictions()[0].node;
  const geometry::Pose2 T_after_before{1.0, -0.5, 0.2};
  world.move(T_after_before);
  world.update(predictor, 6.0);
  const auto after = world.view();
  EXPECT_TRUE(after.graph().getNode(node).T_map_submap.isApprox(
      geometry::toPose3(T_after_before) * before.graph().getNode(node).T_map_submap, 1e-6));
}

TEST(Predictor, FloorsAboveAndBelowAreBetOn) {
  for (const double height : {3.0, -3.0}) {
    World world;
    const auto stairs = world.addStairs(height);
    Predictor predictor({}, world.view());
    world.update(predictor, 5.0);
    const auto view = world.view();
    ASSERT_THAT(view.predictions(), SizeIs(1)) << height;
    EXPECT_EQ(view.predictions()[0].cause, stairs);
    EXPECT_NEAR(view.graph().getNode(view.predictions()[0].node).T_map_submap.translation().z(), height, 0.1);
    EXPECT_EQ(view.graph().getEdge(view.graph().edgesOf(view.predictions()[0].node)[0]).kind, map::EdgeKind::kStairs);
  }
}

TEST(Predictor, GoesOnFromTheMapAsIfNothingHadHappened) {
  World world;
  world.addDoor(0.0);
  Predictor first({}, world.view());
  world.update(first, 5.0);
  Predictor second({}, world.view());
  world.addSubMap({0.0, 2.5, 0.0}, roomWithGap(21, 22, 9), {-10, -15});
  EXPECT_THAT(world.update(second, 9.0).removedNodes, SizeIs(1));
  EXPECT_EQ(world.view().predictions()[0].state, PredictionState::kMerged);
}

TEST(Predictor, RefusesWhatMakesNoSense) {
  World world;
  world.addStairs(0.0);
  Predictor predictor({}, world.view());
  world.update(predictor, 5.0);
  EXPECT_THAT(world.view().predictions(), IsEmpty());
}

TEST(Predictor, SwitchedOffBetsOnNothing) {
  World world;
  world.addDoor(0.0);
  PredictionConfig config;
  config.enabled = false;
  Predictor predictor(config, world.view());
  world.update(predictor, 5.0);
  EXPECT_THAT(world.view().predictions(), IsEmpty());
}

}  // namespace
}  // namespace prodomos::prediction

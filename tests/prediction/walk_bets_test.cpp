// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/prediction/walk_bets.hpp"

#include "prodomos/prediction/predictor.hpp"

#include "support/sample_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

namespace prodomos::prediction {
namespace {

using Eigen::Vector2d;
using map::PredictionState;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;

constexpr double kResolution = 0.1;
constexpr base::EntityId kAda{7};
constexpr base::EntityId kBob{8};

base::Time at(double seconds) {
  return base::fromNanoseconds(0) + base::fromSeconds(seconds);
}

/// 12 m × 4 m about the origin, of which a box was not seen: "nothing", or what is drawn into it.
std::vector<std::string> hallWith(char inside, int firstColumn = 50, int lastColumn = 69) {
  std::vector<std::string> lines(40, std::string(120, '.'));
  for (int row = 10; row < 30; ++row) {
    for (int column = firstColumn; column <= lastColumn; ++column) {
      lines[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] = inside;
    }
  }
  return lines;
}

/// A hall in which something hides the floor from x = -1 m to x = 1 m.
class Hall {
 public:
  explicit Hall(const geometry::Pose2& T_map_first = {}) {
    store_.commit({.sessions = {{.id = {1}, .log = "log", .config = "", .state = map::SessionState::kRunning}},
                   .floors = {{0, 0.0}}});
    addSubMap(T_map_first, hallWith(' '));
    for (const auto id : {kAda, kBob}) {
      map::Entity person;
      person.id = id;
      person.submap = nodes_.front().id;
      person.confidence = 0.9;
      person.attributes = map::Human{};
      entities_.push_back(person);
    }
    store_.commit({.entities = entities_});
  }

  base::SubMapId addSubMap(const geometry::Pose2& pose, const std::vector<std::string>& lines) {
    map::Node node;
    node.id = {nextNode_++};
    node.session = {1};
    node.floor = 0;
    node.T_map_submap = node.T_travel_submap = geometry::toPose3(pose);
    nodes_.push_back(node);
    grids_.push_back({node.id, node.T_map_submap,
                      std::make_shared<map::OccupancyGrid>(
                          test::gridFromText({lines.begin(), lines.end()}, kResolution, {-60, -20}))});
    store_.commit({.nodes = {node}});
    return node.id;
  }

  /// Along the line y = 0 at 1 m/s, ten states a second.
  void walk(base::EntityId who, double fromTime, double fromX, double toX, base::SubMapId submap = {1}) {
    auto& track = tracks_.emplace_back(map::Track{.id = {who.value}, .session = {1}, .className = "human"});
    track.entity = who;
    const int count = static_cast<int>(std::lround(10.0 * std::abs(toX - fromX)));
    for (int i = 0; i <= count; ++i) {
      const double x = fromX + (toX - fromX) * i / count;
      track.states.push_back({.time = at(fromTime + 0.1 * i),
                              .submap = submap,
                              .T_submap_thing = geometry::toPose3({x, 0.0, 0.0}),
                              .velocity_in_submap = Eigen::Vector3d(1.0, 0.0, 0.0)});
    }
  }
  map::Entity& person(base::EntityId id) { return *std::ranges::find(entities_, id, &map::Entity::id); }
  void add(const map::Entity& entity) {
    entities_.push_back(entity);
    store_.commit({.entities = {entity}});
  }

  /// As the mapper does at the end of a sub-map.
  void update(Predictor& predictor, double now, std::optional<base::SubMapId> seen = {}) {
    predictor.update({.now = at(now),
                      .session = {1},
                      .entities = entities_,
                      .nodes = nodes_,
                      .gridsNear = [this](const Eigen::Vector3d&) { return grids_; },
                      .newNodeId = [this] { return base::SubMapId{nextNode_++}; },
                      .newEdgeId = [this] { return base::EdgeId{nextEdge_++}; },
                      .tracks = tracks_},
                     seen);
    map::MapChange change;
    change.tracks = std::exchange(tracks_, {});
    predictor.addTo(change);
    change.sessions = {{.id = {1}, .log = "log", .config = "", .end = at(now), .state = map::SessionState::kRunning}};
    store_.commit(change);
  }
  map::MapView view() const { return store_.view(); }
  const std::vector<PlacedGrid>& grids() const { return grids_; }

 private:
  map::MapStore store_ = map::MapStore::inMemory();
  std::vector<map::Node> nodes_;
  std::vector<PlacedGrid> grids_;
  std::vector<map::Entity> entities_;
  std::vector<map::Track> tracks_;
  std::int64_t nextNode_ = 1;
  std::int64_t nextEdge_ = 1;
};

bool tells(const map::Prediction& bet, const Vector2d& point_in_submap, double threshold = 0.5) {
  return std::ranges::any_of(bet.areas, [&](const map::PredictedArea& area) {
    return area.threshold == threshold && geometry::contains(area.outline_in_node, point_in_submap);
  });
}

std::vector<PredictionState> statesOf(const map::MapView& view) {
  std::vector<PredictionState> states;
  for (const auto& bet : view.predictions()) states.push_back(bet.state);
  return states;
}

TEST(WalkBets, AreMadeOnFloorThatIsHiddenWhereSomebodyWalks) {
  Hall hall({3.0, -2.0, 0.7});
  Predictor predictor({}, hall.view());
  hall.walk(kAda, 0.0, -3.0, 3.0);
  hall.update(predictor, 9.0);
  const auto view = hall.view();
  ASSERT_THAT(view.predictions(), SizeIs(1));
  const auto& bet = view.predictions()[0];
  EXPECT_EQ(bet.cause, kAda);
  EXPECT_EQ(bet.submap, base::SubMapId{1});
  EXPECT_EQ(bet.node, bet.submap) << "nobody goes elsewhere";
  EXPECT_TRUE(bet.T_submap_node.isApprox(geometry::Pose3::Identity()));
  EXPECT_EQ(bet.made, at(9.0));
  EXPECT_THAT(bet.areas, SizeIs(3));
  EXPECT_TRUE(tells(bet, {0.0, 0.02}) && tells(bet, {0.9, 0.02}, 0.7));
  EXPECT_FALSE(tells(bet, {1.2, 0.02}) || tells(bet, {0.0, 0.8})) << "known, or too far aside";
  EXPECT_NEAR(bet.expectedArea, 2.0 * 0.8, 0.2);
  EXPECT_GT(bet.probability, 0.8);
  EXPECT_LT(bet.probability, 0.9) << "less sure than that there is somebody";
  EXPECT_THAT(view.graph().nodes(), SizeIs(1));
  ASSERT_THAT(view.events(), SizeIs(1));
  EXPECT_EQ(view.events()[0].kind, "prediction_made");
}

TEST(WalkBets, AreMadeOfTheFloorAheadOfWhoLeaves) {
  Hall hall;
  Predictor predictor({}, hall.view());
  hall.walk(kAda, 0.0, 3.0, 5.5);
  hall.update(predictor, 9.0);
  const auto view = hall.view();
  ASSERT_THAT(view.predictions(), SizeIs(1));
  EXPECT_TRUE(tells(view.predictions()[0], {6.5, 0.02}));
}

TEST(WalkBets, OfAWayThatGoesOnInTheNextSubMapAreNotToldBackwards) {
  Hall hall;
  Predictor predictor({}, hall.view());
  hall.walk(kAda, 0.0, 4.5, 5.5);
  hall.update(predictor, 1.2, base::SubMapId{1});
  EXPECT_THAT(hall.view().predictions(), IsEmpty()) << "still in sight";
  const auto next = hall.addSubMap({20.0, 0.0, 0.0}, {"."});
  hall.walk(kAda, 1.3, 0.0, 2.0, next);
  hall.update(predictor, 9.0, next);
  const auto view = hall.view();
  ASSERT_THAT(view.predictions(), SizeIs(1));
  EXPECT_TRUE(tells(view.predictions()[0], {3.0, 0.02})) << "ahead of where it was lost";
  EXPECT_FALSE(tells(view.predictions()[0], {-1.0, 0.02}));
}

TEST(WalkBets, OfWhoWasInSightToTheEndOfASubMapWaitForWhatComes) {
  Hall hall;
  Predictor predictor({}, hall.view());
  hall.walk(kAda, 0.0, 4.5, 5.5);
  hall.update(predictor, 1.2, base::SubMapId{1});
  EXPECT_THAT(hall.view().predictions(), IsEmpty());
  const auto next = hall.addSubMap({20.0, 0.0, 0.0}, {"."});
  hall.update(predictor, 9.0, next);
  const auto view = hall.view();
  ASSERT_THAT(view.predictions(), SizeIs(1));
  EXPECT_EQ(view.predictions()[0].submap, base::SubMapId{1});
  EXPECT_TRUE(tells(view.predictions()[0], {6.5, 0.02}));
  hall.update(predictor, 20.0);
  EXPECT_THAT(hall.view().predictions(), SizeIs(1));
}

TEST(WalkBets, OfWhoIsInSightWhenTheLogEndsTellNothingAhead) {
  Hall hall;
  Predictor predictor({}, hall.view());
  hall.walk(kAda, 0.0, -3.0, 5.5);
  hall.update(predictor, 8.6);
  const auto view = hall.view();
  ASSERT_THAT(view.predictions(), SizeIs(1));
  EXPECT_TRUE(tells(view.predictions()[0], {0.0, 0.02}));
}

TEST(WalkBets, AreConfirmedWhereTheFloorIsSeen) {
  Hall hall;
  Predictor predictor({}, hall.view());
  hall.walk(kAda, 0.0, -3.0, 3.0);
  hall.update(predictor, 9.0);
  const auto elsewhere = hall.addSubMap({50.0, 0.0, 0.0}, {"."});
  hall.update(predictor, 10.0, elsewhere);
  EXPECT_THAT(statesOf(hall.view()), ElementsAre(PredictionState::kOpen));
  const auto again = hall.addSubMap({0.0, 0.0, 0.0}, hallWith('.'));
  hall.update(predictor, 11.0, again);
  const auto view = hall.view();
  EXPECT_THAT(statesOf(view), ElementsAre(PredictionState::kConfirmed));
  EXPECT_EQ(view.predictions()[0].settled, at(11.0));
  EXPECT_TRUE(tells(view.predictions()[0], {0.0, 0.02})) << "what was told stays in the ledger";
  EXPECT_EQ(view.events().back().kind, "prediction_settled");
}

TEST(WalkBets, AreRefutedWhereSomethingStands) {
  Hall hall;
  Predictor predictor({}, hall.view());
  hall.walk(kAda, 0.0, -3.0, 3.0);
  hall.update(predictor, 9.0);
  const auto again = hall.addSubMap({0.0, 0.0, 0.0}, hallWith('#'));
  hall.update(predictor, 11.0, again);
  EXPECT_THAT(statesOf(hall.view()), ElementsAre(PredictionState::kRefuted));
}

TEST(WalkBets, LeaveOutWhatIsKnownByNow) {
  Hall hall;
  Predictor predictor({}, hall.view());
  hall.walk(kAda, 0.0, -3.0, 3.0);
  hall.update(predictor, 9.0);
  const auto again = hall.addSubMap({0.0, 0.0, 0.0}, hallWith(' ', 58));
  hall.update(predictor, 11.0, again);
  const auto view = hall.view();
  ASSERT_THAT(statesOf(view), ElementsAre(PredictionState::kOpen));
  const auto& bet = view.predictions()[0];
  EXPECT_TRUE(tells(bet, {0.5, 0.02}) && tells(bet, {-0.15, 0.02}, 0.7));
  EXPECT_FALSE(tells(bet, {-0.5, 0.02}));
  EXPECT_NEAR(bet.expectedArea, 1.2 * 0.8, 0.15);
  for (const auto& area : bet.areas) {
    for (const auto cell : geometry::cellsIn(area.outline_in_node, kResolution)) {
      for (const auto& placed : hall.grids()) EXPECT_EQ(placed.grid->state(cell), map::CellState::kUnknown);
    }
  }
}

TEST(WalkBets, EndAtAWallThatIsSeenLater) {
  Hall hall;
  Predictor predictor({}, hall.view());
  hall.walk(kAda, 0.0, 3.5, 6.0);
  hall.update(predictor, 9.0);
  ASSERT_TRUE(tells(hall.view().predictions()[0], {7.0, 0.02}));
  auto lines = hallWith(' ');
  for (auto& line : lines) line += ".#";  // at x = 6.1 m
  const auto again = hall.addSubMap({0.0, 0.0, 0.0}, lines);
  hall.update(predictor, 11.0, again);
  EXPECT_THAT(statesOf(hall.view()), ElementsAre(PredictionState::kRefuted)) << "nearly all lies behind it";
}

TEST(WalkBets, AreMadeOnceOnTheSameFloor) {
  Hall hall;
  Predictor predictor({}, hall.view());
  hall.walk(kAda, 0.0, -3.0, 3.0);
  hall.walk(kBob, 1.0, -3.0, 3.0);
  hall.update(predictor, 9.0);
  hall.walk(kAda, 20.0, -3.0, 3.0);
  hall.update(predictor, 30.0);
  EXPECT_THAT(hall.view().predictions(), SizeIs(1));
}

TEST(WalkBets, OfDoubtfulPeopleAreNotMade) {
  Hall hall;
  Predictor predictor({.leastProbability = 0.5}, hall.view());
  hall.person(kAda).confidence = 0.4;
  hall.walk(kAda, 0.0, -3.0, 3.0);
  hall.update(predictor, 9.0);
  EXPECT_THAT(hall.view().predictions(), IsEmpty());
}

TEST(WalkBets, GoOnWithWhatTheMapHolds) {
  Hall hall;
  {
    Predictor predictor({}, hall.view());
    hall.walk(kAda, 0.0, -3.0, 3.0);
    hall.walk(kBob, 5.0, -3.0, -2.0);
    hall.update(predictor, 10.0);
    hall.walk(kAda, 20.0, 3.0, 4.0);
    hall.update(predictor, 21.2, base::SubMapId{1});
  }
  Predictor predictor({}, hall.view());
  hall.walk(kAda, 21.1, 4.1, 5.5);
  const auto again = hall.addSubMap({0.0, 0.0, 0.0}, hallWith('.'));
  hall.update(predictor, 30.0, again);
  const auto view = hall.view();
  ASSERT_THAT(statesOf(view), ElementsAre(PredictionState::kConfirmed, PredictionState::kOpen));
  EXPECT_EQ(view.predictions()[1].id, base::PredictionId{1});
  EXPECT_FALSE(tells(view.predictions()[1], {2.0, 0.02})) << "that was floor in sight";
  EXPECT_TRUE(tells(view.predictions()[1], {6.5, 0.02}));
}

// --- what is refused

TEST(Refusals, NameWhatIsWrongWithAPersonOnce) {
  Hall hall;
  Predictor predictor({}, hall.view());
  std::get<map::Human>(hall.person(kBob).attributes).velocity.x() = std::numeric_limits<double>::quiet_NaN();
  hall.walk(kAda, 0.0, 1000.0, 1003.0);
  hall.walk(kBob, 0.0, -3.0, 3.0);
  hall.update(predictor, 9.0);
  hall.update(predictor, 10.0);
  EXPECT_THAT(hall.view().predictions(), IsEmpty());
  EXPECT_THAT(predictor.refused(),
              ElementsAre(Pair("a human whose velocity is no number", 1), Pair("an entity outside of its sub-map", 1)));
  EXPECT_EQ(Predictor({}, hall.view()).refused(), predictor.refused());
}

TEST(Refusals, CountDoorsAndStairsOnceForEachReason) {
  Hall hall;
  map::Entity door;
  door.submap = {1};
  door.confidence = 0.95;
  for (const int id : {20, 21}) {
    door.id = {id};
    door.attributes = map::Door{.width = id == 20 ? 0.0 : std::numeric_limits<double>::quiet_NaN()};
    hall.add(door);
  }
  door.id = {22};
  door.attributes = map::Staircase{.height = 0.0, .stepWidth = 1.2};
  hall.add(door);
  door.id = {23};
  door.attributes = map::Door{.width = 0.9};
  door.T_submap_entity.translation().x() = 1e4;
  hall.add(door);
  Predictor predictor({}, hall.view());
  hall.update(predictor, 5.0);
  hall.update(predictor, 6.0);
  EXPECT_THAT(predictor.refused(), ElementsAre(Pair("a door without width", 2), Pair("a staircase without height", 1),
                                               Pair("an entity outside of its sub-map", 1)));
  const auto view = hall.view();
  EXPECT_THAT(view.predictions(), IsEmpty());
  ASSERT_THAT(view.events(), SizeIs(4));
  EXPECT_EQ(view.events()[0].kind, "prediction_refused");
  EXPECT_EQ(view.events()[0].subject, "o20");
  EXPECT_EQ(view.events()[0].payload, R"({"reason":"a door without width"})");
}

}  // namespace
}  // namespace prodomos::prediction

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/query/query.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/mapper/mapper.hpp"

#include "support/laser_world.hpp"
#include "support/sample_map.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace prodomos::query {
namespace {

using base::EdgeId;
using base::SubMapId;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Ground floor: corridor s1, s2, office s3 behind a door; floor 1: s4, s5 up the stairs.
class SampleMapQuery : public ::testing::Test {
 protected:
  test::SampleMap map_;
  map::MapView view_ = map_.view();
};

TEST_F(SampleMapQuery, FindsThePlaceOfASpot) {
  const auto corridor = placeAt(view_, {0.3, 0.2, 0});
  EXPECT_EQ(corridor.submap, SubMapId{1});
  EXPECT_EQ(corridor.floor, 0);
  EXPECT_EQ(corridor.state, map::CellState::kFree);
  EXPECT_LT(corridor.probability, 0.5);
  EXPECT_EQ(corridor.place, view_.graph().getNode({1}).place);

  const auto office = placeAt(view_, {4.9, 3.4, 0});
  EXPECT_EQ(office.submap, SubMapId{3});
  EXPECT_NE(office.place, corridor.place) << "a door lies between";
}

TEST_F(SampleMapQuery, AsksTheSubMapThatBeganNearest) {
  EXPECT_EQ(placeAt(view_, {2.3, 0.0, 0}).submap, SubMapId{1});
  EXPECT_EQ(placeAt(view_, {2.7, 0.0, 0}).submap, SubMapId{2});
}

TEST_F(SampleMapQuery, AsksOnTheFloorThatIsNamed) {
  EXPECT_EQ(placeAt(view_, {0.4, 0.1, 0}).submap, SubMapId{1});
  EXPECT_EQ(placeAt(view_, {0.4, 0.1, 1}).submap, SubMapId{5});
  EXPECT_EQ(placeAt(view_, {0.4, 0.1, 1}).floor, 1);
  EXPECT_EQ(placeAt(view_, {0.4, 0.1, 7}).submap, std::nullopt);
  EXPECT_EQ(placeAt(view_, {0.4, 0.1, {}}).submap, SubMapId{5}) << "without a floor, the nearest of any";
}

TEST_F(SampleMapQuery, TellsWallsFromFreeFloor) {
  const auto wall = placeAt(view_, {0.3, -1.1, 0});
  EXPECT_EQ(wall.state, map::CellState::kOccupied);
  EXPECT_GT(wall.probability, 0.5);
}

TEST_F(SampleMapQuery, KnowsNothingOfSpotsThatNobodySaw) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const auto& spot : {Position{50, 50, {}}, Position{9.25, 0.0, 0}, Position{kNan, 0, {}},
                           Position{0, kInfinity, {}}, Position{-1e300, 1e300, {}}}) {
    const auto answer = placeAt(view_, spot);
    EXPECT_EQ(answer.submap, std::nullopt) << spot.x << "," << spot.y;
    EXPECT_EQ(answer.place, std::nullopt);
    EXPECT_EQ(answer.state, map::CellState::kUnknown);
    EXPECT_EQ(answer.probability, 0.5);
  }
}

TEST_F(SampleMapQuery, FindsTheShortestRoute) {
  const auto route = routeBetween(view_, {0.0, 0.0, 0}, {5.0, 3.4, 0});
  ASSERT_TRUE(route);
  EXPECT_THAT(route->submaps, ElementsAre(SubMapId{1}, SubMapId{2}, SubMapId{3}));
  EXPECT_THAT(route->edges, SizeIs(2));
  EXPECT_NEAR(route->length, 5.0 + 2.75 + 0.65, 1e-9) << "from origin to origin, and on to the spot";
  EXPECT_EQ(route->probability, 1.0);
}

TEST_F(SampleMapQuery, RoutesOverStairs) {
  const auto route = routeBetween(view_, {5.0, 0.0, 0}, {1.0, 0.0, 1});
  ASSERT_TRUE(route);
  EXPECT_THAT(route->submaps, ElementsAre(SubMapId{2}, SubMapId{1}, SubMapId{4}, SubMapId{5}));
}

TEST_F(SampleMapQuery, NeedsNoEdgeWithinASubMap) {
  const auto route = routeBetween(view_, {0.1, 0.0, 0}, {-0.4, 0.3, 0});
  ASSERT_TRUE(route);
  EXPECT_THAT(route->submaps, ElementsAre(SubMapId{1}));
  EXPECT_THAT(route->edges, IsEmpty());
  EXPECT_NEAR(route->length, std::hypot(0.5, 0.3), 1e-9);
}

TEST_F(SampleMapQuery, LeadsThroughPredictedRoomsAtTheirRisk) {
  const auto route = routeBetween(view_, {0.0, 0.0, 0}, {10.5, 1.0, 0});
  ASSERT_TRUE(route);
  EXPECT_EQ(route->submaps.back(), SubMapId{6});
  EXPECT_EQ(route->probability, 0.82);
}

TEST_F(SampleMapQuery, HasNoRouteToUnknownSpots) {
  EXPECT_EQ(routeBetween(view_, {0, 0, 0}, {50, 0, 0}), std::nullopt);
  EXPECT_EQ(routeBetween(view_, {50, 0, 0}, {0, 0, 0}), std::nullopt);
}

TEST_F(SampleMapQuery, TellsWhereToStandToEnterAPredictedRoom) {
  const auto rooms = predictedRooms(view_);
  ASSERT_THAT(rooms, SizeIs(1));
  const auto& room = rooms[0];
  EXPECT_EQ(room.node, SubMapId{6});
  EXPECT_EQ(room.cause.value, 2);
  EXPECT_EQ(room.floor, 0);
  EXPECT_EQ(room.probability, 0.82);
  EXPECT_EQ(room.expectedArea, 11.5);
  EXPECT_EQ(room.doorState, map::DoorState::kClosed);
  EXPECT_EQ(room.route, std::nullopt) << "nobody said from where";
  EXPECT_EQ(room.gainPerMetre, std::nullopt);
  EXPECT_FALSE(room.isViewpointFree) << "the map does not tell one";
  // The door is at x = 7.875, and its normal looks along x.
  EXPECT_NEAR(room.viewpoint_in_map.x, 7.075, 1e-9);
  EXPECT_NEAR(room.viewpoint_in_map.y, 0.0, 1e-9);
  EXPECT_NEAR(room.viewpoint_in_map.theta, 0.0, 1e-9);
  EXPECT_EQ(placeAt(view_, {room.viewpoint_in_map.x, room.viewpoint_in_map.y, 0}).state, map::CellState::kFree);
}

TEST_F(SampleMapQuery, TellsTheWayToAPredictedRoom) {
  const auto rooms = predictedRooms(view_, 0.0, Position{4.9, 3.4, 0});
  ASSERT_THAT(rooms, SizeIs(1));
  ASSERT_TRUE(rooms[0].route);
  EXPECT_THAT(rooms[0].route->submaps, ElementsAre(SubMapId{3}, SubMapId{2}));
  EXPECT_NEAR(*rooms[0].gainPerMetre, 0.82 * 11.5 / rooms[0].route->length, 1e-9);
  EXPECT_EQ(predictedRooms(view_, 0.0, Position{50, 50, 0}).at(0).route, std::nullopt);
}

TEST_F(SampleMapQuery, LeavesOutImprobableRooms) {
  EXPECT_THAT(predictedRooms(view_, 0.82), SizeIs(1));
  EXPECT_THAT(predictedRooms(view_, 0.83), IsEmpty());
}

/// Without edges, layers and predictions.
map::MapChange sampleMapToBeChanged() {
  const test::SampleMap sample;
  const auto whole = sample.view();
  map::MapChange change;
  change.sessions = whole.sessions();
  change.floors = whole.floors();
  for (const auto id : whole.graph().nodes()) change.nodes.push_back(whole.graph().getNode(id));
  change.entities = whole.entities();
  return change;
}

TEST(PredictedRooms, AreThoseStillOpenTheMostProbableFirst) {
  const auto sample = test::SampleMap().view().predictions().at(0);
  auto change = sampleMapToBeChanged();
  const auto predict = [&](int id, double probability, map::PredictionState state) {
    auto prediction = sample;
    prediction.id = {id};
    prediction.probability = probability;
    prediction.state = state;
    change.predictions.push_back(prediction);
  };
  predict(1, 0.4, map::PredictionState::kOpen);
  predict(2, 0.9, map::PredictionState::kOpen);
  predict(3, 0.9, map::PredictionState::kOpen);
  predict(4, 1.0, map::PredictionState::kConfirmed);
  predict(5, 1.0, map::PredictionState::kRefuted);
  predict(6, 1.0, map::PredictionState::kMerged);
  auto store = map::MapStore::inMemory();
  store.commit(change);
  std::vector<std::int64_t> found;
  for (const auto& room : predictedRooms(store.view())) found.push_back(room.prediction.value);
  EXPECT_THAT(found, ElementsAre(2, 3, 1));
}

/// Of a room beyond the stairs from x = -0.775 uphill to x = -3.025, which are one storey high.
geometry::Pose2 viewpointBeforeStairs(double height) {
  auto change = sampleMapToBeChanged();
  auto& stairs = change.entities.at(2);
  std::get<map::Staircase>(stairs.attributes).height = height;
  auto prediction = test::SampleMap().view().predictions().at(0);
  prediction.cause = stairs.id;
  prediction.submap = stairs.submap;
  change.predictions = {prediction};
  auto store = map::MapStore::inMemory();
  store.commit(change);
  return predictedRooms(store.view()).at(0).viewpoint_in_map;
}

TEST(PredictedRooms, AreEnteredFromWhereTheMapSays) {
  auto change = sampleMapToBeChanged();
  change.predictions = test::SampleMap().view().predictions();
  change.predictions[0].viewpoint_in_submap = {1.5, 0.25, 0.5};
  auto store = map::MapStore::inMemory();
  store.commit(change);
  const auto room = predictedRooms(store.view()).at(0);
  EXPECT_TRUE(room.isViewpointFree);
  EXPECT_EQ(room.viewpoint_in_map, (geometry::Pose2{6.5, 0.25, 0.5})) << "the sub-map lies at x = 5";
}

TEST(PredictedRooms, ComeByTheirGainPerMetre) {
  auto change = sampleMapToBeChanged();
  auto near = test::SampleMap().view().predictions().at(0);
  near.probability = 0.5;
  near.submap = {1};
  near.viewpoint_in_submap = {1.0, 0.0, 0.0};
  change.predictions.push_back(near);
  auto far = near;
  far.id = {2};
  far.probability = 0.9;
  far.viewpoint_in_submap = {6.0, 0.0, 0.0};
  change.predictions.push_back(far);
  auto unreachable = far;
  unreachable.id = {3};
  unreachable.submap = {5};  // no edges here
  change.predictions.push_back(unreachable);
  const auto grid = test::SampleMap().view().findLayer<map::OccupancyGrid>(SubMapId{1});
  change.layers = {{SubMapId{1}, grid.get()}};
  auto store = map::MapStore::inMemory();
  store.commit(change);
  const auto idsOf = [](const std::vector<PredictedRoom>& rooms) {
    std::vector<std::int64_t> ids;
    for (const auto& room : rooms) ids.push_back(room.prediction.value);
    return ids;
  };
  EXPECT_THAT(idsOf(predictedRooms(store.view(), 0.0, Position{0, 0, 0})), ElementsAre(1, 2, 3));
  EXPECT_THAT(idsOf(predictedRooms(store.view())), ElementsAre(2, 3, 1)) << "by probability, where nobody walks";
  far.blocked = base::Time{};
  store.commit({.predictions = {far}});
  EXPECT_THAT(idsOf(predictedRooms(store.view())), ElementsAre(3, 1, 2)) << "what is blocked comes last";
}

TEST_F(SampleMapQuery, TellsTheFreeFloorOfAPredictedRoom) {
  const auto rooms = predictedRooms(view_);
  ASSERT_THAT(rooms.at(0).freeFloor, SizeIs(2));
  EXPECT_EQ(rooms[0].freeFloor[0].threshold, 0.5);
  EXPECT_NEAR(rooms[0].freeFloor[0].area, 3.7 * 4.0, 1e-9);
  const auto floor = freeFloor(view_, {6}, 0.7);
  ASSERT_THAT(floor, SizeIs(1));
  EXPECT_NEAR(floor[0].area, 2.8 * 2.4, 1e-9);
  EXPECT_NEAR(floor[0].outline_in_map.at(0).x(), 9.25 - 1.2, 1e-9);
  EXPECT_THAT(freeFloor(view_, {1}, 0.5), IsEmpty());
  EXPECT_THROW(freeFloor(view_, {6}, 0.55), base::UsageError);
}

TEST_F(SampleMapQuery, TellsDoorsStairsAndPeople) {
  const auto doorsSeen = doors(view_);
  ASSERT_THAT(doorsSeen, SizeIs(2));
  EXPECT_EQ(doorsSeen[1].id.value, 2);
  EXPECT_EQ(doorsSeen[1].floor, 0);
  EXPECT_NEAR(doorsSeen[1].T_map_entity.translation().x(), 7.875, 1e-9);
  EXPECT_THAT(stairs(view_), SizeIs(1));
  ASSERT_THAT(people(view_), SizeIs(1));
  EXPECT_EQ(people(view_)[0].submap, SubMapId{3});
  const auto& submap = view_.graph().getNode({3});
  EXPECT_TRUE(people(view_)[0].T_map_entity.translation().isApprox(submap.T_map_submap * Eigen::Vector3d(1, 1, 0)));
}

TEST(Doors, ThatWereGivenUpAreNotTold) {
  auto change = sampleMapToBeChanged();
  change.entities.at(1).confidence = 0.0;
  auto store = map::MapStore::inMemory();
  store.commit(change);
  EXPECT_THAT(doors(store.view()), SizeIs(1));
}

TEST(PredictedRooms, AreEnteredFromTheNearEndOfTheirStairs) {
  const auto up = viewpointBeforeStairs(3.0);
  EXPECT_NEAR(up.x, -0.775 + 0.8, 1e-9);
  EXPECT_NEAR(up.y, 0.0, 1e-9);
  EXPECT_NEAR(std::abs(up.theta), std::numbers::pi, 1e-9) << "looks uphill";
  const auto down = viewpointBeforeStairs(-3.0);
  EXPECT_NEAR(down.x, -3.025 - 0.8, 1e-9);
  EXPECT_NEAR(down.y, 0.0, 1e-9);
  EXPECT_NEAR(geometry::normalizeAngle(down.theta), 0.0, 1e-9) << "looks downhill";
}

/// Nothing moves afterwards, and nothing finds itself in another session.
mapper::MapperConfig withPosesOfWheels() {
  mapper::MapperConfig config;
  config.input.poses = "odometry";
  return config;
}

/// 25 m through four rooms.
void drive(mapper::Mapper& mapper) {
  testing::LaserRobot robot;
  robot.beams = 91;
  for (const auto& reading : driveThrough(testing::fourRooms(), {{1.0, 1.0}, {13.0, 1.0}, {6.0, 1.1}}, robot)) {
    mapper.process(reading);
  }
}

TEST(Query, AnswersOfARunningMapperAsOfItsFile) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "map.prodomos";
  auto store = map::MapStore::create(path);
  mapper::Mapper mapper(store, withPosesOfWheels(), {.path = "live", .kind = "a test"});
  EXPECT_EQ(placeAt(mapper.view(), {0, 0, 0}).submap, std::nullopt) << "nothing is seen yet";
  drive(mapper);
  const auto running = mapper.view();
  ASSERT_GT(running.graph().nodes().size(), map::MapView::open(path).graph().nodes().size());
  mapper.finish();
  const auto written = map::MapView::open(path);

  int known = 0;
  for (double x = -0.5; x < 14.0; x += 0.7) {
    for (double y = -0.5; y < 3.0; y += 0.7) {
      const auto live = placeAt(running, {x, y, 0});
      const auto read = placeAt(written, {x, y, 0});
      EXPECT_EQ(live.submap, read.submap);
      EXPECT_EQ(live.place, read.place);
      EXPECT_EQ(live.probability, read.probability);
      known += live.submap ? 1 : 0;
      const auto liveRoute = routeBetween(running, {0, 0, 0}, {x, y, 0});
      const auto readRoute = routeBetween(written, {0, 0, 0}, {x, y, 0});
      ASSERT_EQ(liveRoute.has_value(), readRoute.has_value());
      if (liveRoute) {
        EXPECT_EQ(liveRoute->submaps, readRoute->submaps);
      }
    }
  }
  EXPECT_GT(known, 50);
  EXPECT_THAT(predictedRooms(running), IsEmpty());
  EXPECT_THAT(predictedRooms(written), IsEmpty());
}

TEST(Query, HasNoRouteBetweenSessionsThatNothingJoins) {
  auto store = map::MapStore::inMemory();
  for (int session = 0; session < 2; ++session) {
    mapper::Mapper mapper(store, withPosesOfWheels(), {.path = "live", .kind = "a test"});
    drive(mapper);
    mapper.finish();
  }
  const auto graph = store.view().graph();
  EXPECT_EQ(graph.componentCount(), 2);
  EXPECT_EQ(graph.shortestRoute(graph.nodes().front(), graph.nodes().back()), std::nullopt);
}

}  // namespace
}  // namespace prodomos::query

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/hindsight.hpp"

#include "prodomos/map/map_store.hpp"

#include "evaluation/seen_floor.hpp"
#include "evaluation/small_building.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace prodomos::evaluation {
namespace {

using map::PredictionState;
using test::at;
using test::kQuarter;
using test::rectangle;

/// The small building, as a robot comes to know it: the corridor in sub-map s1, which ends at 10 s, then what lies
/// behind the doorway o1 into office A, in s2 until 20 s. It goes from (1, 1) into the office at 14 s.
struct Hindsight : testing::Test {
  Hindsight() {
    change.sessions = {{.id = {1}, .log = "small.rawlog", .logKind = "MRPT rawlog", .begin = at(0), .end = at(20)}};
    change.floors = {{.number = 0, .height = 0.0}};
    addOpening(1, {2, 2.1, kQuarter});
    for (int second = 0; second <= 20; ++second) go(second, second < 14 ? 1.0 : 2.0, second < 14 ? 1.0 : 4.0);
  }

  void addOpening(int id, const geometry::Pose2& T_world_opening) {
    map::Entity entity;
    entity.id = {id};
    entity.submap = {1};
    entity.T_submap_entity = geometry::toPose3(T_world_opening);
    entity.firstSeen = entity.lastSeen = at(5);
    entity.confidence = 0.9;
    entity.attributes = map::Door{.width = 0.9, .hasLeaf = false};
    change.entities.push_back(entity);
  }

  void go(int second, double x, double y) {
    const geometry::Pose3 T_map_body = T_map_world * geometry::toPose3({x, y, 0.0});
    change.trajectory.push_back(
        {.session = {1}, .time = at(second), .submap = {second <= 10 ? 1 : 2}, .T_travel_body = T_map_body});
  }

  /// On what lies behind o1, made at 10 s and settled at 20 s; its node is half a metre behind the opening.
  map::Prediction& bet(PredictionState state, double probability = 0.9) {
    map::Prediction prediction;
    prediction.id = {static_cast<std::int64_t>(change.predictions.size())};
    prediction.cause = {1};
    prediction.submap = {1};
    prediction.node = {100 + prediction.id.value};
    prediction.T_submap_node = geometry::toPose3({2, 2.6, kQuarter});
    prediction.probability = probability;
    prediction.made = at(10);
    prediction.state = state;
    if (state != PredictionState::kOpen) prediction.settled = at(20);
    change.predictions.push_back(prediction);
    return change.predictions.back();
  }

  static Polygon inNode(const Polygon& polygon_in_world) {
    return geometry::transformed(geometry::inverse(geometry::Pose2{2, 2.6, kQuarter}), polygon_in_world);
  }

  HindsightScore score() {
    const auto corridor = test::seenFloor({rectangle(0, 0, 10, 2)}, unseenBefore);
    const auto office = test::seenFloor({behind, rectangle(1.55, 2, 2.45, 2.2)}, unseenBehind);
    for (const int id : {1, 2}) {
      map::Node node;
      node.id = {id};
      node.session = {1};
      node.T_map_submap = node.T_travel_submap = T_map_world;
      node.begin = at(10 * id - 10);
      node.end = at(10 * id);
      change.nodes.push_back(node);
    }
    change.layers = {{{1}, corridor.get()}, {{2}, office.get()}};
    auto store = map::MapStore::inMemory();
    store.commit(change);
    return scoreHindsight(store.view());
  }

  map::MapChange change;
  geometry::Pose3 T_map_world = geometry::Pose3::Identity();
  std::vector<Polygon> unseenBefore = {rectangle(1.4, 1.99, 2.6, 2.3)};
  Polygon behind = rectangle(0, 2.2, 4, 6.2);
  std::vector<Polygon> unseenBehind = {rectangle(-1, 1.9, 1.5, 2.19), rectangle(2.5, 1.9, 11, 2.19)};
};

TEST_F(Hindsight, WithoutBetsHasNoMeasuresButRecall) {
  const auto none = score();
  EXPECT_EQ(none.made(), 0U);
  EXPECT_FALSE(none.settledShare());
  EXPECT_FALSE(none.precision());
  EXPECT_FALSE(none.levels[0].overall().precision());
  EXPECT_FALSE(none.levels[0].halfDiscPrecision());
  EXPECT_FALSE(none.rooms.all());
  EXPECT_EQ(none.recall.entered.truth, 1U);
  EXPECT_EQ(none.recall.entered.found, 0U);
}

TEST_F(Hindsight, OfAnEmptyMapIsNothing) {
  const auto none = scoreHindsight(map::MapStore::inMemory().view());
  EXPECT_EQ(none.made(), 0U);
  EXPECT_FALSE(none.recall.entered.recall());
  EXPECT_FALSE(none.recall.lookedInto.recall());
}

TEST_F(Hindsight, SaysWhatShareWasSettledAndCameTrue) {
  bet(PredictionState::kMerged);
  bet(PredictionState::kConfirmed);
  bet(PredictionState::kRefuted, 0.4);
  bet(PredictionState::kOpen);
  const auto all = score();
  EXPECT_EQ(all.made(), 4U);
  EXPECT_EQ(all.count(PredictionState::kRefuted), 1U);
  EXPECT_EQ(all.settledShare(), 0.75);
  EXPECT_NEAR(*all.precision(), 2.0 / 3.0, 1e-12);
  const auto calibration = calibrationOf(all.bets);
  ASSERT_TRUE(calibration);
  EXPECT_EQ(calibration->count, 3U);
  EXPECT_NEAR(calibration->brier, (0.01 + 0.01 + 0.16) / 3.0, 1e-12);
}

TEST_F(Hindsight, FloorIsRightWhereItWasSeenToBeFree) {
  bet(PredictionState::kMerged).areas = {{.threshold = 0.5, .outline_in_node = inNode(rectangle(1, 3, 3, 5))}};
  const auto cells = score().levels[0].byMobility[1];
  EXPECT_EQ(cells.precision(), 1.0);
  EXPECT_EQ(cells.seenShare(), 1.0);
  EXPECT_NEAR(static_cast<double>(cells.all()) * kCell * kCell, 4.0, 0.1);
  EXPECT_FALSE(score().levels[2].overall().precision());  // told at one threshold alone
}

TEST_F(Hindsight, FloorInAWallIsWrongAndBeyondItNobodyKnows) {
  // A metre in the room, a cell in its wall, almost a metre beyond.
  bet(PredictionState::kMerged).areas = {{.threshold = 0.5, .outline_in_node = inNode(rectangle(1, 5.2, 3, 7.2))}};
  const auto cells = score().levels[0].overall();
  EXPECT_NEAR(*cells.precision(), 20.0 / 21.0, 1e-3);
  EXPECT_NEAR(*cells.seenShare(), 21.0 / 40.0, 0.02);
}

TEST_F(Hindsight, WhatWasKnownWhenItWasToldCountsNeitherWay) {
  bet(PredictionState::kMerged).areas = {{.threshold = 0.5, .outline_in_node = inNode(rectangle(1, 1, 3, 5))}};
  const auto cells = score().levels[0].overall();
  EXPECT_NEAR(static_cast<double>(cells.all()) * kCell * kCell, 2 * 3.0, 0.1);  // without the corridor
}

TEST_F(Hindsight, ABetIsJudgedByWhatItToldWhenItWasMade) {
  bet(PredictionState::kMerged).areas = {{.threshold = 0.5, .outline_in_node = inNode(rectangle(1, 5.2, 3, 7.2))}};
  change.predictions[0].room_in_node = inNode(rectangle(0, 2.2, 4, 4.2));
  change.events = {{at(10),
                    {1},
                    "prediction_made",
                    "p0",
                    R"({"state":"open","submap":1,"areas":[{"threshold":0.5,"outline":[[1,3],[3,3],[3,5],[1,5]]}],)"
                    R"("room":[[0,2.2],[4,2.2],[4,6.2],[0,6.2]]})"}};
  EXPECT_EQ(score().levels[0].overall().precision(), 1.0);
  EXPECT_GT(*score().rooms.ordinary(), 0.97);
  change.predictions[0].state = PredictionState::kOpen;  // what it told can be judged nonetheless
  change.predictions[0].settled.reset();
  EXPECT_EQ(score().levels[0].overall().precision(), 1.0);
  for (const auto* payload : {"", "[]", "{", R"({"room":[]})", R"({"submap":77,"room":[],"areas":[]})",
                              R"({"submap":1,"room":[[1]],"areas":[]})", R"({"submap":1,"room":3,"areas":[]})"}) {
    change.events[0].payload = payload;
    EXPECT_EQ(score().levels[0].overall().all(), 0U) << payload;
  }
}

TEST_F(Hindsight, OpenBetsThatWereToldAnewTellNothingAboutFloor) {
  bet(PredictionState::kOpen).areas = {{.threshold = 0.5, .outline_in_node = inNode(rectangle(1, 3, 3, 5))}};
  EXPECT_EQ(score().levels[0].overall().all(), 0U);
}

TEST_F(Hindsight, HalfDiscsOfEqualAreaRunIntoWalls) {
  behind = rectangle(1.2, 2.2, 2.8, 6.2);  // narrow
  bet(PredictionState::kMerged).areas = {{.threshold = 0.5, .outline_in_node = inNode(rectangle(1.2, 2.3, 2.8, 6.0))}};
  const auto level = score().levels[0];
  EXPECT_EQ(level.overall().precision(), 1.0);
  ASSERT_TRUE(level.halfDiscPrecision());
  EXPECT_LT(*level.halfDiscPrecision(), 0.98);
}

TEST_F(Hindsight, TheLikelyRoomIsComparedWithTheOneThatWasSeen) {
  bet(PredictionState::kMerged).room_in_node = inNode(rectangle(0, 2.2, 4, 6.2));
  EXPECT_GT(*score().rooms.ordinary(), 0.97);
  change.predictions[0].room_in_node = inNode(rectangle(0, 2.2, 4, 4.2));
  EXPECT_NEAR(*score().rooms.ordinary(), 0.5, 0.02);
  EXPECT_EQ(score().roomsNotSeen, 0U);
}

TEST_F(Hindsight, OfARoomThatWasHardlySeenNobodyKnowsTheShape) {
  unseenBehind.push_back(rectangle(-1, 3.5, 5, 7));
  bet(PredictionState::kConfirmed).room_in_node = inNode(rectangle(0, 2.2, 4, 6.2));
  EXPECT_FALSE(score().rooms.all());
  EXPECT_EQ(score().roomsNotSeen, 1U);
}

TEST_F(Hindsight, SpaceThatIsNotApartIsNoRoom) {
  unseenBehind = {rectangle(-1, 1.9, 1.5, 2.19), rectangle(3.6, 1.9, 11, 2.19), rectangle(2.7, 1.7, 3.7, 2)};
  unseenBefore.push_back(rectangle(2.6, 1.99, 3.8, 2.3));
  behind = {{0, 2.2}, {2.8, 2.2}, {2.8, 1.8}, {3.6, 1.8}, {3.6, 2.2}, {4, 2.2}, {4, 6.2}, {0, 6.2}};  // a second way in
  bet(PredictionState::kMerged).room_in_node = inNode(rectangle(0, 2.2, 4, 6.2));
  EXPECT_EQ(score().roomsNotSeen, 1U);
}

TEST_F(Hindsight, ARoomIsPredictedInTimeIfTheBetWasMadeBeforeTheRobotEntered) {
  bet(PredictionState::kMerged);
  EXPECT_EQ(score().recall.entered.recall(), 1.0);
  EXPECT_EQ(score().recall.inTime.recall(), 1.0);
  change.predictions[0].made = at(15);
  EXPECT_EQ(score().recall.entered.recall(), 0.0);
  change.predictions[0] = bet(PredictionState::kRefuted);
  change.predictions.pop_back();
  change.predictions[0].settled = at(12);
  EXPECT_EQ(score().recall.entered.recall(), 0.0);
}

TEST_F(Hindsight, AnOpeningThatWasDetectedTooLateIsTold) {
  change.events = {{at(15), {1}, "detected", "o1", "{}"}};
  EXPECT_EQ(score().recall.entered.truth, 1U);
  EXPECT_EQ(score().recall.inTime.truth, 0U);
  change.events.insert(change.events.begin(), {at(10), {1}, "detected", "o1", "{}"});
  EXPECT_EQ(score().recall.inTime.truth, 1U);
}

TEST_F(Hindsight, ARoomThatNobodyEnteredMayHaveBeenLookedInto) {
  for (auto& point : change.trajectory) point.T_travel_body = T_map_world * geometry::toPose3({1, 1, 0});
  EXPECT_EQ(score().recall.entered.truth, 0U);
  EXPECT_EQ(score().recall.lookedInto.truth, 1U);
  EXPECT_EQ(score().recall.lookedInto.found, 0U);
  bet(PredictionState::kConfirmed);
  EXPECT_EQ(score().recall.lookedInto.found, 1U);
}

TEST_F(Hindsight, RoomsThatAreEnteredOtherwiseDoNotCount) {
  change.entities[0].T_submap_entity = geometry::toPose3({7, 2.1, kQuarter});
  EXPECT_EQ(score().recall.entered.truth, 0U);
}

TEST_F(Hindsight, IsTheSameWhereverTheMapsFrameLies) {
  bet(PredictionState::kMerged).areas = {{.threshold = 0.5, .outline_in_node = inNode(rectangle(1, 5.2, 3, 7.2))}};
  change.predictions[0].room_in_node = inNode(rectangle(0, 2.2, 4, 4.2));
  const auto before = score();
  T_map_world = geometry::toPose3({13.0, -7.0, 2.0});
  for (auto& point : change.trajectory) point.T_travel_body = T_map_world * point.T_travel_body;
  const auto moved = score();
  EXPECT_EQ(moved.settledShare(), before.settledShare());
  EXPECT_EQ(moved.recall.entered.found, before.recall.entered.found);
  EXPECT_NEAR(*moved.levels[0].overall().precision(), *before.levels[0].overall().precision(), 0.02);
  EXPECT_NEAR(*moved.rooms.ordinary(), *before.rooms.ordinary(), 0.02);
}

TEST_F(Hindsight, OfSeveralMapsAddsUp) {
  bet(PredictionState::kMerged).areas = {{.threshold = 0.5, .outline_in_node = inNode(rectangle(1, 3, 3, 5))}};
  bet(PredictionState::kOpen);
  const auto one = score();
  auto both = one;
  both += one;
  EXPECT_EQ(both.made(), 4U);
  EXPECT_EQ(both.settledShare(), 0.5);
  EXPECT_EQ(both.levels[0].overall().all(), 2 * one.levels[0].overall().all());
  EXPECT_EQ(both.rooms.shapes.size(), 2 * one.rooms.shapes.size());
  EXPECT_EQ(both.recall.entered.truth, 2U);
}

TEST_F(Hindsight, ABetWhoseDoorIsBelievedNoMoreOnlyLoses) {
  bet(PredictionState::kRefuted).areas = {{.threshold = 0.5, .outline_in_node = inNode(rectangle(1, 3, 3, 5))}};
  change.entities[0].confidence = 0.0;
  const auto lost = score();
  EXPECT_EQ(lost.precision(), 0.0);
  EXPECT_FALSE(lost.rooms.all());
  EXPECT_FALSE(lost.levels[0].halfDiscPrecision());
}

}  // namespace
}  // namespace prodomos::evaluation

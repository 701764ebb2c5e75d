// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/room_shapes.hpp"

#include "evaluation/small_building.hpp"

#include <gtest/gtest.h>

namespace prodomos::evaluation {
namespace {

using test::at;
using test::freeRectangle;
using test::kQuarter;
using test::rectangle;

struct RoomShapes : testing::Test {
  Truth truth = test::smallBuilding();
  Claims claims = test::perfectClaims();
  std::vector<KnownGrid> grids = {freeRectangle(0, 0, 10, 2)};
  // Room A is 4 m wide and deep, the door in its middle.
  Baselines baselines{.halfDiscRadius = 3.0, .fixedBox = {2, 2, 4.1}, .clippedBox = {1, 1, 4.1}};

  RoomScore score() const { return scoreRooms(makeScene(truth, claims, KnownSpace(grids)), baselines); }
  void predict(const Polygon& area, double threshold = 0.5) { claims.spaces[0].areas_in_world[threshold] = area; }
};

TEST_F(RoomShapes, AreJudgedBehindClosedDoorsAlone) {
  predict(rectangle(0, 2.2, 4, 4.2));
  EXPECT_EQ(score().shapes.size(), 1U);  // not the doorway's, nor the stairs'
  EXPECT_NEAR(*score().all(), 0.5, 1e-6);
  EXPECT_NEAR(*score().ordinary(), 0.5, 1e-6);
  truth.doors[0].states = {{at(0), 1.5, map::DoorState::kOpen}};
  EXPECT_FALSE(score().all());
}

TEST_F(RoomShapes, OfNothingAreNoMeasure) {
  claims = {};
  const auto none = score();
  for (const auto& value : {none.all(), none.ordinary(), none.fixedBox(), none.clippedBox(), none.oracleBox(),
                            none.halfDiscBest(), none.halfDiscEqualArea()}) {
    EXPECT_FALSE(value);
  }
  EXPECT_EQ(none.doors.truth, 1U);
  EXPECT_EQ(none.doors.recall(), 0.0);
}

TEST_F(RoomShapes, WithoutAnAreaPredictNothing) {
  EXPECT_EQ(score().all(), 0.0);
  EXPECT_NEAR(*score().fixedBox(), 1.0, 1e-6);
}

TEST_F(RoomShapes, AreThoseOfTheLeastThreshold) {
  predict(rectangle(1, 3, 2, 4), 0.7);
  predict(rectangle(0, 2.2, 4, 6.2), 0.5);
  EXPECT_NEAR(*score().all(), 1.0, 1e-6);
}

TEST_F(RoomShapes, AreThoseOfTheLikelyRoomWhereOneIsTold) {
  predict(rectangle(1, 3, 2, 4));
  claims.spaces[0].room_in_world = rectangle(0, 2.2, 4, 6.2);
  EXPECT_NEAR(*score().all(), 1.0, 1e-6);
}

TEST_F(RoomShapes, StandBesideTrivialPredictors) {
  predict(rectangle(0, 2.2, 4, 6.2));
  const auto all = score();
  EXPECT_NEAR(*all.fixedBox(), 1.0, 1e-6);
  EXPECT_NEAR(*all.clippedBox(), 0.5, 1e-6);
  EXPECT_NEAR(*all.oracleBox(), 1.0, 1e-6);
  // A half-disc of 3 m about the middle of the room's edge: what of it lies within ±2 m.
  const double within = 2.0 * std::sqrt(5.0) + 9.0 * std::asin(2.0 / 3.0);
  EXPECT_NEAR(*all.halfDiscBest(), within / (16.0 + 4.5 * std::numbers::pi - within), 0.03);
  // Of 16 m² it has a radius of 3.19 m.
  EXPECT_NEAR(*all.halfDiscEqualArea(), all.shapes[0].halfDiscs[63], 1e-9);
}

TEST_F(RoomShapes, OfCorridorsAndHallsAreNotOrdinary) {
  predict(rectangle(0, 2.2, 4, 6.2));
  truth.rooms[1].use = "corridor";
  EXPECT_NEAR(*score().all(), 1.0, 1e-6);
  EXPECT_FALSE(score().ordinary());
  EXPECT_FALSE(score().clippedBox());
  truth.rooms[1].use = "room";
  truth.rooms[1].outline = rectangle(0, 2.2, 4, 18.2);  // 64 m²
  EXPECT_NEAR(*score().all(), 0.25, 1e-6);
  EXPECT_FALSE(score().ordinary());
}

TEST_F(RoomShapes, OfRoomsThatWereKnownAreNotJudged) {
  predict(rectangle(0, 2.2, 4, 6.2));
  grids.push_back(freeRectangle(0, 2.2, 4, 6.2, at(4)));
  EXPECT_TRUE(score().shapes.empty());
  grids.back().since = at(6);
  EXPECT_EQ(score().shapes.size(), 1U);
}

TEST_F(RoomShapes, BoxesAreClippedByWhatWasKnownThen) {
  baselines.clippedBox = {4, 4, 8};
  // A strip along the room's left edge is known, and what lies beyond its far wall.
  grids.push_back(freeRectangle(-1, 2.2, 0, 12, at(4)));
  grids.push_back(freeRectangle(-1, 6.2, 8, 12, at(4)));
  EXPECT_NEAR(*score().clippedBox(), 16.0 / 24.0, 0.01);  // 2 m too wide to the right
}

TEST_F(RoomShapes, OfTwoDoorsWithOneNodeCountOnce) {
  predict(rectangle(0, 2.2, 4, 6.2));
  truth.doors.push_back(test::trueDoor("dA2", {3.5, 2.1, kQuarter}, "corridor", "A", 1));
  claims.doors.push_back(test::claimedDoor(4, {3.5, 2.1, kQuarter}));
  claims.spaces.push_back(test::claimedSpace(4, 4));
  EXPECT_EQ(score().shapes.size(), 2U);
  claims.spaces[3].node = claims.spaces[0].node;
  EXPECT_EQ(score().shapes.size(), 1U);
}

TEST_F(RoomShapes, CountClosedDoorsWithAndWithoutAPrediction) {
  EXPECT_EQ(score().doors.recall(), 1.0);
  claims.spaces[0].state = map::PredictionState::kRefuted;
  EXPECT_EQ(score().doors.recall(), 0.0);
  truth.doors[0].sighting.visible = false;
  EXPECT_FALSE(score().doors.recall());
}

TEST_F(RoomShapes, OfManyMapsHaveOneRadiusForEqualArea) {
  predict(rectangle(0, 2.2, 4, 6.2));
  auto sum = score();
  predict(rectangle(1, 2.2, 3, 4.2));
  sum += score();
  EXPECT_NEAR(*sum.all(), (1.0 + 0.25) / 2.0, 1e-6);
  EXPECT_NEAR(*sum.halfDiscEqualArea(), sum.shapes[0].halfDiscs[49], 1e-9);  // 10 m²: 2.52 m
}

}  // namespace
}  // namespace prodomos::evaluation

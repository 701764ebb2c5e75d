// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/predicted_nodes.hpp"

#include "evaluation/small_building.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace prodomos::evaluation {
namespace {

using test::at;
using test::claimedSpace;
using test::freeRectangle;
using test::kQuarter;

struct PredictedNodes : testing::Test {
  Truth truth = test::smallBuilding();
  Claims claims = test::perfectClaims();
  std::vector<KnownGrid> grids = {freeRectangle(0, 0, 10, 2)};

  Scene scene() const { return makeScene(truth, claims, KnownSpace(grids)); }
  NodeScore score() const { return scoreNodes(scene()); }
  std::size_t cameTrue() const {
    return static_cast<std::size_t>(std::ranges::count_if(betsOf(scene()), &Bet::cameTrue));
  }
};

TEST_F(PredictedNodes, BehindEveryOpeningAreAllThereIs) {
  EXPECT_EQ(score().precision(), 1.0);
  EXPECT_EQ(score().right, 3U);
  EXPECT_EQ(score().behindVisible.truth, 3U);
  EXPECT_EQ(score().behindVisible.recall(), 1.0);
  EXPECT_EQ(score().adjacent.recall(), 1.0);
  EXPECT_EQ(betsOf(scene()).size(), 3U);
  EXPECT_EQ(cameTrue(), 3U);
}

TEST_F(PredictedNodes, OfNothingAreNoMeasure) {
  claims = {};
  EXPECT_FALSE(score().precision());
  EXPECT_EQ(score().behindVisible.recall(), 0.0);
  truth = {};
  EXPECT_FALSE(score().behindVisible.recall());
  EXPECT_TRUE(betsOf(scene()).empty());
}

TEST_F(PredictedNodes, MissingOnesCost) {
  claims.spaces.pop_back();
  EXPECT_EQ(score().precision(), 1.0);
  EXPECT_NEAR(*score().behindVisible.recall(), 2.0 / 3.0, 1e-12);
}

TEST_F(PredictedNodes, BehindAFalseDoorAreWrong) {
  claims.doors[0].T_world_door = {5, 0, -kQuarter};
  EXPECT_NEAR(*score().precision(), 2.0 / 3.0, 1e-12);
  EXPECT_EQ(betsOf(scene()).size(), 3U);
  EXPECT_EQ(cameTrue(), 2U);
  claims.doors.erase(claims.doors.begin());  // the map has lost the cause
  EXPECT_NEAR(*score().precision(), 2.0 / 3.0, 1e-12);
}

TEST_F(PredictedNodes, OnTheNearSideOfADoorAreWrong) {
  claims.doors[0].T_world_door.theta = -kQuarter;  // into the corridor
  EXPECT_EQ(score().right, 2U);
  EXPECT_NEAR(*score().behindVisible.recall(), 2.0 / 3.0, 1e-12);
}

TEST_F(PredictedNodes, OfRoomsThatAreKnownAreWrong) {
  grids.push_back(freeRectangle(0, 2.2, 4, 6.2, at(4)));
  EXPECT_EQ(score().right, 2U);
  EXPECT_EQ(score().behindVisible.truth, 2U);
  EXPECT_EQ(cameTrue(), 2U);
}

TEST_F(PredictedNodes, MadeBeforeTheRoomWasSeenAreRight) {
  grids.push_back(freeRectangle(0, 2.2, 4, 6.2, at(6)));
  truth.rooms[1].entered = at(6);
  EXPECT_EQ(score().right, 3U);
  EXPECT_EQ(score().behindVisible.truth, 2U);  // in the end it is seen
  EXPECT_EQ(cameTrue(), 3U);
}

TEST_F(PredictedNodes, OfRoomsThatHaveBeenEnteredAreWrong) {
  truth.rooms[1].entered = at(4);
  EXPECT_EQ(score().right, 2U);
}

TEST_F(PredictedNodes, OfLittleUnseenSpaceAreWrong) {
  grids.push_back(freeRectangle(0, 2.2, 4, 5.75));
  EXPECT_EQ(score().right, 2U);  // 1.8 m² are left
  grids.back() = freeRectangle(0, 2.2, 4, 5.65);
  EXPECT_EQ(score().right, 3U);                // 2.2 m²
  EXPECT_EQ(score().behindVisible.truth, 2U);  // but the room counts as seen
}

TEST_F(PredictedNodes, AreTwoForOneRoomIsOneTooMany) {
  truth.doors.push_back(test::trueDoor("dA2", {3.5, 2.1, kQuarter}, "corridor", "A", 1));
  claims.doors.push_back(test::claimedDoor(4, {3.5, 2.1, kQuarter}));
  claims.spaces.push_back(claimedSpace(4, 4));
  EXPECT_EQ(score().right, 3U);
  EXPECT_EQ(score().wrong, 1U);
  EXPECT_EQ(cameTrue(), 4U);  // there is a space behind either door

  claims.spaces[3].node = claims.spaces[0].node;
  EXPECT_EQ(score().precision(), 1.0);

  claims.spaces[3].node = {200};
  claims.spaces[0].settled = at(5.5);
  EXPECT_EQ(score().wrong, 1U);
  claims.spaces[3].made = at(6);  // when the first bet was off
  EXPECT_EQ(score().wrong, 0U);
}

TEST_F(PredictedNodes, ThatWereTakenBackFindNothing) {
  claims.spaces[0].state = map::PredictionState::kRefuted;
  EXPECT_NEAR(*score().behindVisible.recall(), 2.0 / 3.0, 1e-12);
}

TEST_F(PredictedNodes, ByPeopleAreNone) {
  claims.spaces[0].mobility = map::Mobility::kDynamic;
  EXPECT_EQ(score().right + score().wrong, 2U);
  EXPECT_EQ(betsOf(scene()).size(), 2U);
}

TEST_F(PredictedNodes, UpStairsMustBeAtTheRightHeight) {
  claims.stairs[0].stairs.height = 2.4;
  EXPECT_EQ(score().right, 2U);
  claims.stairs[0].stairs.height = 2.6;
  EXPECT_EQ(score().right, 3U);
  claims.stairs[0].stairs.height = -3.0;
  EXPECT_EQ(score().right, 2U);
}

TEST_F(PredictedNodes, UpToAStoreyThatIsNotModelledAreRight) {
  truth.rooms.pop_back();
  truth.stairs[0].rooms[1].clear();
  EXPECT_EQ(score().right, 3U);
  EXPECT_EQ(score().behindVisible.truth, 3U);
  EXPECT_EQ(score().behindVisible.recall(), 1.0);
}

TEST_F(PredictedNodes, BehindDoorsThatLeadOutsideCountNeitherWay) {
  truth.doors[0].rooms[1].clear();
  EXPECT_EQ(score().right + score().wrong, 2U);
  EXPECT_EQ(betsOf(scene()).size(), 2U);
  EXPECT_EQ(score().behindVisible.truth, 2U);
}

TEST_F(PredictedNodes, AreSoughtBehindVisibleThingsAndBesideItOfAllNeighbours) {
  truth.doors[0].sighting.visible = false;
  claims.spaces.erase(claims.spaces.begin());
  EXPECT_EQ(score().behindVisible.recall(), 1.0);
  EXPECT_EQ(score().behindVisible.truth, 2U);
  EXPECT_NEAR(*score().adjacent.recall(), 2.0 / 3.0, 1e-12);
}

TEST_F(PredictedNodes, AreNotSoughtBehindRoomsThatNobodyHasSeen) {
  truth.rooms.push_back({.id = "closet", .use = "room", .outline = test::rectangle(0, 6.4, 4, 8)});
  truth.doors.push_back(test::trueDoor("dC", {2, 6.3, kQuarter}, "A", "closet", 1));
  EXPECT_EQ(score().adjacent.truth, 3U);
}

TEST_F(PredictedNodes, DoNotDependOnTheirOrder) {
  claims.spaces.push_back(claimedSpace(9, 1));
  const auto before = score();
  std::ranges::reverse(claims.spaces);
  std::ranges::reverse(claims.doors);
  std::ranges::reverse(truth.rooms);
  const auto after = score();
  EXPECT_EQ(after.right, before.right);
  EXPECT_EQ(after.wrong, before.wrong);
  EXPECT_EQ(after.behindVisible.found, before.behindVisible.found);
}

}  // namespace
}  // namespace prodomos::evaluation

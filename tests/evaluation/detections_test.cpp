// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/detections.hpp"

#include "evaluation/small_building.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace prodomos::evaluation {
namespace {

using test::at;
using test::claimedDoor;
using test::kQuarter;

constexpr double kDegree = std::numbers::pi / 180.0;

struct Detections : testing::Test {
  Truth truth = test::smallBuilding();
  Claims claims = test::perfectClaims();

  DoorScore doors() const { return scoreDoors(claims, matchDoors(claims.doors, truth), truth, true); }
  DoorScore doorways() const { return scoreDoors(claims, matchDoors(claims.doors, truth), truth, false); }
  StairsScore stairs() const { return scoreStairs(claims, matchStairs(claims.stairs, truth), truth); }
};

TEST_F(Detections, OfThingsWhereTheyAreAreRight) {
  for (const auto& score : {doors(), doorways()}) {
    EXPECT_EQ(score.counts.all.recall(), 1.0);
    EXPECT_EQ(score.counts.visible.recall(), 1.0);
    EXPECT_EQ(score.counts.passed.recall(), 1.0);
    EXPECT_EQ(score.counts.precision(), 1.0);
    EXPECT_NEAR(score.centre.at(0), 0.0, 1e-9);
    EXPECT_NEAR(score.normal.at(0), 0.0, 1e-9);
  }
  EXPECT_EQ(doors().hingeSides.recall(), 1.0);
  EXPECT_EQ(doors().states.recall(), 1.0);
  EXPECT_EQ(stairs().counts.all.recall(), 1.0);
  EXPECT_EQ(stairs().counts.precision(), 1.0);
}

TEST_F(Detections, OfNothingAreNoMeasure) {
  truth.doors.clear();
  truth.stairs.clear();
  claims = {};
  EXPECT_FALSE(doors().counts.all.recall());
  EXPECT_FALSE(doors().counts.precision());
  EXPECT_FALSE(doors().hingeSides.recall());
  EXPECT_FALSE(stairs().counts.visible.recall());
}

TEST_F(Detections, MissedAndInventedOnesCount) {
  claims.doors = {claimedDoor(1, {5, 0, kQuarter})};
  claims.stairs.clear();
  EXPECT_EQ(doors().counts.all.recall(), 0.0);
  EXPECT_EQ(doors().counts.precision(), 0.0);
  EXPECT_TRUE(doors().centre.empty());
  EXPECT_EQ(stairs().counts.all.recall(), 0.0);
  EXPECT_FALSE(stairs().counts.precision());
}

TEST_F(Detections, MayBeOffByTheGates) {
  const auto recallOf = [this](const geometry::Pose2& pose) {
    claims.doors = {claimedDoor(1, pose)};
    return *doors().counts.all.recall();
  };
  EXPECT_EQ(recallOf({2.49, 2.1, kQuarter}), 1.0);
  EXPECT_EQ(recallOf({2.51, 2.1, kQuarter}), 0.0);
  EXPECT_EQ(recallOf({2, 2.1, kQuarter + 29 * kDegree}), 1.0);
  EXPECT_EQ(recallOf({2, 2.1, kQuarter + 31 * kDegree}), 0.0);
  EXPECT_EQ(recallOf({2, 2.1, -kQuarter + 29 * kDegree}), 1.0);
  EXPECT_EQ(recallOf({std::numeric_limits<double>::quiet_NaN(), 2.1, kQuarter}), 0.0);
}

TEST_F(Detections, OnAnotherStoreyAreWrong) {
  claims.doors[0].storey = 1;
  EXPECT_EQ(doors().counts.all.recall(), 0.0);
}

TEST_F(Detections, SeenFromBehindHaveTheirHingeOnTheOtherSide) {
  claims.doors[0].T_world_door.theta = -kQuarter;
  EXPECT_NEAR(doors().normal.at(0), 0.0, 1e-9);
  EXPECT_EQ(doors().hingeSides.recall(), 0.0);
  claims.doors[0].door.hingeSide = map::HingeSide::kRight;
  EXPECT_EQ(doors().hingeSides.recall(), 1.0);
  claims.doors[0].door.hingeSide = map::HingeSide::kUnknown;
  EXPECT_EQ(doors().hingeSides.recall(), 0.0);
  truth.doors[0].hingeSide = map::HingeSide::kUnknown;
  EXPECT_FALSE(doors().hingeSides.recall());
}

TEST_F(Detections, HaveTheStateThatTheDoorHadWhenLastSeen) {
  truth.doors[0].states.push_back({at(8), 1.2, map::DoorState::kOpen});
  EXPECT_EQ(doors().states.recall(), 0.0);
  claims.doors[0].lastSeen = at(7.9);
  EXPECT_EQ(doors().states.recall(), 1.0);
}

TEST_F(Detections, HaveErrorsOfPoseAndSize) {
  claims.doors[0] = claimedDoor(1, {2.1, 2.1, kQuarter - 4 * kDegree});
  claims.doors[0].door.width = 0.8;
  claims.doors[0].door.height = 0.0;  // not measured
  const auto score = doors();
  EXPECT_NEAR(score.centre.at(0), 0.1, 1e-9);
  EXPECT_NEAR(score.normal.at(0), 4 * kDegree, 1e-9);
  EXPECT_NEAR(score.width.at(0), 0.1, 1e-9);
  EXPECT_TRUE(score.height.empty());
}

TEST_F(Detections, AreHeldAgainstTheLeafWhereItHangs) {
  truth.doors[0].leafOffset = 0.08;
  EXPECT_NEAR(doors().centre.at(0), 0.08, 1e-9);
  claims.doors[0].T_world_door = {2, 2.18, kQuarter};
  EXPECT_NEAR(doors().centre.at(0), 0.0, 1e-9);
}

TEST_F(Detections, ThatAreNotFiniteGiveNoError) {
  claims.doors[0].door.width = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(doors().width.empty());
  EXPECT_EQ(doors().counts.all.recall(), 1.0);
}

TEST_F(Detections, OfOneDoorTwiceAreOneRightAndOneWrong) {
  claims.doors.push_back(claimedDoor(7, {2.2, 2.1, kQuarter}));
  EXPECT_EQ(doors().counts.all.recall(), 1.0);
  EXPECT_EQ(doors().counts.precision(), 0.5);
  EXPECT_NEAR(doors().centre.at(0), 0.0, 1e-9);  // the better one counts
}

TEST_F(Detections, ArePairedForTheLeastSumNotGreedily) {
  // The claim between two doors must leave the nearer one to the other claim.
  truth.doors = {test::trueDoor("d1", {0, 0, kQuarter}, "corridor", "A", 1),
                 test::trueDoor("d2", {0.6, 0, kQuarter}, "corridor", "A", 1)};
  claims.doors = {claimedDoor(1, {0.28, 0, kQuarter}), claimedDoor(2, {-0.3, 0, kQuarter})};
  EXPECT_EQ(doors().counts.all.recall(), 1.0);
}

TEST_F(Detections, DoNotDependOnTheirOrder) {
  claims.doors.push_back(claimedDoor(7, {2.2, 2.1, kQuarter}));
  const auto before = doors();
  std::ranges::reverse(claims.doors);
  std::ranges::reverse(truth.doors);
  const auto after = doors();
  EXPECT_EQ(after.counts.all.found, before.counts.all.found);
  EXPECT_EQ(after.counts.wrong, before.counts.wrong);
  EXPECT_EQ(after.centre, before.centre);
}

TEST_F(Detections, AreTheSameInAMovedAndTurnedWorld) {
  claims.doors[0] = claimedDoor(1, {2.1, 2.15, kQuarter - 4 * kDegree});
  const auto before = doors();
  const geometry::Pose2 T_new_old{30, -7, 2.5};
  for (auto& claim : claims.doors) claim.T_world_door = T_new_old * claim.T_world_door;
  for (auto& door : truth.doors) door.T_world_door = geometry::toPose3(T_new_old) * door.T_world_door;
  const auto after = doors();
  EXPECT_NEAR(after.centre.at(0), before.centre.at(0), 1e-9);
  EXPECT_NEAR(after.normal.at(0), before.normal.at(0), 1e-9);
  EXPECT_EQ(after.hingeSides.recall(), before.hingeSides.recall());
}

TEST_F(Detections, OfADoorwayInAClosedDoorAreWrongInAnOpenOneNeither) {
  claims.doors[0] = claimedDoor(1, {2, 2.1, kQuarter}, false);
  EXPECT_EQ(doors().counts.all.recall(), 0.0);
  EXPECT_EQ(doorways().counts.precision(), 0.5);
  truth.doors[0].states.push_back({at(4), 1.2, map::DoorState::kOpen});
  EXPECT_EQ(doors().counts.all.recall(), 0.0);
  EXPECT_EQ(doorways().counts.precision(), 1.0);
  truth.doors[0].states[1].time = at(20);  // after it was last seen
  EXPECT_EQ(doorways().counts.precision(), 0.5);
}

TEST_F(Detections, OfALeafInADoorwayAreWrong) {
  claims.doors[1].door.hasLeaf = true;
  EXPECT_EQ(doors().counts.precision(), 0.5);
  EXPECT_EQ(doorways().counts.all.recall(), 0.0);
  EXPECT_FALSE(doorways().counts.precision());
  EXPECT_EQ(matchDoors(claims.doors, truth)[1].truth, 1U);  // an opening is there all the same
}

TEST_F(Detections, AtALiftsDoorCountNeitherWay) {
  truth.rooms[1].use = "lift";
  EXPECT_FALSE(doors().counts.all.recall());
  EXPECT_FALSE(doors().counts.precision());
}

TEST_F(Detections, CountByVisibleAndPassedThings) {
  truth.doors.push_back(test::trueDoor("dC", {9, -0.1, kQuarter}, "corridor", "A", 1));
  truth.doors.back().sighting.visible = false;
  EXPECT_EQ(doors().counts.all.recall(), 0.5);
  EXPECT_EQ(doors().counts.visible.recall(), 1.0);
  EXPECT_EQ(doors().counts.passed.recall(), 0.5);
}

TEST_F(Detections, PerImageAreUnknownUnlessTheMapTells) {
  EXPECT_FALSE(doors().counts.images);
  claims.images.emplace();
  claims.images->emplace(base::EntityId{1}, at(2.01));
  claims.images->emplace(base::EntityId{1}, at(5));
  EXPECT_EQ(doors().counts.images->recall(), 0.5);  // seen whole at 1 and 2
  EXPECT_EQ(doorways().counts.images->recall(), 0.0);
  EXPECT_FALSE(stairs().counts.images->recall());  // no image shows the flight whole
}

TEST_F(Detections, OfStairsHaveErrorsOfFootDirectionAndHeight) {
  auto& claim = claims.stairs[0];
  claim.T_world_stairs = {-2.75, 1.2, std::numbers::pi - 5 * kDegree};
  claim.foot = Eigen::Vector2d(-0.5, 1.2);
  claim.stairs.stepWidth = 1.0;
  claim.stairs.height = 2.8;
  const auto score = stairs();
  EXPECT_NEAR(score.foot.at(0), 0.2, 1e-9);
  EXPECT_NEAR(score.direction.at(0), 5 * kDegree, 1e-9);
  EXPECT_NEAR(score.width.at(0), 0.2, 1e-9);
  EXPECT_NEAR(score.height.at(0), 0.2, 1e-9);
}

TEST_F(Detections, OfStairsFromAboveDescend) {
  claims.stairs[0].storey = 1;
  claims.stairs[0].stairs.height = -3.0;
  EXPECT_NEAR(stairs().height.at(0), 0.0, 1e-9);
  claims.stairs[0].stairs.height = 3.0;
  EXPECT_NEAR(stairs().height.at(0), 6.0, 1e-9);
}

TEST_F(Detections, OfStairsThatAreTurnedRoundAreWrong) {
  claims.stairs[0].T_world_stairs.theta = 0.0;
  EXPECT_EQ(stairs().counts.precision(), 0.0);
}

TEST_F(Detections, OfPartOfAFlightAreFoundByTheFootAlone) {
  claims.stairs[0].T_world_stairs.x = -1.0;
  EXPECT_EQ(stairs().counts.all.recall(), 1.0);
  claims.stairs[0].foot.reset();
  EXPECT_EQ(stairs().counts.all.recall(), 0.0);
}

TEST_F(Detections, OfSeveralMapsAddUp) {
  auto sum = doors();
  claims = {};
  sum += doors();
  EXPECT_EQ(sum.counts.all.recall(), 0.5);
  EXPECT_EQ(sum.counts.precision(), 1.0);
  EXPECT_EQ(sum.centre.size(), 1U);
}

}  // namespace
}  // namespace prodomos::evaluation

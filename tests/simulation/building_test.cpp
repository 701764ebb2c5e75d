// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/building.hpp"

#include "prodomos/base/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace prodomos::simulation {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kExact = 1e-12;

const Polygon kSquare{{0.0, 0.0}, {4.0, 0.0}, {4.0, 4.0}, {0.0, 4.0}};
/// An L with its notch at the upper right.
const Polygon kL{{0.0, 0.0}, {4.0, 0.0}, {4.0, 2.0}, {2.0, 2.0}, {2.0, 4.0}, {0.0, 4.0}};

/// A star around a centre: simple, with as many corners, reflex ones among them.
Polygon randomStar(base::Random& random, int corners) {
  Polygon star;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    const double radius = random.uniform(0.5, 3.0);
    star.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return star;
}

/// How often the polygon turns around the point, by summed angles.
int windings(const Polygon& polygon, const Eigen::Vector2d& point) {
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d a = polygon[i] - point;
    const Eigen::Vector2d b = polygon[(i + 1) % polygon.size()] - point;
    sum += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  }
  return static_cast<int>(std::lround(sum / (2.0 * std::numbers::pi)));
}

TEST(Polygons, AreaIsPositiveCounterClockwise) {
  EXPECT_NEAR(signedArea(kSquare), 16.0, kExact);
  EXPECT_NEAR(signedArea(kL), 12.0, kExact);
  EXPECT_NEAR(signedArea(Polygon(kL.rbegin(), kL.rend())), -12.0, kExact);
}

TEST(Polygons, AnLHoldsWhatLiesInItsArmsAndNotInItsNotch) {
  EXPECT_TRUE(contains(kL, {1.0, 3.0}));
  EXPECT_TRUE(contains(kL, {3.0, 1.0}));
  EXPECT_FALSE(contains(kL, {3.0, 3.0}));
  EXPECT_FALSE(contains(kL, {-0.1, 1.0}));
}

TEST(Polygons, HoldingAPointAgreesWithItsWindingNumber) {
  base::Random random(1, "stars");
  for (int star = 0; star < 50; ++star) {
    const Polygon polygon = randomStar(random, 5 + star % 9);
    for (int i = 0; i < 40; ++i) {
      const Eigen::Vector2d point(random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0));
      ASSERT_EQ(contains(polygon, point), windings(polygon, point) != 0) << point.transpose();
    }
  }
}

TEST(Polygons, ASimplePolygonDoesNotCrossItself) {
  EXPECT_FALSE(findSelfCrossing(kSquare));
  EXPECT_FALSE(findSelfCrossing(kL));
  base::Random random(2, "stars");
  for (int star = 0; star < 50; ++star) EXPECT_FALSE(findSelfCrossing(randomStar(random, 12)));
}

TEST(Polygons, ABowTieIsFoundByItsCrossingEdges) {
  const auto crossing = findSelfCrossing({{0.0, 0.0}, {4.0, 4.0}, {4.0, 0.0}, {0.0, 4.0}});
  ASSERT_TRUE(crossing);
  EXPECT_EQ(*crossing, std::pair(std::size_t{0}, std::size_t{2}));
}

TEST(Polygons, TwoNeighboursOfAConvexPolygonThatChangePlacesAreFound) {
  constexpr int kCorners = 9;
  Polygon round;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCorners;
    round.emplace_back(std::cos(angle), std::sin(angle));
  }
  for (std::size_t i = 0; i < round.size(); ++i) {
    Polygon swapped = round;
    std::swap(swapped[i], swapped[(i + 1) % round.size()]);
    EXPECT_TRUE(findSelfCrossing(swapped)) << "corner " << i;
  }
}

TEST(Polygons, TouchingItselfCountsAsCrossing) {
  // A corner on another edge; an edge that runs back over the one before it.
  EXPECT_TRUE(findSelfCrossing({{0.0, 0.0}, {4.0, 0.0}, {4.0, 4.0}, {2.0, 0.0}, {0.0, 4.0}}));
  EXPECT_TRUE(findSelfCrossing({{0.0, 0.0}, {4.0, 0.0}, {2.0, 0.0}, {2.0, 4.0}}));
}

TEST(Doors, ALeafRestsBeforeAndAfterAndTurnsEvenlyBetween) {
  const Door door{.swings = {{2.0, 0.0}, {4.0, 1.0}, {6.0, 1.0}, {7.0, 0.5}}};
  EXPECT_EQ(openingAngle(door, -1.0), 0.0);
  EXPECT_EQ(openingAngle(door, 2.0), 0.0);
  EXPECT_NEAR(openingAngle(door, 2.5), 0.25, kExact);
  EXPECT_NEAR(openingAngle(door, 5.0), 1.0, kExact);
  EXPECT_NEAR(openingAngle(door, 6.5), 0.75, kExact);
  EXPECT_EQ(openingAngle(door, 100.0), 0.5);
}

TEST(Doors, ADoorWithoutSwingsIsAlwaysClosed) {
  EXPECT_EQ(openingAngle(Door{}, 3.0), 0.0);
}

TEST(Doors, StatesChangeAtFiveAndSixtyDegrees) {
  EXPECT_EQ(stateOf(0.0), map::DoorState::kClosed);
  EXPECT_EQ(stateOf(4.9 * kDegree), map::DoorState::kClosed);
  EXPECT_EQ(stateOf(5.1 * kDegree), map::DoorState::kAjar);
  EXPECT_EQ(stateOf(59.9 * kDegree), map::DoorState::kAjar);
  EXPECT_EQ(stateOf(60.1 * kDegree), map::DoorState::kOpen);
}

TEST(Doors, ALiftsDoorHasALiftOnOneOfItsSides) {
  Building building;
  building.rooms = {{.use = RoomUse::kCorridor}, {.use = RoomUse::kLift}, {.use = RoomUse::kRoom}};
  EXPECT_TRUE(isLiftDoor(building, {.rooms = {0, 1}}));
  EXPECT_TRUE(isLiftDoor(building, {.rooms = {1, kOutside}}));
  EXPECT_FALSE(isLiftDoor(building, {.rooms = {0, 2}}));
  EXPECT_FALSE(isLiftDoor(building, {.rooms = {0, kOutside}}));
}

TEST(Stairs, TheHeadLiesOneTreadLessAheadThanRisersUp) {
  const Staircase stairs{.foot = {1.0, 2.0, 3.0},
                         .direction = std::numbers::pi / 2.0,
                         .stepDepth = 0.3,
                         .stepHeight = 0.15,
                         .stepCount = 10};
  EXPECT_TRUE(headOf(stairs).isApprox(Eigen::Vector3d(1.0, 2.0 + 2.7, 3.0 + 1.5), kExact));
}

TEST(Building, InstancesAreDistinctOverAllKindsOfThings) {
  Building building;
  building.doors.resize(3);
  building.stairs.resize(2);
  building.things.resize(4);
  building.people.resize(2);
  std::set<int> numbers{0};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(numbers.insert(doorInstance(i)).second);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(numbers.insert(stairsInstance(building, i)).second);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(numbers.insert(thingInstance(building, i)).second);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(numbers.insert(personInstance(building, i)).second);
}

TEST(Building, RoomsAreFoundOnTheirOwnStorey) {
  Building building;
  building.rooms = {{.storey = 0, .outline = kL}, {.storey = 1, .outline = kSquare}};
  EXPECT_EQ(roomAt(building, 0, {1.0, 1.0}), 0);
  EXPECT_EQ(roomAt(building, 1, {1.0, 1.0}), 1);
  EXPECT_EQ(roomAt(building, 0, {3.0, 3.0}), kOutside);
  EXPECT_EQ(roomAt(building, 2, {1.0, 1.0}), kOutside);
}

TEST(Building, LabelsSayWhatARoomIsFor) {
  EXPECT_EQ(useOfLabel("CORRIDOR"), RoomUse::kCorridor);
  EXPECT_EQ(useOfLabel("LOBBY"), RoomUse::kCorridor);
  EXPECT_EQ(useOfLabel("STAIRS"), RoomUse::kStairs);
  EXPECT_EQ(useOfLabel("ELEVATOR"), RoomUse::kLift);
  EXPECT_EQ(useOfLabel("CLASSROOM"), RoomUse::kRoom);
}

}  // namespace
}  // namespace prodomos::simulation

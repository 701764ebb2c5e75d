// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/prediction/room_guess.hpp"

#include "prodomos/base/random.hpp"

#include "prediction/reachable_floor.hpp"
#include "prediction/room_boxes.hpp"
#include "prediction/wall_place.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace prodomos::prediction {
namespace {

using geometry::CellIndex;
using map::CellState;

constexpr double kWidth = 0.9;

/// Metres ahead and across; the upper ends are not included.
struct Area {
  double begin = 0.0;
  double end = 0.0;
  double right = 0.0;
  double left = 0.0;
};

void fill(Surroundings& around, const Area& area, CellState state) {
  for (int x = inCells(area.begin); x < inCells(area.end); ++x) {
    for (int y = inCells(area.right); y < inCells(area.left); ++y) around.set({x, y}, state);
  }
}

/// Floor with walls around.
void addRoom(Surroundings& around, const Area& area) {
  fill(around, {area.begin - 0.1, area.end + 0.1, area.right - 0.1, area.left + 0.1}, CellState::kOccupied);
  fill(around, area, CellState::kFree);
}

/// A door in the long wall of a corridor 2 m wide.
Surroundings corridor() {
  Surroundings around;
  addRoom(around, {-2.1, -0.1, -8.0, 8.0});
  return around;
}

void addDoor(Surroundings& around, double across) {
  around.openings.push_back({.id = {}, .T_here_opening = {0.0, across, 0.0}, .width = kWidth, .hasLeaf = true});
}

Surroundings mirrored(const Surroundings& around) {
  Surroundings found;
  const auto& box = Surroundings::kBox;
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) found.set({x, -1 - y}, around.state(CellIndex{x, y}));
  }
  for (auto opening : around.openings) {
    auto& pose = opening.T_here_opening;
    pose = {pose.x, -pose.y, -pose.theta};
    found.openings.push_back(opening);
  }
  return found;
}

/// Rooms, stray walls and doors anywhere.
Surroundings randomWorld(std::uint64_t seed) {
  base::Random random(seed, "room_guess_test");
  Surroundings around = corridor();
  for (int i = random.integer(0, 4); i > 0; --i) {
    const double begin = random.uniform(0.2, 9.0);
    const double right = random.uniform(-9.0, 7.0);
    addRoom(around, {begin, begin + random.uniform(0.5, 5.0), right, right + random.uniform(0.5, 5.0)});
  }
  for (int i = random.integer(0, 200); i > 0; --i) {
    around.set({random.integer(1, 119), random.integer(-90, 89)},
               random.uniform() < 0.5 ? CellState::kFree : CellState::kOccupied);
  }
  for (int i = random.integer(0, 5); i > 0; --i) {
    around.openings.push_back({.id = {},
                               .T_here_opening = {random.uniform(-6.0, 12.0), random.uniform(-9.0, 9.0),
                                                  random.uniform(-std::numbers::pi, std::numbers::pi)},
                               .width = kWidth,
                               .hasLeaf = random.uniform() < 0.7});
  }
  if (random.uniform() < 0.5) {
    const double across = random.uniform(-5.0, 3.0);
    around.taken_here.push_back({{0.1, across}, {4.0, across}, {4.0, across + 2.0}, {0.1, across + 2.0}});
  }
  return around;
}

double areaOf(const geometry::Polygon& polygon) {
  return std::abs(geometry::signedArea(polygon));
}

TEST(RoomGuess, BehindADoorOfACorridorLiesARoomOfOrdinarySize) {
  const auto guess = guessRoom(corridor(), kWidth);
  EXPECT_GT(areaOf(guess.outline_here), 6.0);
  EXPECT_LT(areaOf(guess.outline_here), 80.0);
  EXPECT_TRUE(geometry::contains(guess.outline_here, {1.0, 0.0}));
  EXPECT_FALSE(geometry::contains(guess.outline_here, {-1.0, 0.0}));
  EXPECT_GT(guess.expectedArea, 6.0);
  EXPECT_GT(guess.areaDeviation, 1.0);
  EXPECT_GT(guess.expectedIou, 0.3);
  EXPECT_LT(guess.expectedIou, 0.9);
  EXPECT_GT(guess.spaceProbability, 0.5);
}

TEST(RoomGuess, ItsBoxIsThatOfItsOutline) {
  const auto guess = guessRoom(corridor(), kWidth);
  EXPECT_NEAR(areaOf(guess.outline_here), (guess.left + guess.right) * (guess.depth - 0.1), 1e-6);
}

TEST(RoomGuess, DoorsCloseBesideMakeTheRoomNarrow) {
  auto crowded = corridor();
  for (const double across : {-6.0, -3.0, 3.0, 6.0}) addDoor(crowded, across);
  auto sparse = corridor();
  for (const double across : {-7.5, 7.5}) addDoor(sparse, across);
  const auto narrow = guessRoom(crowded, kWidth);
  const auto wide = guessRoom(sparse, kWidth);
  EXPECT_LT(narrow.trueLeft.mean + narrow.trueRight.mean, wide.trueLeft.mean + wide.trueRight.mean - 1.0);
  EXPECT_LT(narrow.left + narrow.right, 6.0);
}

TEST(RoomGuess, WhatLiesBehindANeighboursDoorIsLessLikely) {
  auto around = corridor();
  addDoor(around, 3.0);
  const auto guess = guessRoom(around, kWidth);
  EXPECT_GT(guess.probability.at({15, 0}), 0.8F);
  EXPECT_LT(guess.probability.at({15, 40}), 0.4F);
  EXPECT_LT(guess.trueLeft.mean, 3.5);
}

TEST(RoomGuess, TheWallOfASeenRoomBesideIsItsWall) {
  auto around = corridor();
  addRoom(around, {0.1, 5.0, 2.0, 7.0});
  const auto guess = guessRoom(around, kWidth);
  EXPECT_NEAR(guess.left, 1.9, 0.6);
  EXPECT_LT(guess.trueLeft.deviation, guess.trueRight.deviation);
}

TEST(RoomGuess, ItReachesNoFartherThanWhatIsKnownAhead) {
  auto around = corridor();
  addRoom(around, {3.0, 6.0, -8.0, 8.0});
  const auto guess = guessRoom(around, kWidth);
  for (const auto& corner : guess.outline_here) EXPECT_LT(corner.x(), 2.95);
  EXPECT_GT(guess.depth, 2.0);
  EXPECT_LT(guess.trueDepth.mean, 3.6);
}

TEST(RoomGuess, SeenFloorBehindTheDoorLeavesNothingToGuess) {
  auto around = corridor();
  addRoom(around, {0.1, 4.0, -3.0, 3.0});
  const auto guess = guessRoom(around, kWidth);
  EXPECT_LT(guess.spaceProbability, 0.3);
  EXPECT_LT(guess.expectedArea, guessRoom(corridor(), kWidth).expectedArea);
}

TEST(RoomGuess, AThinGapBehindTheDoorIsNoSpace) {
  auto around = corridor();
  addRoom(around, {0.3, 6.0, -4.0, 4.0});
  const auto guess = guessRoom(around, kWidth);
  EXPECT_LT(guess.spaceProbability, 0.4);
  EXPECT_LT(guess.spaceProbability, guessRoom(corridor(), kWidth).spaceProbability - 0.3);
}

TEST(RoomGuess, AMirrorMirrorsIt) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    auto around = randomWorld(seed);
    around.taken_here.clear();
    const auto guess = guessRoom(around, kWidth);
    const auto other = guessRoom(mirrored(around), kWidth);
    EXPECT_NEAR(guess.trueLeft.mean, other.trueRight.mean, 1e-6);
    EXPECT_NEAR(guess.trueDepth.mean, other.trueDepth.mean, 1e-6);
    EXPECT_NEAR(guess.expectedArea, other.expectedArea, 1e-3);
    EXPECT_NEAR(guess.spaceProbability, other.spaceProbability, 1e-6);
    EXPECT_EQ(guess.probability.at({20, 10}), other.probability.at({20, -11}));
  }
}

TEST(RoomGuess, ContradictsNothingThatIsKnownOrTaken) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const auto around = randomWorld(seed);
    const auto guess = guessRoom(around, kWidth);
    geometry::CellMap<std::uint8_t> inOutline(Surroundings::kBox, 0);
    inOutline.fill(guess.outline_here, 1, Surroundings::kCell);
    geometry::CellMap<std::uint8_t> taken(Surroundings::kBox, 0);
    for (const auto& polygon : around.taken_here) taken.fill(polygon, 1, Surroundings::kCell);
    for (int y = -90; y < 90; ++y) {
      for (int x = -60; x < 120; ++x) {
        const CellIndex cell{x, y};
        const bool isOpen = around.state(cell) == CellState::kUnknown && taken.at(cell) == 0 && x > 0;
        if (isOpen) continue;
        ASSERT_EQ(inOutline.at(cell), 0) << "world " << seed << ", cell " << x << ", " << y;
        ASSERT_EQ(guess.probability.at(cell), 0.0F) << "world " << seed << ", cell " << x << ", " << y;
      }
    }
  }
}

TEST(RoomGuess, TellsProbabilitiesAndFiniteLengthsOfAnyWorld) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const auto guess = guessRoom(randomWorld(seed), kWidth);
    for (const auto& length : {guess.trueLeft, guess.trueRight, guess.trueDepth}) {
      EXPECT_TRUE(length.mean >= 0.0 && length.mean <= 12.0) << length.mean;
      EXPECT_TRUE(length.deviation >= 0.0 && length.deviation <= 6.0) << length.deviation;
    }
    for (const double probability : {guess.expectedIou, guess.spaceProbability}) {
      EXPECT_TRUE(probability >= 0.0 && probability <= 1.0) << probability;
    }
    EXPECT_TRUE(guess.expectedArea >= 0.0 && guess.areaDeviation >= 0.0);
  }
}

TEST(RoomGuess, IsTheSameForTheSameWorld) {
  const auto around = randomWorld(3);
  const auto one = guessRoom(around, kWidth);
  const auto two = guessRoom(around, kWidth);
  EXPECT_EQ(one.outline_here, two.outline_here);
  EXPECT_EQ(one.expectedArea, two.expectedArea);
  EXPECT_EQ(one.expectedIou, two.expectedIou);
}

TEST(RoomGuess, SomeFloorSeenThroughAnOpenDoorIsNotPredictedButPassed) {
  auto around = corridor();
  fill(around, {-0.1, 3.0, -0.4, 0.4}, CellState::kFree);
  const auto guess = guessRoom(around, kWidth);
  EXPECT_EQ(guess.probability.at({10, 0}), 0.0F);
  EXPECT_GT(guess.probability.at({10, 8}), 0.2F);
  EXPECT_FALSE(guess.outline_here.empty());
}

TEST(RoomGuess, ADoorWithoutWidthOrInAWallFindsNoRoom) {
  for (const double width : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const auto guess = guessRoom(corridor(), width);
    EXPECT_TRUE(guess.outline_here.empty());
    EXPECT_EQ(guess.expectedArea, 0.0);
    EXPECT_EQ(guess.spaceProbability, 0.0);
  }
  Surroundings walled;
  fill(walled, {-6.0, 12.0, -9.0, 9.0}, CellState::kOccupied);
  const auto guess = guessRoom(walled, kWidth);
  EXPECT_TRUE(guess.outline_here.empty());
  EXPECT_EQ(guess.expectedArea, 0.0);
  EXPECT_EQ(guess.expectedIou, 0.0);
}

TEST(RoomGuess, OpeningsAtNoPlaceAreHarmless) {
  auto around = corridor();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  around.openings.push_back({.id = {}, .T_here_opening = {nan, nan, nan}, .width = nan, .hasLeaf = true});
  const auto guess = guessRoom(around, kWidth);
  EXPECT_EQ(guess.outline_here, guessRoom(corridor(), kWidth).outline_here);
}

TEST(ReachableFloor, LiesOnTheDoorsSideOfWalls) {
  auto around = corridor();
  fill(around, {2.0, 2.1, -9.0, 9.0}, CellState::kOccupied);
  const auto reached = reachableFloor(around, {{1, -30}, {50, 29}});
  EXPECT_EQ(reached.at({10, 0}), 1);
  EXPECT_EQ(reached.at({20, 0}), 0);
  EXPECT_EQ(reached.at({30, 0}), 0);
}

TEST(WallPlace, TellsQuantilesAndMomentsOfChancesInARow) {
  const WallPlace even(0.5, 4, [](std::size_t bin) { return 1.0 / static_cast<double>(4 - bin); });  // even in 0 … 2 m
  EXPECT_NEAR(even.reaching(0.0), 1.0, 1e-12);
  EXPECT_NEAR(even.reaching(0.75), 0.625, 1e-12);
  EXPECT_EQ(even.reaching(5.0), 0.0);
  EXPECT_NEAR(even.quantile(0.25), 1.5, 1e-9);
  EXPECT_NEAR(even.length().mean, 1.0, 1e-9);
  EXPECT_NEAR(even.length().deviation, 1.0 / std::sqrt(3.0), 1e-9);
}

TEST(WallPlace, ThatIsNowhereLiesAtTheEnd) {
  const WallPlace none(0.5, 4, [](std::size_t) { return 0.0; });
  EXPECT_NEAR(none.quantile(0.5), 2.0, 1e-9);
  EXPECT_NEAR(none.length().mean, 2.0, 1e-9);
}

TEST(BestBox, IsTheRoomWhereThereIsNoDoubt) {
  const UnknownArea all(CellSet(Surroundings::kBox, 1));
  const std::vector<RoomBox> rooms = {{20, 15, 40}, {20, 15, 40}};
  const ExpectedIou expected(rooms, all);
  const RoomBox best = bestBox(expected, {5, 30, 70});
  EXPECT_EQ(best.left, 20);
  EXPECT_EQ(best.right, 15);
  EXPECT_EQ(best.end, 40);
  EXPECT_NEAR(expected.of(best), 1.0, 1e-12);
}

}  // namespace
}  // namespace prodomos::prediction

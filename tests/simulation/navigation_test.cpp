// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/navigation.hpp"

#include "prodomos/base/random.hpp"

#include "simulation/buildings.hpp"
#include "simulation/ways.hpp"
#include "simulation/ways/distance_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prodomos::simulation {
namespace {

constexpr double kClearance = 0.3;

double lengthOf(const Polyline& way) {
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) length += (way[i] - way[i - 1]).norm();
  return length;
}

TEST(DistanceField, AgreesWithEveryObstacleTried) {
  constexpr int kWidth = 37;
  constexpr int kHeight = 23;
  base::Random random(3);
  std::vector<bool> obstacles(kWidth * kHeight);
  for (std::size_t i = 0; i < obstacles.size(); ++i) obstacles[i] = random.uniform() < 0.02;
  obstacles[5] = true;
  const auto distances = distancesTo(kWidth, kHeight, [&](std::size_t cell) { return obstacles[cell]; });
  for (int i = 0; i < kWidth * kHeight; ++i) {
    double least = 1e9;
    for (int j = 0; j < kWidth * kHeight; ++j) {
      if (obstacles[static_cast<std::size_t>(j)]) {
        least = std::min(least, std::hypot(i % kWidth - j % kWidth, i / kWidth - j / kWidth));
      }
    }
    EXPECT_NEAR(static_cast<double>(distances[static_cast<std::size_t>(i)]), least, 1e-4);
  }
}

TEST(FloorGrid, KnowsRoomsDoorsAndWalls) {
  const auto building = test::corridorWithTwoRooms();
  const FloorGrid grid(building, 0, kClearance);
  EXPECT_EQ(grid.roomAt({6.0, 1.0}), 0);
  EXPECT_EQ(grid.roomAt({1.0, 4.0}), 1);
  EXPECT_EQ(grid.roomAt({6.0, 2.1}), kOutside);
  EXPECT_EQ(grid.doorAt({9.0, 2.1}), std::optional<std::size_t>(1));
  EXPECT_EQ(grid.doorAt({6.0, 1.0}), std::nullopt);
  EXPECT_FALSE(grid.isFree({6.0, 2.1}));
  EXPECT_FALSE(grid.isFree({-50.0, 70.0}));
  EXPECT_EQ(grid.distanceToWalls({-50.0, 70.0}), 0.0);
}

TEST(FloorGrid, WhatIsFreeKeepsItsClearance) {
  const auto building = test::corridorWithTwoRooms();
  const FloorGrid grid(building, 0, kClearance);
  const auto walls = test::wallsOf(building, 0);
  base::Random random(7);
  int free = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d point(random.uniform(-0.5, 12.5), random.uniform(-0.5, 6.7));
    const bool isInside = roomAt(building, 0, point) != kOutside || test::isInOpening(building, 0, point);
    const double distance = test::distanceToWalls(walls, point);
    if (grid.isFree(point)) {
      EXPECT_TRUE(isInside) << point.transpose();
      EXPECT_GT(distance, kClearance) << point.transpose();
      ++free;
    } else if (isInside) {
      EXPECT_LT(distance, kClearance + 0.13) << point.transpose();
    }
  }
  EXPECT_GT(free, 800);
}

TEST(FloorGrid, ThingsBlockUnlessTheyHangAboveOrLieFlat) {
  auto building = test::corridorWithTwoRooms();
  test::addThing(building, "desk", {2.0, 1.0}, {0.8, 0.8, 0.75});
  test::addThing(building, "carpet", {5.0, 1.0}, {0.8, 0.8, 0.01});
  test::addThing(building, "lamp", {8.0, 1.0}, {0.8, 0.8, 0.1});
  building.things.back().T_world_thing.translation().z() = 2.5;
  const FloorGrid grid(building, 0, kClearance);
  EXPECT_FALSE(grid.isFree({2.0, 1.0}));
  EXPECT_FALSE(grid.isFree({2.6, 1.0}));
  EXPECT_TRUE(grid.isFree({5.0, 1.0}));
  EXPECT_TRUE(grid.isFree({8.0, 1.0}));
}

TEST(FloorGrid, ATurnedThingBlocksWhereItStands) {
  auto building = test::corridorWithTwoRooms();
  test::addThing(building, "bench", {3.0, 4.2}, {3.0, 0.2, 0.5}, std::numbers::pi / 4.0);
  const FloorGrid grid(building, 0, kClearance);
  EXPECT_FALSE(grid.isFree({3.9, 5.1}));
  EXPECT_TRUE(grid.isFree({3.9, 3.3}));
}

TEST(FloorGrid, StairsAreNoFloor) {
  const auto building = test::officeWithStairs();
  for (const int storey : {0, 1}) {
    const FloorGrid grid(building, storey, kClearance);
    EXPECT_FALSE(grid.isFree({-5.0, 2.2})) << storey;
    EXPECT_TRUE(grid.isFree({-5.0, 0.8})) << storey;
  }
}

TEST(FloorGrid, TheNearestFreePointIsNear) {
  const FloorGrid grid(test::corridorWithTwoRooms(), 0, kClearance);
  const Eigen::Vector2d inside(6.0, 1.0);
  EXPECT_EQ(grid.nearestFree(inside, 1.0), inside);
  const auto moved = grid.nearestFree({6.0, 0.05}, 1.0);
  ASSERT_TRUE(moved);
  EXPECT_TRUE(grid.isFree(*moved));
  EXPECT_NEAR(moved->y(), 0.38, 0.08);
  EXPECT_FALSE(grid.nearestFree({6.0, -5.0}, 1.0));
}

TEST(FloorGrid, APathNeverCrossesAWall) {
  const auto building = test::office();
  const FloorGrid grid(building, 0, kClearance);
  const auto walls = test::wallsOf(building, 0);
  base::Random random(5);
  const auto drawPoint = [&] {
    Eigen::Vector2d point;
    do {
      point = {random.uniform(0.0, 30.0), random.uniform(-4.2, 14.0)};
    } while (!grid.isFree(point));
    return point;
  };
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector2d from = drawPoint();
    const Eigen::Vector2d to = drawPoint();
    const auto way = grid.path(from, to);
    ASSERT_TRUE(way);
    EXPECT_EQ(way->front(), from);
    EXPECT_EQ(way->back(), to);
    for (std::size_t k = 1; k < way->size(); ++k) {
      EXPECT_LE(((*way)[k] - (*way)[k - 1]).norm(), 2.0 * FloorGrid::kStride);
      EXPECT_FALSE(test::crossesWalls(walls, (*way)[k - 1], (*way)[k]));
      EXPECT_GT(test::distanceToWalls(walls, (*way)[k]), kClearance - 0.02);
    }
  }
}

TEST(FloorGrid, APathIsHardlyLongerThanNeeded) {
  const FloorGrid grid(test::corridorWithTwoRooms(), 0, kClearance);
  const auto straight = grid.path({1.0, 1.0}, {11.0, 1.0});
  ASSERT_TRUE(straight);
  EXPECT_NEAR(lengthOf(*straight), 10.0, 0.05);
  // By both jambs, as a rope would lie: 1.1 m to the door's middle each, 6 m along the corridor.
  const auto around = grid.path({3.0, 3.2}, {9.0, 3.2});
  ASSERT_TRUE(around);
  EXPECT_LT(lengthOf(*around), 2.2 + 6.0 + 2.0 * 0.8);
}

TEST(FloorGrid, AClosedDoorCanBeForbidden) {
  const FloorGrid grid(test::corridorWithTwoRooms(), 0, kClearance);
  const Eigen::Vector2d corridor(6.0, 1.0);
  const Eigen::Vector2d room(9.0, 4.0);
  const auto butNot = [](std::size_t closed) { return [closed](std::size_t door) { return door != closed; }; };
  EXPECT_TRUE(grid.path(corridor, room));
  EXPECT_TRUE(grid.path(corridor, room, butNot(0)));
  EXPECT_FALSE(grid.path(corridor, room, butNot(1)));
  EXPECT_FALSE(grid.isFreeLine({9.0, 1.0}, {9.0, 3.0}, butNot(1)));
  EXPECT_TRUE(grid.isFreeLine({9.0, 1.0}, {9.0, 3.0}));
}

TEST(FloorGrid, ADoorToTheOutsideIsAWall) {
  auto building = test::corridorWithTwoRooms();
  building.doors[1].rooms[1] = kOutside;
  const FloorGrid grid(building, 0, kClearance);
  EXPECT_FALSE(grid.isFree({9.0, 2.1}));
}

TEST(FloorGrid, ALeafThatStandsOpenIsInTheWay) {
  auto building = test::corridorWithTwoRooms();
  building.doors[0].swings = {{0.0, std::numbers::pi / 2.0}};
  const FloorGrid grid(building, 0, kClearance);
  // It hangs on the left, seen from the corridor, and opens into the room.
  EXPECT_FALSE(grid.isFree({2.55, 2.8}));
  EXPECT_TRUE(FloorGrid(test::corridorWithTwoRooms(), 0, kClearance).isFree({2.55, 2.8}));
  EXPECT_TRUE(grid.path({3.0, 1.0}, {3.0, 4.0}));
}

TEST(FloorGrid, NoPathToWhereNobodyCanStand) {
  const FloorGrid grid(test::corridorWithTwoRooms(), 0, kClearance);
  EXPECT_FALSE(grid.path({6.0, 1.0}, {6.0, 2.1}));
  EXPECT_FALSE(grid.path({-3.0, 1.0}, {6.0, 1.0}));
}

TEST(FloorGrid, PathsRatherKeepTheirDistance) {
  const auto building = test::corridorWithTwoRooms();
  const FloorGrid grid(building, 0, kClearance);
  const auto way = grid.path({1.0, 0.4}, {11.0, 0.4});
  ASSERT_TRUE(way);
  EXPECT_GT((*way)[way->size() / 2].y(), 0.7);
}

TEST(FloorGrid, SpotsCoverARoomAndLeaveDoorsFree) {
  const auto building = test::office();
  const FloorGrid grid(building, 0, kClearance);
  const auto spots = grid.spots(0, 3.0);
  EXPECT_GE(spots.size(), 6U);
  for (std::size_t i = 0; i < spots.size(); ++i) {
    EXPECT_EQ(grid.roomAt(spots[i]), 0);
    for (std::size_t k = 0; k < i; ++k) EXPECT_GE((spots[i] - spots[k]).norm(), 3.0);
    for (const auto& door : building.doors) {
      EXPECT_GT((spots[i] - Eigen::Vector2d(door.pose.x, door.pose.y)).norm(), 0.75);
    }
  }
  for (double x = 0.5; x < 29.5; x += 0.5) {
    const auto isNear = [&](const Eigen::Vector2d& spot) { return (spot - Eigen::Vector2d(x, 1.0)).norm() < 6.0; };
    EXPECT_TRUE(std::ranges::any_of(spots, isNear)) << x;
  }
}

}  // namespace
}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/prediction/viewpoint.hpp"

#include "prodomos/base/random.hpp"
#include "prodomos/prediction/extrapolation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace prodomos::prediction {
namespace {

using geometry::CellIndex;
using map::CellState;

constexpr double kCell = Surroundings::kCell;
constexpr double kRadius = 0.25;

void fill(Surroundings& near, CellIndex first, CellIndex last, CellState state) {
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) near.set({x, y}, state);
  }
}

/// A corridor 2 m wide before a closed door in its wall.
Surroundings corridor() {
  Surroundings near;
  fill(near, {-20, -60}, {-1, 59}, CellState::kFree);
  fill(near, {0, -60}, {0, 59}, CellState::kOccupied);
  fill(near, {-21, -60}, {-21, 59}, CellState::kOccupied);
  return near;
}

double clearanceOf(const Surroundings& near, const geometry::Pose2& pose) {
  double least = std::numeric_limits<double>::infinity();
  for (int y = -30; y < 30; ++y) {
    for (int x = -30; x < 30; ++x) {
      if (near.state(CellIndex{x, y}) != CellState::kOccupied) continue;
      least = std::min(least, (geometry::centreOf({x, y}, kCell) - Eigen::Vector2d(pose.x, pose.y)).norm());
    }
  }
  return least;
}

TEST(ViewpointBefore, IsStraightBeforeTheDoorWhereThatIsFree) {
  const auto viewpoint = viewpointBefore(corridor(), kRadius);
  ASSERT_TRUE(viewpoint);
  EXPECT_NEAR(viewpoint->x, -0.8, kCell);
  EXPECT_NEAR(viewpoint->y, 0.0, kCell);
  EXPECT_NEAR(viewpoint->theta, 0.0, 0.1) << "faces the door";
}

TEST(ViewpointBefore, KeepsTheRobotOffThings) {
  auto near = corridor();
  fill(near, {-12, -3}, {-5, 4}, CellState::kOccupied);
  const auto viewpoint = viewpointBefore(near, kRadius);
  ASSERT_TRUE(viewpoint);
  EXPECT_GT(clearanceOf(near, *viewpoint), kRadius);
  const double towards = std::atan2(-viewpoint->y, -viewpoint->x);
  EXPECT_NEAR(viewpoint->theta, towards, 1e-9);
}

TEST(ViewpointBefore, SeesTheDoor) {
  auto near = corridor();
  fill(near, {-9, -60}, {-9, -4}, CellState::kOccupied);  // a screen along the corridor, open before the door
  fill(near, {-9, 4}, {-9, 59}, CellState::kOccupied);
  fill(near, {-8, -60}, {-1, 59}, CellState::kUnknown);
  const auto viewpoint = viewpointBefore(near, kRadius);
  ASSERT_TRUE(viewpoint);
  EXPECT_LT(viewpoint->x, -0.8) << "in the gap of the screen or behind it";
  EXPECT_LT(std::abs(viewpoint->y), 0.6);
}

TEST(ViewpointBefore, IsWhereThereIsMostRoomToComeFrom) {
  Surroundings near;
  fill(near, {-20, -12}, {-2, -7}, CellState::kFree);  // a strip apart
  fill(near, {-20, 8}, {-2, 59}, CellState::kFree);
  const auto viewpoint = viewpointBefore(near, kRadius);
  ASSERT_TRUE(viewpoint);
  EXPECT_GT(viewpoint->y, 0.0);
}

TEST(ViewpointBefore, IsNoneWhereNoFloorWasSeenNear) {
  EXPECT_FALSE(viewpointBefore(Surroundings(), kRadius));
  Surroundings far;
  fill(far, {-59, -20}, {-30, 20}, CellState::kFree);
  EXPECT_FALSE(viewpointBefore(far, kRadius));
  EXPECT_FALSE(viewpointBefore(corridor(), 1.5)) << "a robot as wide as that does not fit";
}

TEST(ViewpointBefore, IsFreeAndClearInRandomWorlds) {
  base::Random random(5, "viewpoints");
  int found = 0;
  for (int world = 0; world < 200; ++world) {
    Surroundings near = corridor();
    for (int thing = 0; thing < 6; ++thing) {
      const CellIndex at{static_cast<int>(random.uniform(-20.0, 0.0)), static_cast<int>(random.uniform(-20.0, 20.0))};
      fill(near, at, {at.x + 3, at.y + 3}, thing % 3 == 0 ? CellState::kUnknown : CellState::kOccupied);
    }
    const auto viewpoint = viewpointBefore(near, kRadius);
    if (!viewpoint) continue;
    ++found;
    EXPECT_EQ(near.state(Eigen::Vector2d(viewpoint->x, viewpoint->y)), CellState::kFree);
    EXPECT_GT(clearanceOf(near, *viewpoint), kRadius);
    EXPECT_LE(std::hypot(viewpoint->x, viewpoint->y), 2.0);
  }
  EXPECT_GT(found, 100);
}

map::Entity stairs(double height) {
  map::Entity entity;
  entity.T_submap_entity = geometry::toPose3({4.0, 1.0, std::numbers::pi / 2.0}, height / 2.0);
  entity.attributes = map::Staircase{
      .height = height, .stepWidth = 1.2, .stepHeight = std::abs(height) / 10.0, .stepDepth = 0.3, .stepCount = 10};
  return entity;
}

TEST(TheNearSide, OfStairsIsTheirEndOnTheFloorOfTheSubMap) {
  const double run = *map::runOf(stairs(1.7));
  const auto up = T_submap_near(stairs(1.7));
  EXPECT_TRUE(up.translation().isApprox(Eigen::Vector3d(4.0, 1.0 - run / 2.0, 0.0), 1e-9));
  EXPECT_NEAR(geometry::toPose2(up).theta, std::numbers::pi / 2.0, 1e-9) << "uphill";
  const auto down = T_submap_near(stairs(-1.7));
  EXPECT_TRUE(down.translation().isApprox(Eigen::Vector3d(4.0, 1.0 + run / 2.0, 0.0), 1e-9));
  EXPECT_NEAR(geometry::toPose2(down).theta, -std::numbers::pi / 2.0, 1e-9) << "downhill";
}

TEST(TheNearSide, OfADoorIsToldInTheFrameOfItsLeaf) {
  map::Entity door;
  door.T_submap_entity = geometry::toPose3({1.0, 2.0, 0.5}, 1.0);
  door.attributes = map::Door{.width = 0.9};
  EXPECT_TRUE(T_submap_near(door).isApprox(T_submap_here(door)));
}

}  // namespace
}  // namespace prodomos::prediction

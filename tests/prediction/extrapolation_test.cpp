// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/prediction/extrapolation.hpp"

#include "prodomos/base/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <vector>

namespace prodomos::prediction {
namespace {

using Eigen::Vector2d;
using geometry::CellIndex;
using geometry::Pose2;
using geometry::Pose3;
using map::CellState;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kCell = Surroundings::kCell;

const ExtrapolationConfig kConfig;

map::Entity doorAt(const Pose2& T_submap_door, map::HingeSide hinge = map::HingeSide::kUnknown, double width = 0.9) {
  map::Entity entity;
  entity.id = {7};
  entity.submap = {3};
  entity.T_submap_entity = geometry::toPose3(T_submap_door, 1.0);
  entity.attributes = map::Door{.width = width, .height = 2.0, .hingeSide = hinge};
  entity.points_in_submap = {(entity.T_submap_entity * Eigen::Vector3d(0.0, 0.4, 0.5)).cast<float>()};
  return entity;
}

map::Entity stairsAt(const Pose2& T_submap_stairs, double height, double width = 1.2) {
  map::Entity entity;
  entity.T_submap_entity = geometry::toPose3(T_submap_stairs, height / 2.0);
  entity.attributes =
      map::Staircase{.height = height, .stepWidth = width, .stepHeight = 0.17, .stepDepth = 0.29, .stepCount = 17};
  return entity;
}

PredictedSubMap predict(const map::Entity& entity, const Surroundings& around = {}, const RoomGuess* guess = nullptr,
                        const ExtrapolationConfig& config = kConfig) {
  return std::get<PredictedSubMap>(extrapolate(entity, around, guess, config));
}

std::string refusal(const map::Entity& entity, const Surroundings& around = {}) {
  const auto told = extrapolate(entity, around, nullptr, kConfig);
  const auto* refused = std::get_if<Refusal>(&told);
  return refused == nullptr ? "" : refused->reason;
}

/// Of an area behind the entity, in the frame that its surroundings are told in.
std::set<CellIndex> cellsOf(const map::Entity& entity, const PredictedSubMap& submap, const map::PredictedArea& area) {
  const Pose3 T_here_j = T_submap_here(entity).inverse() * submap.T_i_j;
  const auto cells = geometry::cellsIn(geometry::transformed(T_here_j, area.outline_in_node), kCell);
  return {cells.begin(), cells.end()};
}

double areaOf(const map::PredictedArea& area) {
  return geometry::signedArea(area.outline_in_node);
}

void fillBox(Surroundings& around, const Vector2d& from, const Vector2d& to, CellState state) {
  const auto first = geometry::cellAt(from.x(), from.y(), kCell);
  const auto last = geometry::cellAt(to.x(), to.y(), kCell);
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) around.set({x, y}, state);
  }
}

/// Walls and patches of known floor anywhere, a corridor before the door, and rooms that are taken.
Surroundings randomWorld(base::Random& random) {
  Surroundings around;
  fillBox(around, {-2.0, -8.0}, {-0.15, 8.0}, CellState::kFree);
  for (int i = random.integer(0, 8); i > 0; --i) {
    const Vector2d corner(random.uniform(-1.0, 5.0), random.uniform(-4.0, 4.0));
    const bool isWall = random.uniform() < 0.6;
    const Vector2d size = isWall ? (random.uniform() < 0.5 ? Vector2d(random.uniform(0.0, 4.0), 0.0)
                                                           : Vector2d(0.0, random.uniform(0.0, 4.0)))
                                 : Vector2d(random.uniform(0.1, 2.0), random.uniform(0.1, 2.0));
    fillBox(around, corner, corner + size, isWall ? CellState::kOccupied : CellState::kFree);
  }
  if (random.uniform() < 0.5) {
    const double y = random.uniform(0.5, 2.0);
    around.taken_here.push_back({{0.2, y}, {3.0, y}, {3.0, y + 3.0}, {0.2, y + 3.0}});
  }
  return around;
}

TEST(Extrapolation, OfADoorIsASubMapBehindItOnTheFloor) {
  const auto door = doorAt({2.0, 1.0, std::numbers::pi / 2.0});
  const auto submap = predict(door);
  EXPECT_EQ(submap.kind, map::EdgeKind::kDoor);
  EXPECT_TRUE(submap.T_i_j.translation().isApprox(Eigen::Vector3d(2.0, 1.0 + kConfig.doorDistance, 0.0)));
  EXPECT_NEAR(geometry::yaw(submap.T_i_j), std::numbers::pi / 2.0, 1e-12);
  ASSERT_EQ(submap.areas.size(), 3U);
  EXPECT_NEAR(submap.expectedArea, areaOf(submap.areas.front()), 1e-9);
  for (const auto cell : cellsOf(door, submap, submap.areas.front())) EXPECT_GE(cell.x * kCell, kConfig.wall - 1e-9);
}

TEST(Extrapolation, SharesTheEntityWithItsPoints) {
  const auto door = doorAt({2.0, 1.0, 0.7});
  const auto submap = predict(door);
  const auto& shared = submap.shared_in_j;
  EXPECT_EQ(shared.id, door.id);
  EXPECT_TRUE((submap.T_i_j * shared.T_submap_entity).isApprox(door.T_submap_entity, 1e-9));
  ASSERT_EQ(shared.points_in_submap.size(), 1U);
  EXPECT_TRUE((submap.T_i_j.cast<float>() * shared.points_in_submap[0]).isApprox(door.points_in_submap[0], 1e-5F));
}

TEST(Extrapolation, ADoorsFloorLiesToTheSideOfItsHinge) {
  const auto meanY = [](map::HingeSide hinge) {
    const auto door = doorAt({0.0, 0.0, 0.0}, hinge);
    const auto submap = predict(door);
    const auto cells = cellsOf(door, submap, submap.areas.front());
    double sum = 0.0;
    for (const auto cell : cells) sum += geometry::centreOf(cell, kCell).y();
    return sum / static_cast<double>(cells.size());
  };
  EXPECT_NEAR(meanY(map::HingeSide::kUnknown), 0.0, 1e-9);
  EXPECT_GT(meanY(map::HingeSide::kLeft), 0.2);
  EXPECT_NEAR(meanY(map::HingeSide::kLeft), -meanY(map::HingeSide::kRight), 1e-9);
}

TEST(Extrapolation, MovedAndTurnedFramesMoveTheFloorAndNothingElse) {
  const auto still = predict(doorAt({0.0, 0.0, 0.0}, map::HingeSide::kLeft));
  const Pose2 T_a_b{3.0, -2.0, 2.1};
  const auto moved = predict(doorAt(T_a_b, map::HingeSide::kLeft));
  EXPECT_TRUE(moved.T_i_j.isApprox(geometry::toPose3(T_a_b) * still.T_i_j, 1e-9));
  ASSERT_EQ(moved.areas.size(), still.areas.size());
  for (std::size_t i = 0; i < moved.areas.size(); ++i) {
    EXPECT_EQ(moved.areas[i].outline_in_node, still.areas[i].outline_in_node);
  }
}

TEST(Extrapolation, NothingThatIsKnownTakenOrBehindAWallIsClaimed) {
  base::Random random(2, "worlds behind doors");
  const auto door = doorAt({0.0, 0.0, 0.0});
  for (int world = 0; world < 300; ++world) {
    const auto around = randomWorld(random);
    const auto submap = predict(door, around);
    std::set<CellIndex> before;
    for (const auto& area : submap.areas) {
      const auto cells = cellsOf(door, submap, area);
      EXPECT_GT(areaOf(area), 0.0);
      for (const auto cell : cells) {
        EXPECT_EQ(around.state(cell), CellState::kUnknown);
        for (const auto& room : around.taken_here)
          EXPECT_FALSE(geometry::contains(room, geometry::centreOf(cell, kCell)));
        EXPECT_TRUE(before.empty() || before.contains(cell));
      }
      before = cells;
    }
  }
}

TEST(Extrapolation, NothingBeyondALongWallIsClaimed) {
  base::Random random(3, "long walls");
  const auto door = doorAt({0.0, 0.0, 0.0});
  for (int world = 0; world < 200; ++world) {
    const Vector2d foot(random.uniform(0.5, 2.5), random.uniform(-1.0, 1.0));
    const double angle = random.uniform(-1.2, 1.2);
    const Vector2d normal(std::cos(angle), std::sin(angle));
    if (foot.dot(normal) < 1.0) continue;
    Surroundings around;
    for (double along = -15.0; along < 15.0; along += 0.02) {
      const Vector2d point = foot + along * Vector2d(-normal.y(), normal.x());
      around.set(geometry::cellAt(point.x(), point.y(), kCell), CellState::kOccupied);
    }
    const auto submap = predict(door, around);
    ASSERT_FALSE(submap.areas.empty());
    for (const auto cell : cellsOf(door, submap, submap.areas.front())) {
      EXPECT_LT((geometry::centreOf(cell, kCell) - foot).dot(normal), 0.0);
    }
  }
}

TEST(Extrapolation, AWallHidesWhatLiesBehindIt) {
  Surroundings around;
  fillBox(around, {1.0, -0.6}, {1.0, 9.0}, CellState::kOccupied);
  const auto door = doorAt({0.0, 0.0, 0.0});
  const auto submap = predict(door, around);
  ASSERT_FALSE(submap.areas.empty());
  for (const auto cell : cellsOf(door, submap, submap.areas.front())) {
    const auto centre = geometry::centreOf(cell, kCell);
    // The straight line to the middle of the opening does not cross the wall.
    const double y = centre.y() * (1.0 - kConfig.wall) / std::max(centre.x() - kConfig.wall, 1e-9);
    EXPECT_TRUE(centre.x() < 1.0 || y < -0.4) << centre.transpose();
  }
}

TEST(Extrapolation, BehindADoorThatStoodOpenTheSeenFloorIsLeftOut) {
  Surroundings around;
  for (int x = 0; x < 40; ++x) {
    for (int y = -5 - x / 4; y < 5 + x / 4; ++y) around.set({x, y}, CellState::kFree);
  }
  const auto door = doorAt({0.0, 0.0, 0.0});
  const auto submap = predict(door, around);
  ASSERT_FALSE(submap.areas.empty());
  EXPECT_GT(areaOf(submap.areas.front()), 0.5);
  for (const auto cell : cellsOf(door, submap, submap.areas.front())) {
    EXPECT_EQ(around.state(cell), CellState::kUnknown);
  }
}

TEST(Extrapolation, NothingIsClaimedBehindADoorThatLeadsIntoTheKnown) {
  Surroundings around;
  fillBox(around, {-6.0, -9.0}, {12.0, 9.0}, CellState::kFree);
  EXPECT_TRUE(predict(doorAt({0.0, 0.0, 0.0}), around).areas.empty());
}

TEST(Extrapolation, TheRoomsGuessSaysWhereFloorIsLikelyEnough) {
  RoomGuess guess;
  guess.probability = geometry::CellMap<float>(Surroundings::kBox, 0.0F);
  for (int y = -8; y < 8; ++y) {
    for (int x = 0; x < 30; ++x) *guess.probability.find({x, y}) = x < 10 ? 0.99F : 0.5F;
  }
  guess.outline_here = {{0.2, -0.8}, {3.0, -0.8}, {3.0, 0.8}, {0.2, 0.8}};
  guess.expectedArea = 4.0;
  const auto door = doorAt({1.0, 0.0, 0.5});
  const auto submap = predict(door, {}, &guess);
  EXPECT_DOUBLE_EQ(submap.expectedArea, 4.0);
  ASSERT_EQ(submap.room_in_j.size(), 4U);
  EXPECT_TRUE(submap.room_in_j[1].isApprox(Vector2d(3.0 - kConfig.doorDistance, -0.8)));
  for (const auto cell : cellsOf(door, submap, submap.areas.at(0))) {
    EXPECT_TRUE(cell.x < 10 && cell.y >= -8 && cell.y < 8);
  }
}

TEST(Extrapolation, StairsLeadToTheEndThatWasNotSeen) {
  const double run = 17 * 0.29;
  const auto up = predict(stairsAt({4.0, 0.0, 0.0}, 17 * 0.17));
  EXPECT_EQ(up.kind, map::EdgeKind::kStairs);
  EXPECT_TRUE(up.T_i_j.translation().isApprox(Eigen::Vector3d(4.0 + run / 2.0, 0.0, 17 * 0.17)));
  EXPECT_NEAR(geometry::yaw(up.T_i_j), 0.0, 1e-12);
  const auto down = predict(stairsAt({4.0, 0.0, 0.0}, -17 * 0.17));
  EXPECT_TRUE(down.T_i_j.translation().isApprox(Eigen::Vector3d(4.0 - run / 2.0, 0.0, -17 * 0.17)));
  EXPECT_NEAR(std::abs(geometry::yaw(down.T_i_j)), std::numbers::pi, 1e-12);
}

TEST(Extrapolation, TheFloorBeyondStairsIsHalfTheNormals) {
  const double width = 1.2;
  const auto submap = predict(stairsAt({0.0, 0.0, 0.0}, 3.0, width));
  ASSERT_EQ(submap.areas.size(), 3U);
  const double sigma = kConfig.stairsSigma * width;
  for (const auto& area : submap.areas) {
    const double expected = -std::numbers::pi * sigma * sigma * std::log(area.threshold);
    EXPECT_NEAR(areaOf(area), expected, 0.15 * expected);
  }
}

TEST(Extrapolation, TheRunOfUnmeasuredStepsIsThatOfThePoints) {
  auto entity = stairsAt({0.0, 0.0, 0.0}, 2.0);
  std::get<map::Staircase>(entity.attributes).stepDepth = 0.0;
  entity.points_in_submap = {{-1.0F, 0.0F, 0.0F}, {1.4F, 0.5F, 1.9F}};
  EXPECT_NEAR(predict(entity).T_i_j.translation().x(), 1.2, 1e-6);
}

TEST(Extrapolation, AHumanTellsOfFloorAboutItAndAheadOfIt) {
  map::Entity entity;
  entity.T_submap_entity = geometry::toPose3({1.0, 2.0, 0.0}, 1.0);
  entity.attributes = map::Human{.velocity = {0.0, 1.0, 0.0}};
  const auto floor = std::get<ConditionalFloor>(extrapolate(entity, {}, nullptr, kConfig));
  ASSERT_EQ(floor.strips.size(), 1U);
  const auto& outline = floor.strips[0].at(0).outline_in_node;
  EXPECT_TRUE(geometry::contains(outline, {1.01, 2.01}));
  EXPECT_TRUE(geometry::contains(outline, {1.01, 2.0 + kConfig.horizon}));
  EXPECT_FALSE(geometry::contains(outline, {1.0, 1.0}));
}

TEST(Extrapolation, ObjectsOpenNoSpace) {
  map::Entity entity;
  entity.T_submap_entity.translation().x() = kNan;
  for (const map::EntityAttributes& attributes :
       {map::EntityAttributes(map::ObjectBox{}), map::EntityAttributes(map::Cuboid{}),
        map::EntityAttributes(map::PlanePatch{})}) {
    entity.attributes = attributes;
    EXPECT_TRUE(std::holds_alternative<NothingBeyond>(extrapolate(entity, {}, nullptr, kConfig)));
  }
}

TEST(Extrapolation, WhatMakesNoSenseIsRefusedWithAReason) {
  const Pose2 here{1.0, 0.0, 0.0};
  for (const double width : {0.0, -1.0, kNan, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(refusal(doorAt(here, map::HingeSide::kLeft, width)), "a door without width");
    EXPECT_EQ(refusal(stairsAt(here, 3.0, width)), "a staircase without width of its steps");
  }
  for (const double height : {0.0, kNan}) EXPECT_EQ(refusal(stairsAt(here, height)), "a staircase without height");
  auto lost = doorAt(here);
  lost.T_submap_entity.translation().y() = kNan;
  EXPECT_EQ(refusal(lost), "an entity whose pose is no number");
  auto lying = doorAt(here);
  lying.T_submap_entity.linear() = Eigen::AngleAxisd(std::numbers::pi / 2.0, Eigen::Vector3d::UnitY()).matrix();
  EXPECT_EQ(refusal(lying), "an entity without a heading");
  map::Entity human;
  human.attributes = map::Human{.velocity = {kNan, 0.0, 0.0}};
  EXPECT_EQ(refusal(human), "a human whose velocity is no number");
  human.attributes = map::Human{.velocity = {300.0, 0.0, 0.0}};
  EXPECT_EQ(refusal(human), "a person faster than anyone runs");
  EXPECT_TRUE(T_submap_here(lost).isApprox(Pose3::Identity()));
}

TEST(Extrapolation, AnEntityFarFromItsSubMapIsRefusedUnlessSomethingIsKnownThere) {
  const auto far = doorAt({100.0, 0.0, 0.0});
  EXPECT_EQ(refusal(far), "an entity outside of its sub-map");
  Surroundings around;
  fillBox(around, {-2.0, -1.0}, {-0.2, 1.0}, CellState::kFree);
  EXPECT_EQ(refusal(far, around), "");
}

}  // namespace
}  // namespace prodomos::prediction

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/prediction/walk.hpp"

#include "prodomos/prediction/extrapolation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <variant>
#include <vector>

namespace prodomos::prediction {
namespace {

using Eigen::Vector2d;
using geometry::CellIndex;
using geometry::Pose2;
using map::CellState;

constexpr double kCell = Surroundings::kCell;
constexpr base::SubMapId kHere{1};
constexpr base::SubMapId kThere{2};

const ExtrapolationConfig kConfig;

base::Time at(double seconds) {
  return base::fromNanoseconds(0) + base::fromSeconds(seconds);
}

/// Along the x-axis at 1 m/s from x = `from` on, ten states a second.
Walk straightWalk(double from, double seconds) {
  Walk walk;
  for (int i = 0; i <= static_cast<int>(std::lround(10.0 * seconds)); ++i) {
    walk.states.push_back({at(0.1 * i), {from + 0.1 * i, 0.0, 0.0}, {1.0, 0.0}});
  }
  return walk;
}

void fillBox(Surroundings& around, const Vector2d& from, const Vector2d& to, CellState state) {
  const auto first = geometry::cellAt(from.x(), from.y(), kCell);
  const auto last = geometry::cellAt(to.x(), to.y(), kCell);
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) around.set({x, y}, state);
  }
}

ConditionalFloor floorOf(const Walk& walk, const Surroundings& around = {}) {
  return std::get<ConditionalFloor>(extrapolate(walk, around, kConfig));
}

bool claims(const ConditionalFloor& floor, const Vector2d& point, double threshold = 0.5) {
  for (const auto& strip : floor.strips) {
    for (const auto& area : strip) {
      if (area.threshold == threshold && geometry::contains(area.outline_in_node, point)) return true;
    }
  }
  return false;
}

map::TrackState stateAt(double seconds, double x, base::SubMapId submap = kHere) {
  return {.time = at(seconds),
          .submap = submap,
          .T_submap_thing = geometry::toPose3({x, 0.0, 0.0}, 1.0),
          .velocity_in_submap = Eigen::Vector3d(1.0, 0.0, 0.0)};
}

TEST(Walk, OfATrackIsCutWhereItBreaksOffAndWhereTheSubMapEnds) {
  map::Track track;
  for (const double t : {0.0, 0.5, 1.0}) track.states.push_back(stateAt(t, t));
  for (const double t : {3.0, 3.5}) track.states.push_back(stateAt(t, t));
  for (const double t : {4.0, 4.5}) track.states.push_back(stateAt(t, t, kThere));
  const auto walks = walksOf(track, kHere, -1, true);
  ASSERT_EQ(walks.size(), 2U);
  EXPECT_EQ(walks[0].states.size(), 3U);
  EXPECT_TRUE(walks[0].entered && walks[0].left);
  EXPECT_TRUE(walks[1].entered);
  EXPECT_FALSE(walks[1].left);
  EXPECT_EQ(walks[1].dominantSide, -1);
  const auto there = walksOf(track, kThere, 0, true);
  ASSERT_EQ(there.size(), 1U);
  EXPECT_FALSE(there[0].entered);
  EXPECT_TRUE(there[0].left);
  EXPECT_FALSE(walksOf(track, kThere, 0, false)[0].left);
}

TEST(Walk, ALongWayIsToldInPieces) {
  map::Track track;
  for (int i = 0; i <= 200; ++i) track.states.push_back(stateAt(0.1 * i, 0.1 * i));
  const auto walks = walksOf(track, kHere, 0, true);
  ASSERT_EQ(walks.size(), 3U);
  EXPECT_TRUE(walks[0].entered && !walks[0].left && !walks[1].entered && !walks[1].left && walks[2].left);
}

TEST(Walk, PaceIsThatOfTheFirstAndTheLastSecond) {
  auto walk = straightWalk(0.0, 3.0);
  walk.states.front().velocity_in_submap.setZero();  // a filter that has just begun
  EXPECT_TRUE(paceAtBeginning(walk).isApprox(Vector2d(1.0, 0.0), 1e-6));
  EXPECT_TRUE(paceAtEnd(walk).isApprox(Vector2d(1.0, 0.0), 1e-6));
  walk.states.resize(1);
  EXPECT_EQ(paceAtEnd(walk), Vector2d(0.0, 0.0));
}

TEST(Walk, FloorIsFreeWhereSomebodyWalkedAndWasHiddenBelow) {
  // A desk hides the floor from 1 m to 2 m; all else is seen.
  Surroundings around;
  fillBox(around, {-5.0, -2.0}, {0.95, 2.0}, CellState::kFree);
  fillBox(around, {2.0, -2.0}, {6.0, 2.0}, CellState::kFree);
  fillBox(around, {0.0, -0.8}, {6.0, -0.8}, CellState::kOccupied);
  const auto floor = floorOf(straightWalk(0.0, 3.0), around);
  ASSERT_EQ(floor.strips.size(), 1U);
  EXPECT_TRUE(claims(floor, {1.5, 0.02}));
  EXPECT_FALSE(claims(floor, {0.5, 0.02}));
  EXPECT_FALSE(claims(floor, {2.5, 0.02}));
  EXPECT_FALSE(claims(floor, {1.5, -1.0}));
}

TEST(Walk, IsExtrapolatedForwardsOnLeavingAndBackwardsOnEntering) {
  auto walk = straightWalk(2.0, 2.0);
  const Vector2d ahead(4.0 + 0.9 * kConfig.horizon, 0.02);
  const Vector2d behind(2.0 - 0.9 * kConfig.horizon, 0.02);
  EXPECT_FALSE(claims(floorOf(walk), ahead));
  EXPECT_FALSE(claims(floorOf(walk), behind));
  walk.left = true;
  EXPECT_TRUE(claims(floorOf(walk), ahead));
  EXPECT_FALSE(claims(floorOf(walk), behind));
  walk.entered = true;
  EXPECT_TRUE(claims(floorOf(walk), ahead));
  EXPECT_TRUE(claims(floorOf(walk), behind));
}

TEST(Walk, SeparateStripsAreBetsOfTheirOwn) {
  auto walk = straightWalk(0.0, 2.0);
  walk.entered = walk.left = true;
  Surroundings around;  // all that the person was seen on is known
  fillBox(around, {-0.7, -2.0}, {2.7, 2.0}, CellState::kFree);
  const auto floor = floorOf(walk, around);
  ASSERT_EQ(floor.strips.size(), 2U);
  for (const auto& strip : floor.strips) EXPECT_EQ(strip.size(), 3U);
}

TEST(Walk, EndsAtAWall) {
  auto walk = straightWalk(0.0, 2.0);
  walk.left = true;
  Surroundings around;
  fillBox(around, {2.6, -3.0}, {2.6, 3.0}, CellState::kOccupied);
  const auto floor = floorOf(walk, around);
  EXPECT_TRUE(claims(floor, {2.3, 0.02}));
  EXPECT_FALSE(claims(floor, {2.8, 0.02}));
}

TEST(Walk, WhoStandsIsExtrapolatedNowhere) {
  Walk walk{.entered = true, .left = true};
  for (int i = 0; i < 20; ++i) walk.states.push_back({at(0.1 * i), {0.01 * i, 0.0, 0.0}, {0.1, 0.0}});
  const auto floor = floorOf(walk);
  EXPECT_TRUE(claims(floor, {0.1, 0.02}));
  EXPECT_FALSE(claims(floor, {1.0, 0.02}));
}

TEST(Walk, TheWiderSideIsThatAwayFromTheDominantOne) {
  for (const int side : {-1, 1}) {
    auto walk = straightWalk(0.0, 2.0);
    walk.dominantSide = side;
    double balance = 0.0;
    for (const auto cell : geometry::cellsIn(floorOf(walk).strips.at(0).at(0).outline_in_node, kCell)) {
      balance += geometry::centreOf(cell, kCell).y();
    }
    EXPECT_GT(balance * side, 0.5);  // of one whose right side is dominant, to the left
  }
}

TEST(Walk, MovesWithTheFrameOfItsSubMap) {
  auto walk = straightWalk(1.0, 2.0);
  walk.dominantSide = 1;
  walk.left = true;
  const auto still = floorOf(walk);
  const Pose2 T_a_b{-3.0, 1.0, 0.8};
  for (auto& state : walk.states) {
    state.T_submap_person = T_a_b * state.T_submap_person;
    state.velocity_in_submap = Eigen::Rotation2Dd(T_a_b.theta) * state.velocity_in_submap;
  }
  const auto moved = floorOf(walk);
  ASSERT_EQ(moved.strips.size(), still.strips.size());
  const auto expected = geometry::transformed(T_a_b, still.strips[0][0].outline_in_node);
  EXPECT_NEAR(geometry::signedArea(moved.strips[0][0].outline_in_node), geometry::signedArea(expected), 0.1);
  std::size_t differing = 0;
  for (const auto cell : geometry::cellsIn(expected)) {
    differing += geometry::contains(moved.strips[0][0].outline_in_node, geometry::centreOf(cell)) ? 0 : 1;
  }
  EXPECT_LT(differing, 20U);
}

TEST(Walk, NumbersThatAreNoneAreRefused) {
  EXPECT_TRUE(std::holds_alternative<Refusal>(extrapolate(Walk{}, Surroundings(), kConfig)));
  auto walk = straightWalk(0.0, 1.0);
  walk.states[3].T_submap_person.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::holds_alternative<Refusal>(extrapolate(walk, Surroundings(), kConfig)));
  EXPECT_TRUE(T_submap_here(walk).isApprox(geometry::Pose3::Identity()));
  walk = straightWalk(0.0, 1.0);
  walk.states.back().velocity_in_submap.y() = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::holds_alternative<Refusal>(extrapolate(walk, Surroundings(), kConfig)));
}

}  // namespace
}  // namespace prodomos::prediction

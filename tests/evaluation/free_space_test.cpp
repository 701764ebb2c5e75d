// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/free_space.hpp"

#include "evaluation/small_building.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace prodomos::evaluation {
namespace {

using test::at;
using test::freeRectangle;
using test::rectangle;

struct FreeSpace : testing::Test {
  Truth truth = test::smallBuilding();
  Claims claims = test::perfectClaims();
  std::vector<KnownGrid> grids = {freeRectangle(0, 0, 10, 2)};

  FreeSpaceScore score() const { return scoreFreeSpace(makeScene(truth, claims, KnownSpace(grids))); }
  FreeSpaceLevel level() const { return score().levels[0]; }
  void predict(std::size_t space, const Polygon& area) { claims.spaces[space].areas_in_world[0.5] = area; }
};

TEST_F(FreeSpace, OfNothingIsNoMeasure) {
  EXPECT_FALSE(level().overall().precision());
  EXPECT_FALSE(level().areaPerDoor());
  EXPECT_FALSE(level().halfDiscPrecision());
  EXPECT_FALSE(score().areaGainPercent(0));
  predict(0, rectangle(1, 3, 3, 5));
  EXPECT_TRUE(score().areaGainPercent(0));
  EXPECT_FALSE(score().areaGainPercent(1));  // at another threshold
  grids.clear();
  EXPECT_FALSE(score().areaGainPercent(0));
}

TEST_F(FreeSpace, InARoomIsRightInAWallAndOutsideIsWrong) {
  predict(0, rectangle(1, 3, 3, 5));
  EXPECT_EQ(level().overall().precision(), 1.0);
  predict(0, rectangle(1, 5.2, 3, 7.2));  // half of it beyond the wall
  EXPECT_NEAR(*level().overall().precision(), 0.5, 1e-9);
  predict(0, rectangle(3, 3, 6, 4));  // 1 m of 3 lies between A and B
  EXPECT_NEAR(*level().overall().precision(), 2.0 / 3.0, 1e-9);
}

TEST_F(FreeSpace, InALeafIsWrongInItsOpeningRight) {
  predict(0, rectangle(1.8, 2.0, 2.2, 2.2));
  EXPECT_NEAR(*level().overall().precision(), 0.75, 1e-9);  // one row of four
  truth.doors[0].states = {{at(0), 1.5, map::DoorState::kOpen}};
  EXPECT_EQ(level().overall().precision(), 1.0);
}

TEST_F(FreeSpace, CountsWhatWasUnknownWhenItWasPredicted) {
  predict(0, rectangle(1, 1, 3, 3));  // 2 m² in the corridor, 0.4 in the wall, 1.6 in the room
  const double opening = 0.9 * 0.15;  // without the leaf's row
  EXPECT_NEAR(*level().overall().precision(), (1.6 + opening) / 2.0, 0.01);
  grids.push_back(freeRectangle(0, 2.2, 4, 6.2, at(4)));
  EXPECT_NEAR(*level().overall().precision(), opening / 0.4, 0.02);
  grids.back().since = at(6);  // seen later: it counts
  EXPECT_NEAR(*level().overall().precision(), (1.6 + opening) / 2.0, 0.01);
}

TEST_F(FreeSpace, IsCountedByWhatCausedIt) {
  claims.spaces.push_back(test::claimedSpace(4, 4));
  claims.spaces[3].mobility = map::Mobility::kDynamic;
  predict(0, rectangle(1, 3, 3, 5));
  predict(2, rectangle(-4, 1, -3, 3));    // upstairs, half of it right
  predict(3, rectangle(20, 20, 21, 21));  // outside
  const auto at = level().byMobility;
  EXPECT_EQ(at[0].precision(), 0.5);
  EXPECT_EQ(at[1].precision(), 1.0);
  EXPECT_EQ(at[2].precision(), 0.0);
  EXPECT_NEAR(*level().overall().precision(), 5.0 / 7.0, 1e-9);
}

TEST_F(FreeSpace, AtNoKnownStoreyIsNotJudged) {
  predict(2, rectangle(-4, 0, -3, 1));
  claims.spaces[2].storey.reset();
  EXPECT_FALSE(level().overall().precision());
}

TEST_F(FreeSpace, HasThresholdsOfItsOwn) {
  predict(0, rectangle(1, 5.2, 3, 7.2));
  claims.spaces[0].areas_in_world[0.7] = rectangle(1, 3, 3, 5);
  EXPECT_NEAR(*score().levels[0].overall().precision(), 0.5, 1e-9);
  EXPECT_FALSE(score().levels[1].overall().precision());
  EXPECT_EQ(score().levels[2].overall().precision(), 1.0);
}

TEST_F(FreeSpace, GainsWhatIsKnownByPredictionAlone) {
  predict(0, rectangle(1, 3, 3, 5));
  predict(1, rectangle(2, 3, 4, 5));  // overlaps the first
  EXPECT_NEAR(*score().areaGainPercent(0), 100.0 * 6.0 / 20.0, 1e-6);
  EXPECT_NEAR(*level().areaPerDoor(), 4.0, 1e-6);
  claims.spaces[1].state = map::PredictionState::kRefuted;
  EXPECT_NEAR(*score().areaGainPercent(0), 100.0 * 4.0 / 20.0, 1e-6);
  grids.push_back(freeRectangle(1, 3, 3, 5, at(9)));
  EXPECT_EQ(score().areaGainPercent(0), 0.0);
}

TEST_F(FreeSpace, IsLessWhereItIsFurnished) {
  truth.objects = {{.size = {1, 2, 1}, .poses = {{at(0), geometry::toPose3({1.5, 4, 0}, 0.5)}}}};
  predict(0, rectangle(1, 3, 3, 5));
  EXPECT_EQ(level().overall().precision(), 1.0);
  EXPECT_NEAR(*level().overall().furnishedPrecision(), 0.5, 1e-9);
}

TEST_F(FreeSpace, IsHeldAgainstHalfDiscsOfEqualArea) {
  // A box of the area of a half-disc of 2 m, that lies in room A but for its wall.
  predict(0, rectangle(0.5, 2.2, 3.5, 4.3));
  const auto at = level();
  const double radius = 2.03;  // from 0.1 m beyond the leaf on
  std::size_t right = 0;
  std::size_t all = 0;
  const GroundPlan plan(truth, 0);
  for (int y = 44; y < 100; ++y) {
    for (int x = -10; x < 90; ++x) {
      if ((centreOf({x, y}) - Eigen::Vector2d(2, 2.1)).norm() > radius) continue;
      ++all;
      if (plan.isFloor({x, y}, test::at(5))) ++right;
    }
  }
  EXPECT_NEAR(static_cast<double>(all) * kCell * kCell, 6.3, 0.3);
  EXPECT_NEAR(*at.halfDiscPrecision(), static_cast<double>(right) / static_cast<double>(all), 0.02);
  EXPECT_LT(*at.halfDiscPrecision(), 1.0 + 1e-9);
}

TEST_F(FreeSpace, DoesNotDependOnOrderAndAddsUp) {
  predict(0, rectangle(1, 5.2, 3, 7.2));
  predict(1, rectangle(6, 3, 8, 5));
  auto sum = score();
  const double precision = *sum.levels[0].overall().precision();
  std::ranges::reverse(claims.spaces);
  EXPECT_EQ(level().overall().precision(), precision);
  sum += score();
  EXPECT_EQ(sum.levels[0].overall().precision(), precision);
  EXPECT_EQ(sum.areaGainPercent(0), score().areaGainPercent(0));
  EXPECT_EQ(sum.levels[0].areaPerDoor(), level().areaPerDoor());
}

TEST_F(FreeSpace, IsNearlyTheSameInATurnedWorld) {
  predict(0, rectangle(1, 2.0, 3, 7.2));
  const double before = *level().overall().precision();
  const geometry::Pose2 T_new_old{3, -2, 0.4};
  for (auto& room : truth.rooms) room.outline = transformed(T_new_old, room.outline);
  for (auto& door : truth.doors) door.T_world_door = geometry::toPose3(T_new_old) * door.T_world_door;
  for (auto& door : claims.doors) door.T_world_door = T_new_old * door.T_world_door;
  for (auto& grid : grids) grid.T_world_grid = T_new_old;
  predict(0, transformed(T_new_old, claims.spaces[0].areas_in_world[0.5]));
  EXPECT_NEAR(*level().overall().precision(), before, 0.02);
}

}  // namespace
}  // namespace prodomos::evaluation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/doorway_detector.hpp"

#include "prodomos/base/random.hpp"
#include "prodomos/geometry/pose.hpp"

#include "perception/doorway_lines.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace prodomos::perception {
namespace {

using geometry::Pose2;

/// Boxes on a floor, as a level laser that turns all around sees them.
class Plan {
 public:
  explicit Plan(const Pose2& T_world_plan = {}) : T_world_plan_(T_world_plan) {}

  /// Between two corners.
  void addBox(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const std::array corners{a, Eigen::Vector2d(b.x(), a.y()), b, Eigen::Vector2d(a.x(), b.y())};
    for (std::size_t i = 0; i < 4; ++i) {
      sides_.emplace_back(T_world_plan_ * corners[i], T_world_plan_ * corners[(i + 1) % 4]);
    }
  }
  Eigen::Vector2d inWorld(const Eigen::Vector2d& point_in_plan) const { return T_world_plan_ * point_in_plan; }

  void scanInto(map::OccupancyGrid& grid, const Eigen::Vector2d& point_in_plan, base::Random& random) const {
    constexpr int kBeams = 900;
    constexpr double kNoise = 0.01;
    const Eigen::Vector2d origin = inWorld(point_in_plan);
    std::vector<map::OccupancyGrid::Beam> beams;
    for (int i = 0; i < kBeams; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kBeams;
      const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
      const double range = rangeOf(origin, direction);
      const bool hit = std::isfinite(range);
      beams.push_back({origin + direction * (hit ? random.normal(range, kNoise) : 5.0), hit});
    }
    grid.insert(origin, beams);
  }

 private:
  double rangeOf(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& [from, to] : sides_) {
      const Eigen::Vector2d side = to - from;
      const Eigen::Vector2d offset = from - origin;
      const double determinant = direction.x() * side.y() - direction.y() * side.x();
      if (std::abs(determinant) < 1e-9) continue;
      const double range = (offset.x() * side.y() - offset.y() * side.x()) / determinant;
      const double along = (offset.x() * direction.y() - offset.y() * direction.x()) / determinant;
      if (range > 0.0 && along >= 0.0 && along <= 1.0) nearest = std::min(nearest, range);
    }
    return nearest;
  }

  Pose2 T_world_plan_;
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> sides_;
};

/// Two rooms of 5 m by 4 m; the wall between them, from y = -thickness/2 to thickness/2, has its gap at x.
Plan twoRooms(const Pose2& T_world_plan, double left, double right, double thickness = 0.16) {
  Plan plan(T_world_plan);
  const double half = 0.5 * thickness;
  plan.addBox({-2.7, -4.2}, {-2.5, 4.2});
  plan.addBox({2.5, -4.2}, {2.7, 4.2});
  plan.addBox({-2.5, -4.2}, {2.5, -4.0});
  plan.addBox({-2.5, 4.0}, {2.5, 4.2});
  if (left > -2.5) plan.addBox({-2.5, -half}, {left, half});
  if (right < 2.5) plan.addBox({right, -half}, {2.5, half});
  return plan;
}

/// What a robot knows that looked about at these places.
map::OccupancyGrid gridOf(const Plan& plan, const std::vector<Eigen::Vector2d>& places, int looks = 4) {
  map::OccupancyGrid grid;
  base::Random random(1, "doorway test");
  for (const auto& place : places) {
    for (int i = 0; i < looks; ++i) plan.scanInto(grid, place + Eigen::Vector2d(0.11 * i, 0.07 * i), random);
  }
  return grid;
}

const std::vector<Eigen::Vector2d> kBothSides{{-1.0, -2.0}, {0.0, -1.0}, {0.1, 1.2}, {1.0, 2.5}};

std::vector<DoorSighting> doorwaysIn(const Plan& plan, const std::vector<Eigen::Vector2d>& places) {
  return findDoorways(gridOf(plan, places), plan.inWorld(places.front()), {});
}

TEST(DoorwayDetector, FindsAGapBetweenCollinearWallsInAnyDirection) {
  for (const double yaw : {0.0, 0.2, 0.5, 0.8, 1.3, 2.4, -1.0}) {
    const Pose2 T_world_plan{3.0, -7.0, yaw};
    const auto plan = twoRooms(T_world_plan, -0.45, 0.45);
    const auto found = doorwaysIn(plan, kBothSides);
    ASSERT_EQ(found.size(), 1U) << yaw;
    const Pose2 T_plan_door = geometry::inverse(T_world_plan) * geometry::toPose2(found.front().T_submap_door);
    EXPECT_NEAR(T_plan_door.x, 0.0, 0.05) << yaw;
    EXPECT_NEAR(T_plan_door.y, 0.0, 0.08) << yaw;
    EXPECT_NEAR(T_plan_door.theta, 0.5 * std::numbers::pi, 0.04) << "away from the observer, " << yaw;
    EXPECT_NEAR(found.front().door.width, 0.9, 0.07) << yaw;
    EXPECT_FALSE(found.front().door.hasLeaf);
    EXPECT_GT(found.front().evidence, 0.0);
    EXPECT_GT(found.front().covariance.diagonal().minCoeff(), 0.0);
  }
}

TEST(DoorwayDetector, ItsNormalPointsAwayFromWhoStandsOnTheOtherSide) {
  const auto plan = twoRooms({}, -0.45, 0.45);
  const auto found = findDoorways(gridOf(plan, kBothSides), {1.0, 3.0}, {});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found.front().T_submap_door.linear()(1, 0), -1.0, 0.01);
}

TEST(DoorwayDetector, FindsGapsInThinAndThickWalls) {
  for (const double thickness : {0.1, 0.2, 0.3}) {
    const auto found = doorwaysIn(twoRooms({}, -0.3, 0.7, thickness), kBothSides);
    ASSERT_EQ(found.size(), 1U) << thickness;
    EXPECT_NEAR(found.front().T_submap_door.translation().x(), 0.2, 0.05) << thickness;
  }
}

TEST(DoorwayDetector, FindsAGapBesideAPerpendicularWall) {
  const auto found = doorwaysIn(twoRooms({}, -2.38, -1.48), {{-1.0, -2.0}, {-1.9, -1.0}, {-1.8, 1.2}, {1.0, 2.5}});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found.front().T_submap_door.translation().x(), -1.93, 0.05);
}

TEST(DoorwayDetector, FindsWhereACorridorOpensIntoAHall) {
  Plan plan;  // a corridor of 2 m with a nib of 12 cm on both sides where the hall begins
  plan.addBox({-8.0, 1.0}, {0.0, 1.15});
  plan.addBox({-8.0, -1.15}, {0.0, -1.0});
  plan.addBox({-0.17, 0.88}, {0.0, 4.0});
  plan.addBox({-0.17, -4.0}, {0.0, -0.88});
  plan.addBox({6.0, -4.0}, {6.2, 4.0});
  const auto found = doorwaysIn(plan, {{-3.0, 0.0}, {-1.5, 0.2}, {1.0, 0.0}, {2.0, 1.0}});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found.front().T_submap_door.translation().x(), -0.085, 0.08);
  EXPECT_NEAR(found.front().door.width, 1.76, 0.08);
}

TEST(DoorwayDetector, FindsAGapThatLiesAskewBetweenWallsThatAreNotInOneLine) {
  Plan plan;  // two walls across a hall, 0.35 m apart in depth: where a corridor bends
  plan.addBox({-3.2, -4.0}, {-3.0, 4.0});
  plan.addBox({3.0, -4.0}, {3.2, 4.0});
  plan.addBox({-3.0, -0.08}, {-0.5, 0.08});
  plan.addBox({0.5, 0.27}, {3.0, 0.43});
  const auto found = doorwaysIn(plan, kBothSides);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found.front().T_submap_door.translation().x(), 0.0, 0.1);
  EXPECT_NEAR(found.front().T_submap_door.translation().y(), 0.17, 0.12);
  EXPECT_NEAR(geometry::yaw(found.front().T_submap_door), 0.5 * std::numbers::pi + std::atan2(0.35, 1.0), 0.25);
  EXPECT_NEAR(found.front().door.width, 1.05, 0.12);
}

TEST(DoorwayDetector, TheWayFromCornerToCornerIsNone) {
  Plan plan;  // two rooms that share a corner of free floor: their walls do not lead to the gap
  plan.addBox({-4.0, -4.0}, {-0.4, -0.4});
  plan.addBox({0.4, 0.4}, {4.0, 4.0});
  EXPECT_TRUE(doorwaysIn(plan, {{-2.0, 2.0}, {-0.6, 0.8}, {0.6, -0.8}, {2.0, -2.0}}).empty());
}

TEST(DoorwayDetector, CriticalLinesLieWhereTheSpaceIsNarrowest) {
  const Pose2 T_world_plan{1.0, 2.0, 0.4};
  const auto grid = gridOf(twoRooms(T_world_plan, -0.45, 0.45), kBothSides);
  const auto lines = doorways::criticalLines(grid, {});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NEAR((lines.front().middle() - Eigen::Vector2d(1.0, 2.0)).norm(), 0.0, 0.12);
  EXPECT_NEAR(lines.front().width(), 0.9, 0.1);
  EXPECT_TRUE(doorways::criticalLines(map::OccupancyGrid(), {}).empty());
}

TEST(DoorwayDetector, ADoorThatStandsOpenIsAnOpening) {
  auto plan = twoRooms({}, -0.45, 0.45);
  plan.addBox({0.41, 0.08}, {0.45, 0.95});  // the leaf, at 90 degrees
  const auto found = doorwaysIn(plan, kBothSides);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_FALSE(found.front().door.hasLeaf) << "a grid does not tell a leaf from a wall";
}

TEST(DoorwayDetector, AClosedWallHasNone) {
  EXPECT_TRUE(doorwaysIn(twoRooms({}, 2.5, 2.5), kBothSides).empty());
}

TEST(DoorwayDetector, ANicheIsNone) {
  auto plan = twoRooms({}, -0.45, 0.45, 0.3);
  plan.addBox({-0.6, 0.45}, {0.6, 0.6});
  EXPECT_TRUE(doorwaysIn(plan, {{-1.0, -2.0}, {0.0, -1.0}, {0.4, -1.5}}).empty());
}

TEST(DoorwayDetector, ACorridorIsNone) {
  Plan plan;
  plan.addBox({-10.0, 1.0}, {10.0, 1.2});
  plan.addBox({-10.0, -1.2}, {10.0, -1.0});
  EXPECT_TRUE(doorwaysIn(plan, {{-3.0, 0.0}, {0.0, 0.1}, {3.0, 0.0}}).empty());
}

TEST(DoorwayDetector, ACupboardInACorridorMakesNone) {
  Plan plan;
  plan.addBox({-10.0, 1.0}, {10.0, 1.2});
  plan.addBox({-10.0, -1.2}, {10.0, -1.0});
  plan.addBox({-0.2, 0.6}, {0.2, 1.0});
  plan.addBox({2.0, -1.0}, {3.0, -0.6});
  EXPECT_TRUE(doorwaysIn(plan, {{-3.0, 0.0}, {0.0, 0.1}, {3.0, 0.0}, {5.0, 0.0}}).empty());
}

TEST(DoorwayDetector, GapsBetweenFurniturePillarsAndLegsAreNone) {
  auto plan = twoRooms({}, 2.5, 2.5);
  plan.addBox({-1.6, -2.2}, {-0.5, -2.0});  // shelves that stand free, in one line
  plan.addBox({0.4, -2.2}, {1.5, -2.0});
  plan.addBox({-0.2, -3.2}, {0.0, -3.0});  // pillars and legs
  plan.addBox({0.7, -3.2}, {0.9, -3.0});
  plan.addBox({-1.2, -1.0}, {-1.15, -0.95});
  EXPECT_TRUE(doorwaysIn(plan, {{-1.0, -1.4}, {0.0, -1.0}, {0.2, -2.6}, {1.8, -3.5}}).empty());
}

TEST(DoorwayDetector, WhatNobodyLookedThroughIsNone) {
  auto plan = twoRooms({}, -0.45, 0.45);
  plan.addBox({-0.6, -0.2}, {0.6, -0.12});  // something stands before it
  EXPECT_TRUE(doorwaysIn(plan, {{-1.0, -2.0}, {0.0, -1.0}}).empty());
}

TEST(DoorwayDetector, FindsAGapBetweenWallsThatAreNearlyInOneLine) {
  Plan plan;
  plan.addBox({-3.2, -4.2}, {-3.0, 4.2});
  plan.addBox({3.0, -4.2}, {3.2, 4.2});
  plan.addBox({-3.2, 4.0}, {3.2, 4.2});
  plan.addBox({-3.2, -4.2}, {3.2, -4.0});
  plan.addBox({-3.0, -0.12}, {-0.7, 0.13});
  plan.addBox({0.7, 0.02}, {3.0, 0.27});
  const auto found = doorwaysIn(plan, kBothSides);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found.front().T_submap_door.translation().x(), 0.0, 0.08);
  EXPECT_NEAR(found.front().door.width, 1.4, 0.1);
}

TEST(DoorwayDetector, AGapBehindWhichBeamsReturnFromNothingIsAWindow) {
  Plan plan;  // a room of 5 m by 4 m, and outside nothing at all
  plan.addBox({-2.7, -4.2}, {-2.5, 0.08});
  plan.addBox({2.5, -4.2}, {2.7, 0.08});
  plan.addBox({-2.5, -4.2}, {2.5, -4.0});
  plan.addBox({-2.5, -0.08}, {-0.45, 0.08});
  plan.addBox({0.45, -0.08}, {2.5, 0.08});
  EXPECT_TRUE(doorwaysIn(plan, kBothSides).empty());
  plan.addBox({-4.0, 5.0}, {4.0, 5.2});  // a house across the street
  EXPECT_EQ(doorwaysIn(plan, kBothSides).size(), 1U);
}

const Pose2 kInTheMiddle{0.0, 0.0, 0.5 * std::numbers::pi};

TEST(ShowsNoDoorway, AWallThatGoesOnBesideTheGapRefutesIt) {
  Plan corridor;  // 2 m wide, and where its frame was taken for one there is none
  corridor.addBox({-1.2, -6.0}, {-1.0, 6.0});
  corridor.addBox({1.0, -6.0}, {1.2, 6.0});
  EXPECT_TRUE(showsNoDoorway(gridOf(corridor, {{0.0, -2.0}, {0.0, 2.0}}), kInTheMiddle, 2.0));
}

TEST(ShowsNoDoorway, AJambThatIsNotThereRefutesIt) {
  EXPECT_TRUE(showsNoDoorway(gridOf(twoRooms({}, -0.45, 1.45), kBothSides), kInTheMiddle, 0.9));
  EXPECT_FALSE(showsNoDoorway(gridOf(twoRooms({}, 2.5, 2.5), kBothSides), kInTheMiddle, 0.9)) << "it may be closed now";
}

TEST(ShowsNoDoorway, WhatIsSeenFromOneSideAloneTellsNothing) {
  const auto plan = twoRooms({}, -0.45, 0.45);
  EXPECT_FALSE(showsNoDoorway(gridOf(plan, {{0.0, -2.0}}), kInTheMiddle, 0.9));
}

TEST(ShowsNoDoorway, WhatIsSeenOnAllSidesAndWasNotFoundIsNone) {
  const Pose2 T_world_plan{3.0, -7.0, 0.5};
  const auto grid = gridOf(twoRooms(T_world_plan, -0.45, 0.45), kBothSides);
  EXPECT_TRUE(showsNoDoorway(grid, T_world_plan * kInTheMiddle, 0.9));
}

TEST(ShowsNoDoorway, WhereNothingIsKnownNothingIsTold) {
  EXPECT_FALSE(showsNoDoorway(map::OccupancyGrid(), kInTheMiddle, 0.9));
  EXPECT_FALSE(showsNoDoorway(gridOf(twoRooms({}, -0.45, 0.45), kBothSides), {50.0, 0.0, 0.0}, 0.9));
}

TEST(DoorwayDetector, TheConfigurationRules) {
  const auto plan = twoRooms({}, -0.45, 0.45);
  const auto grid = gridOf(plan, kBothSides);
  EXPECT_TRUE(findDoorways(grid, {}, {.enabled = false}).empty());
  EXPECT_TRUE(findDoorways(grid, {}, {.leastWidth = 1.2}).empty());
  EXPECT_TRUE(findDoorways(grid, {}, {.mostWidth = 0.7}).empty());
}

TEST(DoorwayDetector, AnEmptyGridHasNone) {
  EXPECT_TRUE(findDoorways(map::OccupancyGrid(), {}, {}).empty());
  map::OccupancyGrid one;
  const std::vector<map::OccupancyGrid::Beam> beams{{{1.0, 0.0}, true}};
  one.insert({0.0, 0.0}, beams);
  EXPECT_TRUE(findDoorways(one, {}, {}).empty());
}

}  // namespace
}  // namespace prodomos::perception

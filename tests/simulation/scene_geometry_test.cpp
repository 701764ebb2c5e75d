// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scenes/scene_geometry.hpp"

#include "prodomos/base/random.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace prodomos::simulation {
namespace {

using testing::SizeIs;

/// An L of 4 x 4 m that lacks a square of 2 m at its upper right.
const Polygon kCorner{{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}};

Polygon square(double x, double y, double side) {
  return {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
}

Footprint randomFootprint(base::Random& random) {
  return {{random.uniform(-1.0, 5.0), random.uniform(-1.0, 5.0)},
          random.uniform(-4.0, 4.0),
          {random.uniform(0.1, 2.0), random.uniform(0.1, 2.0)}};
}

/// Points of a rectangle, its rim left out.
std::vector<Eigen::Vector2d> pointsOf(const Footprint& footprint) {
  constexpr int kSteps = 60;
  const auto corners = footprint.corners();
  std::vector<Eigen::Vector2d> points;
  for (int i = 1; i < kSteps; ++i) {
    for (int j = 1; j < kSteps; ++j) {
      points.emplace_back(corners[0] + (corners[1] - corners[0]) * i / kSteps + (corners[3] - corners[0]) * j / kSteps);
    }
  }
  return points;
}

TEST(SceneGeometry, AnInsetOutlineIsThatFarFromAllWalls) {
  const auto inset = insetBy(kCorner, 0.25);
  ASSERT_THAT(inset, SizeIs(6));
  EXPECT_NEAR(signedArea(inset), 3.5 * 1.5 + 1.5 * 2.0, 1e-12);
  for (const auto& corner : inset) {
    double least = 1e9;
    for (const auto& wall : wallsOf(kCorner)) least = std::min(least, distanceToSegment(corner, wall.from, wall.to));
    EXPECT_GE(least, 0.25 - 1e-12);
  }
  const auto slanted = insetBy({{0, 0}, {4, 1}, {1, 3}}, 0.1);
  for (const auto& wall : wallsOf({{0, 0}, {4, 1}, {1, 3}})) {
    double nearest = 1e9;
    for (const auto& corner : slanted) nearest = std::min(nearest, wall.inward().dot(corner - wall.from));
    EXPECT_NEAR(nearest, 0.1, 1e-12);
  }
}

TEST(SceneGeometry, TidyOutlinesTurnLeftAndHaveRealCorners) {
  Polygon given{{0, 0}, {0, 1}, {0, 2}, {1, 2}, {2, 2}, {2, 0}, {1, 0}};
  const auto tidy = tidied(given);
  EXPECT_THAT(tidy, SizeIs(4));
  EXPECT_DOUBLE_EQ(signedArea(tidy), 4.0);
}

TEST(SceneGeometry, NeighboursOverlapOnlyWhereTheyShareArea) {
  EXPECT_FALSE(overlap(kCorner, square(2, 2, 2))) << "it fills the corner";
  EXPECT_TRUE(overlap(kCorner, square(1.9, 1.9, 2)));
  EXPECT_TRUE(overlap(kCorner, square(0.5, 0.5, 0.5))) << "within";
  EXPECT_TRUE(overlap(square(0.5, 0.5, 0.5), kCorner)) << "around";
  EXPECT_TRUE(overlap(kCorner, kCorner)) << "the same";
  EXPECT_TRUE(overlap({{0, 1}, {4, 1}, {4, 2}, {0, 2}}, {{1, 0}, {2, 0}, {2, 4}, {1, 4}}))
      << "no corner of one in the other";
  EXPECT_FALSE(overlap(kCorner, square(5, 0, 1)));
}

TEST(SceneGeometry, CommonWallsHaveTheRoomToTheirLeft) {
  const auto common = commonWalls(kCorner, square(4, -1, 2));
  ASSERT_THAT(common, SizeIs(1));
  EXPECT_TRUE(common[0].from.isApprox(Eigen::Vector2d(4, 0)));
  EXPECT_NEAR(common[0].length(), 1.0, 1e-12);
  EXPECT_TRUE(common[0].inward().isApprox(Eigen::Vector2d(-1, 0)));
  EXPECT_THAT(commonWalls(kCorner, square(2, 2, 2)), SizeIs(2));
  EXPECT_THAT(commonWalls(kCorner, square(4, 2, 2)), SizeIs(0)) << "a corner is no wall";
}

TEST(SceneGeometry, FootprintsOverlapWhereTheyShareAPoint) {
  base::Random random(1, "footprints");
  int overlapping = 0;
  for (int i = 0; i < 400; ++i) {
    const auto a = randomFootprint(random);
    auto b = randomFootprint(random);
    b.middle = a.middle + 0.4 * (b.middle - a.middle);
    const auto points = pointsOf(a);
    const bool share = std::ranges::any_of(points, [&](const auto& point) { return b.distanceTo(point) == 0.0; });
    overlapping += share ? 1 : 0;
    if (share) {
      EXPECT_TRUE(overlap(a, b));
      continue;
    }
    // What the raster misses is a sliver.
    auto smaller = b;
    smaller.size *= 0.9;
    EXPECT_FALSE(overlap(a, smaller) &&
                 !std::ranges::any_of(points, [&](const auto& p) { return b.distanceTo(p) < 0.05; }));
  }
  EXPECT_GT(overlapping, 100);
}

TEST(SceneGeometry, AFootprintIsWithinWhereAllItsPointsAre) {
  base::Random random(2, "footprints");
  int within = 0;
  for (int i = 0; i < 600; ++i) {
    const auto footprint = randomFootprint(random);
    const bool isIn = isWithin(kCorner, footprint);
    const auto points = pointsOf(footprint);
    const auto inside = std::ranges::count_if(points, [](const auto& point) { return contains(kCorner, point); });
    const auto all = static_cast<std::ptrdiff_t>(points.size());
    within += isIn ? 1 : 0;
    EXPECT_TRUE(!isIn || inside == all);
    auto smaller = footprint;
    smaller.size *= 0.9;
    EXPECT_TRUE(inside < all || isWithin(kCorner, smaller));
  }
  EXPECT_GT(within, 30);
  EXPECT_TRUE(isWithin(kCorner, {{1, 1}, 0.0, {2, 2}})) << "it may touch walls";
  EXPECT_FALSE(isWithin(kCorner, {{2, 2}, std::numbers::pi / 4.0, {0.1, 3}})) << "across the inner corner";
}

TEST(SceneGeometry, DistanceToAFootprintIsThatToItsRim) {
  const Footprint footprint{{1, 2}, std::numbers::pi / 2.0, {4, 2}};
  EXPECT_DOUBLE_EQ(footprint.distanceTo({1.5, 3.5}), 0.0);
  EXPECT_NEAR(footprint.distanceTo({3, 2}), 1.0, 1e-12);
  EXPECT_NEAR(footprint.distanceTo({1, 5}), 1.0, 1e-12);
  EXPECT_NEAR(footprint.distanceTo({2 + 3, 4 + 4}), 5.0, 1e-12);
}

}  // namespace
}  // namespace prodomos::simulation

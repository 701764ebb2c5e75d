// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/cells.hpp"

#include "prodomos/base/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace prodomos::geometry {
namespace {

/// By the winding of the corners about the point.
bool windsAbout(const Polygon& polygon, const Eigen::Vector2d& point) {
  double turn = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d a = polygon[i] - point;
    const Eigen::Vector2d b = polygon[(i + 1) % polygon.size()] - point;
    turn += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  }
  return std::abs(turn) > 1.0;
}

/// A star, simple, not convex.
Polygon randomStar(base::Random& random) {
  Polygon star;
  for (int i = 0; i < 11; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 11.0;
    const double radius = random.uniform(0.3, 2.0);
    star.push_back({1.0 + radius * std::cos(angle), -2.0 + radius * std::sin(angle)});
  }
  return star;
}

TEST(Cells, AreThoseWhoseCentresLieInThePolygon) {
  base::Random random(3, "cells_test");
  for (int trial = 0; trial < 20; ++trial) {
    const auto star = randomStar(random);
    std::vector<CellIndex> expected;
    for (int y = -90; y <= 10; ++y) {
      for (int x = -30; x <= 70; ++x) {
        if (windsAbout(star, centreOf({x, y}))) expected.push_back({x, y});
      }
    }
    EXPECT_EQ(cellsIn(star), expected);
    for (const auto cell : expected) EXPECT_TRUE(contains(star, centreOf(cell)));
  }
}

TEST(Cells, OfNeighboursAreNoneTwice) {
  auto cells = cellsIn({{0, 0}, {0.525, 0}, {0.525, 1}, {0, 1}});
  const auto others = cellsIn({{0.525, 0}, {1, 0}, {1, 1}, {0.525, 1}});
  cells.insert(cells.end(), others.begin(), others.end());
  std::ranges::sort(cells);
  EXPECT_EQ(std::ranges::adjacent_find(cells), cells.end());
  EXPECT_EQ(cells.size(), 400U);
}

TEST(Cells, DoNotDependOnTheWayRound) {
  Polygon polygon = {{0, 0}, {2, 0.3}, {1, 1.7}};
  const auto cells = cellsIn(polygon);
  std::ranges::reverse(polygon);
  EXPECT_EQ(cellsIn(polygon), cells);
}

TEST(Cells, OfNoAreaOrNoSenseAreNone) {
  EXPECT_TRUE(cellsIn({}).empty());
  EXPECT_TRUE(cellsIn({{0, 0}, {1, 1}}).empty());
  EXPECT_TRUE(cellsIn({{0, 0}, {1, 0}, {2, 0}}).empty());
  EXPECT_TRUE(cellsIn({{0, 0}, {1, 0}, {std::numeric_limits<double>::quiet_NaN(), 1}}).empty());
  EXPECT_TRUE(cellsIn({{0, 0}, {1e300, 0}, {1e300, 1e300}}).empty());
}

TEST(CellMap, HoldsAValueForEachCellOfItsBox) {
  CellMap<int> map(boxOf({{{0, 0}, {1, 0}, {1, 1}}}), -1);
  map.fill({{0, 0}, {0.1, 0}, {0.1, 0.1}, {0, 0.1}}, 7);
  EXPECT_EQ(map.at({0, 0}), 7);
  EXPECT_EQ(map.at({1, 1}), 7);
  EXPECT_EQ(map.at({2, 1}), -1);
  EXPECT_EQ(map.at({-100, 0}), -1);
  EXPECT_EQ(map.find({-100, 0}), nullptr);
  map.fill({{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}, 8);  // what lies outside is left out
  EXPECT_EQ(map.at({20, 20}), 8);
  EXPECT_EQ(map.at({21, 20}), -1);
}

TEST(CellMap, OfNothingIsEmpty) {
  const CellMap<int> map(boxOf({}), 3);
  EXPECT_EQ(map.at({0, 0}), 3);
}

TEST(Polygon, HasAnAreaWithTheSignOfItsTurn) {
  Polygon corners = {{1, 1}, {4, 1}, {4, 3}, {1, 3}};
  EXPECT_DOUBLE_EQ(signedArea(corners), 6.0);
  EXPECT_NEAR(signedArea(transformed(Pose2{3.0, -2.0, 0.7}, corners)), 6.0, 1e-12);
  std::ranges::reverse(corners);
  EXPECT_DOUBLE_EQ(signedArea(corners), -6.0);
  EXPECT_EQ(signedArea({}), 0.0);
  EXPECT_EQ(signedArea({{1, 1}, {2, 2}}), 0.0);
}

TEST(Polygon, ContainsByTheEvenOddRule) {
  const Polygon bow = {{0, 0}, {2, 2}, {2, 0}, {0, 2}};  // crosses itself
  EXPECT_TRUE(contains(bow, {0.3, 1.0}));
  EXPECT_TRUE(contains(bow, {1.7, 1.0}));
  EXPECT_FALSE(contains(bow, {1.0, 1.6}));
  EXPECT_FALSE(contains({}, {0.0, 0.0}));
}

TEST(Polygon, MovesInThePlaneAsSeenFromAbove) {
  const Polygon corner = {{1, 0}};
  const auto pose = fromYawPitchRoll({1, 2, 5}, std::numbers::pi / 2.0, 0.0, 0.0);
  EXPECT_TRUE(transformed(pose, corner)[0].isApprox(Eigen::Vector2d(1, 3)));
}

}  // namespace
}  // namespace prodomos::geometry

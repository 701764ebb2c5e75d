// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/ray_fan.hpp"

#include "prodomos/base/random.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <set>

namespace prodomos::geometry {
namespace {

using Cells = std::set<CellIndex>;

/// Whole numbers of 1/256 cell, odd: the rounding that RayFan documents.
std::int64_t units(double cells) {
  return 2 * static_cast<std::int64_t>(std::floor(cells * 128.0)) + 1;
}

/// The slow, obviously right way: of every cell of the box, does the segment meet its inside? Exact in whole numbers:
/// the segment and the open square are disjoint if and only if a side's direction or the segment's normal separates
/// them.
bool meets(CellIndex cell, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const std::int64_t ax = units(a.x());
  const std::int64_t ay = units(a.y());
  const std::int64_t bx = units(b.x());
  const std::int64_t by = units(b.y());
  const std::int64_t left = 256 * static_cast<std::int64_t>(cell.x);
  const std::int64_t low = 256 * static_cast<std::int64_t>(cell.y);
  if (std::max(ax, bx) <= left || std::min(ax, bx) >= left + 256) return false;
  if (std::max(ay, by) <= low || std::min(ay, by) >= low + 256) return false;
  if (ax == bx && ay == by) return true;
  int above = 0;
  int below = 0;
  for (const std::int64_t x : {left, left + 256}) {
    for (const std::int64_t y : {low, low + 256}) {
      const std::int64_t side = (bx - ax) * (y - ay) - (by - ay) * (x - ax);
      if (side >= 0) ++above;
      if (side <= 0) ++below;
    }
  }
  return above < 4 && below < 4;
}

Cells bruteForce(const Eigen::Vector2d& origin, std::span<const Eigen::Vector2d> ends) {
  CellBox box;
  box.add(cellAt(origin.x(), origin.y(), 1.0));
  for (const auto& end : ends) box.add(cellAt(end.x(), end.y(), 1.0));
  Cells cells;
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) {
      for (const auto& end : ends) {
        if (meets({x, y}, origin, end)) {
          cells.insert({x, y});
          break;
        }
      }
    }
  }
  return cells;
}

/// Fails where a cell comes twice.
Cells traced(const Eigen::Vector2d& origin, std::span<const Eigen::Vector2d> ends) {
  RayFan fan;
  Cells cells;
  fan.trace(origin, ends, [&](int y, int first, int last) {
    for (int x = first; x <= last; ++x) {
      EXPECT_TRUE(cells.insert({x, y}).second) << "cell " << x << ", " << y << " comes twice";
    }
  });
  return cells;
}

std::vector<Eigen::Vector2d> fanOf(const Eigen::Vector2d& origin, double first, double step, int count,
                                   const std::function<double(int)>& range) {
  std::vector<Eigen::Vector2d> ends;
  for (int i = 0; i < count; ++i) {
    const double angle = first + i * step;
    ends.push_back(origin + range(i) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return ends;
}

TEST(RayFan, PassesNothingWithoutRays) {
  EXPECT_TRUE(traced({0.5, 0.5}, {}).empty());
}

TEST(RayFan, PassesTheOwnCellOfARayOfLengthZero) {
  const std::vector<Eigen::Vector2d> ends{{3.5, -2.5}};
  EXPECT_THAT(traced({3.5, -2.5}, ends), testing::ElementsAre(CellIndex{3, -3}));
}

TEST(RayFan, PassesTheCellsOfOneFlatRay) {
  const std::vector<Eigen::Vector2d> ends{{3.2, 0.5}};
  EXPECT_THAT(traced({0.5, 0.5}, ends),
              testing::ElementsAre(CellIndex{0, 0}, CellIndex{1, 0}, CellIndex{2, 0}, CellIndex{3, 0}));
}

TEST(RayFan, GoesThroughCornersWithoutTouchingTheCellsBeside) {
  const std::vector<Eigen::Vector2d> ends{{2.5, 2.5}};
  EXPECT_THAT(traced({0.5, 0.5}, ends), testing::ElementsAre(CellIndex{0, 0}, CellIndex{1, 1}, CellIndex{2, 2}));
}

TEST(RayFan, LeavesTheGapsBetweenRaysFarAway) {
  const std::vector<Eigen::Vector2d> ends{{40.5, 0.5}, {40.5, 20.5}};
  EXPECT_FALSE(traced({0.5, 0.5}, ends).contains({40, 10}));
}

TEST(RayFan, MeetsTheBruteForceInAllDirections) {
  for (int degrees = 0; degrees < 360; degrees += 3) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const Eigen::Vector2d origin(-3.3, 7.9);
    const std::vector<Eigen::Vector2d> ends{origin + 31.7 * Eigen::Vector2d(std::cos(angle), std::sin(angle))};
    EXPECT_EQ(traced(origin, ends), bruteForce(origin, ends)) << degrees << " degrees";
  }
}

struct FanCase {
  const char* name;
  double first;
  double step;
  int count;
};

class RayFanOracle : public testing::TestWithParam<FanCase> {};

TEST_P(RayFanOracle, MeetsTheBruteForceOnRandomWorlds) {
  const auto& fan = GetParam();
  base::Random random(7);
  for (int world = 0; world < 12; ++world) {
    const Eigen::Vector2d origin(random.uniform(-20, 20), random.uniform(-20, 20));
    const double turn = random.uniform(-4, 4);
    double wall = random.uniform(1, 60);
    const auto ends = fanOf(origin, fan.first + turn, fan.step, fan.count, [&](int) {
      if (random.uniform() < 0.1) wall = random.uniform(0, 70);  // an edge
      return wall * random.uniform(0.98, 1.02);
    });
    ASSERT_EQ(traced(origin, ends), bruteForce(origin, ends)) << "world " << world;
  }
}

INSTANTIATE_TEST_SUITE_P(Scanners, RayFanOracle,
                         testing::Values(FanCase{"sick", -1.5708, 0.0174533, 180}, FanCase{"hokuyo", -2.0, 0.0061, 626},
                                         FanCase{"clockwise", 2.0, -0.0061, 626},
                                         FanCase{"full_turn", 0.0, 0.0174533, 360}, FanCase{"sparse", 0.0, 0.3, 21},
                                         FanCase{"narrow", 0.1, 0.0005, 300}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(RayFan, MeetsTheBruteForceOnRaysInAnyOrder) {
  base::Random random(11);
  for (int world = 0; world < 40; ++world) {
    std::vector<Eigen::Vector2d> ends;
    for (int i = 0; i < 60; ++i) ends.emplace_back(random.uniform(-30, 30), random.uniform(-30, 30));
    const Eigen::Vector2d origin(random.uniform(-5, 5), random.uniform(-5, 5));
    ASSERT_EQ(traced(origin, ends), bruteForce(origin, ends)) << "world " << world;
  }
}

TEST(RayFan, MeetsTheBruteForceOnRaysThroughCornersAndAlongBorders) {
  base::Random random(13);
  for (int world = 0; world < 60; ++world) {
    std::vector<Eigen::Vector2d> ends;
    for (int i = 0; i < 40; ++i) ends.emplace_back(random.integer(-15, 15), random.integer(-15, 15));
    ASSERT_EQ(traced({0, 0}, ends), bruteForce({0, 0}, ends)) << "world " << world;
  }
}

}  // namespace
}  // namespace prodomos::geometry

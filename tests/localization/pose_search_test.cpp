// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/pose_search.hpp"

#include "prodomos/base/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prodomos::localization {
namespace {

using geometry::Pose2;

constexpr double kResolution = 0.1;

map::SurfaceLayer randomSurface(base::Random& random, int count, double reach) {
  map::SurfaceLayer surface;
  for (int i = 0; i < count; ++i) surface.insert({random.uniform(-reach, reach), random.uniform(-reach, reach)});
  return surface;
}

std::vector<Eigen::Vector2d> randomPoints(base::Random& random, int count, double reach) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < count; ++i) points.emplace_back(random.uniform(-reach, reach), random.uniform(-reach, reach));
  return points;
}

bool isApart(const Pose2& pose, const Pose2& from, double margin) {
  return std::hypot(pose.x - from.x, pose.y - from.y) >= margin ||
         std::abs(geometry::normalizeAngle(pose.theta - from.theta)) >= margin;
}

double scoreOf(const std::vector<Eigen::Vector2d>& points, const LikelihoodField& field, const Pose2& pose) {
  double sum = 0.0;
  for (const auto& point : points) {
    const auto cell = geometry::cellAt(pose.x + std::cos(pose.theta) * point.x() - std::sin(pose.theta) * point.y(),
                                       pose.y + std::sin(pose.theta) * point.x() + std::cos(pose.theta) * point.y(),
                                       field.resolution());
    sum += field.at(0, cell.x, cell.y);
  }
  return sum / (LikelihoodField::kMost * static_cast<double>(points.size()));
}

/// The slow way: all cells of the window, in all directions, a cell's turn of the farthest point apart.
std::optional<FoundPose> searchAll(const std::vector<Eigen::Vector2d>& points, const LikelihoodField& field,
                                   const SearchWindow& window, double leastScore,
                                   const std::optional<Pose2>& apart = std::nullopt, double margin = 0.0) {
  double farthest = 1.0;
  for (const auto& point : points) farthest = std::max(farthest, point.norm());
  const int turns = static_cast<int>(std::ceil(window.turn * farthest / field.resolution()));
  const int reach = static_cast<int>(std::ceil(window.reach / field.resolution()));
  const auto centre = geometry::cellAt(window.centre.x, window.centre.y, field.resolution());
  std::optional<FoundPose> best;
  for (int turn = -turns; turn <= turns; ++turn) {
    const double theta = window.centre.theta + (turns > 0 ? turn * (window.turn / turns) : 0.0);
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const Pose2 pose{geometry::cellCentre(centre.x + x, field.resolution()),
                         geometry::cellCentre(centre.y + y, field.resolution()), theta};
        if (apart && !isApart(pose, *apart, margin)) continue;
        const double score = scoreOf(points, field, pose);
        if (score >= leastScore && (!best || score > best->score)) best = {pose, score};
      }
    }
  }
  return best;
}

void expectEqual(const std::optional<FoundPose>& found, const std::optional<FoundPose>& expected,
                 const std::vector<Eigen::Vector2d>& points, const LikelihoodField& field) {
  ASSERT_EQ(found.has_value(), expected.has_value());
  if (!found) return;
  EXPECT_NEAR(found->score, expected->score, 1e-9);
  // Of poses that score the same either may be found; it must score what it is said to. A point on a cell's border
  // may be rounded to the other side.
  EXPECT_NEAR(scoreOf(points, field, found->T_map_body), found->score, 1.01 / static_cast<double>(points.size()));
}

TEST(LikelihoodField, FallsOffAroundTheSurfaceToAllSides) {
  map::SurfaceLayer surface;
  surface.insert({0.55, -0.25});
  const LikelihoodField field(surface, kResolution, 1);
  EXPECT_EQ(field.at(0, 5, -3), LikelihoodField::kMost);
  EXPECT_LT(field.at(0, 6, -3), LikelihoodField::kMost);
  for (int i = 0; i < 4; ++i) {
    EXPECT_GT(field.at(0, 5 + i, -3), field.at(0, 6 + i, -3));
    EXPECT_EQ(field.at(0, 5 + i, -3), field.at(0, 5 - i, -3));
    EXPECT_EQ(field.at(0, 5, -3 + i), field.at(0, 5 + i, -3));
  }
  EXPECT_EQ(field.at(0, 9, -3), 0);
  EXPECT_EQ(field.at(0, 1000000, 0), 0);
}

TEST(LikelihoodField, HoldsOnCoarserLevelsTheGreatestOfWhatTheyCover) {
  base::Random random(1);
  const auto surface = randomSurface(random, 25, 2.0);
  const LikelihoodField field(surface, kResolution, 5);
  ASSERT_EQ(field.levels(), 5);
  for (int level = 0; level < 5; ++level) {
    const int width = 1 << level;
    for (int y = -45; y <= 45; ++y) {
      for (int x = -45; x <= 45; ++x) {
        int greatest = 0;
        for (int dy = 0; dy < width; ++dy) {
          for (int dx = 0; dx < width; ++dx) greatest = std::max(greatest, field.at(0, x + dx, y + dy));
        }
        ASSERT_EQ(field.at(level, x, y), greatest) << "level " << level << " at " << x << ", " << y;
      }
    }
  }
}

TEST(PoseSearch, FindsWhatExhaustiveSearchFinds) {
  base::Random random(2);
  for (int trial = 0; trial < 60; ++trial) {
    const auto surface = randomSurface(random, random.integer(1, 120), 2.5);
    const auto points = randomPoints(random, random.integer(1, 40), random.uniform(0.3, 2.5));
    const LikelihoodField field(surface, kResolution, random.integer(1, 6));
    const SearchWindow window{{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3, 3)},
                              random.uniform(0.0, 0.8),
                              random.uniform(0.0, 0.5)};
    for (const double leastScore : {0.0, 0.2, 0.4})
      expectEqual(searchPose(points, field, window, leastScore), searchAll(points, field, window, leastScore), points,
                  field);
  }
}

TEST(PoseSearch, FindsTheBestThatIsApart) {
  base::Random random(3);
  for (int trial = 0; trial < 40; ++trial) {
    const auto surface = randomSurface(random, 60, 2.0);
    const auto points = randomPoints(random, 20, 1.5);
    const LikelihoodField field(surface, kResolution, 5);
    const SearchWindow window{{0.0, 0.0, 0.0}, 0.6, 0.4};
    const auto best = searchPose(points, field, window, 0.0);
    ASSERT_TRUE(best);
    const double margin = random.uniform(0.05, 0.5);
    const auto found = searchPose(points, field, window, 0.0, best->T_map_body, margin);
    ASSERT_TRUE(found);
    EXPECT_TRUE(isApart(found->T_map_body, best->T_map_body, margin));
    EXPECT_LE(found->score, best->score);
    expectEqual(found, searchAll(points, field, window, 0.0, best->T_map_body, margin), points, field);
  }
  const auto surface = randomSurface(random, 60, 2.0);
  const auto points = randomPoints(random, 20, 1.5);
  const LikelihoodField field(surface, kResolution, 5);
  EXPECT_FALSE(searchPose(points, field, {{}, 0.4, 0.3}, 0.0, Pose2{}, 3.0)) << "all of the window is left out";
}

TEST(PoseSearch, FindsWhatScoresJustEnough) {
  base::Random random(4);
  for (int trial = 0; trial < 100; ++trial) {
    const auto surface = randomSurface(random, 40, 1.5);
    const auto points = randomPoints(random, random.integer(1, 50), 1.5);
    const LikelihoodField field(surface, kResolution, 4);
    const SearchWindow window{{}, 0.4, 0.3};
    const auto best = searchPose(points, field, window, 0.0);
    ASSERT_TRUE(best);
    const auto again = searchPose(points, field, window, best->score);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->T_map_body, best->T_map_body);
    EXPECT_FALSE(searchPose(points, field, window, best->score + 1e-4));
  }
}

TEST(PoseSearch, FindsATurnAllAroundFromWhateverHeading) {
  base::Random random(5);
  const auto points = randomPoints(random, 60, 3.0);
  for (int trial = 0; trial < 10; ++trial) {
    const Pose2 truth{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3.1, 3.1)};
    map::SurfaceLayer surface;
    for (const auto& point : points) {
      const auto place = truth * Pose2{point.x(), point.y(), 0.0};
      surface.insert({place.x, place.y});
    }
    const LikelihoodField field(surface, kResolution, 6);
    const auto found = searchPose(points, field, {{0, 0, random.uniform(-3, 3)}, 1.5, std::numbers::pi}, 0.5);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->T_map_body.x, truth.x, kResolution);
    EXPECT_NEAR(found->T_map_body.y, truth.y, kResolution);
    EXPECT_NEAR(geometry::normalizeAngle(found->T_map_body.theta - truth.theta), 0.0, 0.05);
    EXPECT_LE(std::abs(found->T_map_body.theta), std::numbers::pi);
  }
}

TEST(PoseSearch, FindsTheSameOfEqualOnesEachTime) {
  // Two points that lie the same to four places.
  map::SurfaceLayer surface;
  for (const double x : {-1.05, 0.95}) {
    for (const double y : {-1.05, 0.95}) surface.insert({x, y});
  }
  const LikelihoodField field(surface, kResolution, 5);
  const std::vector<Eigen::Vector2d> points = {{0.0, 0.0}};
  const auto first = searchPose(points, field, {{}, 2.0, 0.3}, 0.5);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->score, 1.0);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(searchPose(points, field, {{}, 2.0, 0.3}, 0.5)->T_map_body, first->T_map_body);
}

TEST(PoseSearch, FindsNothingInNothing) {
  base::Random random(6);
  const auto surface = randomSurface(random, 20, 1.0);
  const LikelihoodField field(surface, kResolution, 4);
  const LikelihoodField empty(map::SurfaceLayer(), kResolution, 4);
  const auto points = randomPoints(random, 10, 1.0);
  const std::vector<Eigen::Vector2d> none;
  const SearchWindow window{{}, 0.5, 0.5};
  EXPECT_FALSE(searchPose(none, field, window, 0.0));
  EXPECT_FALSE(searchPose(points, empty, window, 0.1));
  EXPECT_FALSE(searchPose(points, field, {{1e4, 0, 0}, 0.5, 0.5}, 0.1));
  EXPECT_FALSE(searchPose(points, field, window, 1.1));
}

}  // namespace
}  // namespace prodomos::localization

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/plane.hpp"

#include "prodomos/geometry/pose.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace prodomos::geometry {
namespace {

/// Points of a patch of z = 0 with noise along z, moved by a pose.
std::vector<Eigen::Vector3d> patch(const Pose3& T_world_patch, int count, double noise, base::Random& random) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    points.push_back(T_world_patch *
                     Eigen::Vector3d(random.uniform(-1.0, 1.0), random.uniform(-0.7, 0.7), random.normal(0.0, noise)));
  }
  return points;
}

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(std::abs(a.dot(b)), 0.0, 1.0));
}

TEST(Plane, TheSignedDistanceIsPositiveOnTheNormalsSide) {
  const Plane plane{Eigen::Vector3d::UnitZ(), 2.0};
  EXPECT_DOUBLE_EQ(plane.signedDistance({5.0, -3.0, 2.5}), 0.5);
  EXPECT_DOUBLE_EQ(plane.flipped().signedDistance({5.0, -3.0, 2.5}), -0.5);
}

TEST(Plane, FittingFindsThePlaneWhereverItLies) {
  base::Random random(1);
  for (int i = 0; i < 20; ++i) {
    const Pose3 T = fromYawPitchRoll({random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-5, 5)},
                                     random.uniform(-3, 3), random.uniform(-1.5, 1.5), random.uniform(-3, 3));
    const auto plane = fitPlane(patch(T, 400, 0.01, random));
    ASSERT_TRUE(plane);
    EXPECT_LT(angleBetween(plane->normal, T.linear().col(2)), 0.01);
    EXPECT_NEAR(plane->signedDistance(T.translation()), 0.0, 0.005);
    EXPECT_NEAR(plane->normal.norm(), 1.0, 1e-12);
  }
}

TEST(Plane, PointsOnALineOrTooFewFitNone) {
  EXPECT_FALSE(fitPlane({}));
  const std::vector<Eigen::Vector3d> two{{0, 0, 0}, {1, 0, 0}};
  EXPECT_FALSE(fitPlane(two));
  std::vector<Eigen::Vector3d> line;
  for (int i = 0; i < 10; ++i) line.emplace_back(i, 2.0 * i, -i);
  EXPECT_FALSE(fitPlane(line));
  const std::vector<Eigen::Vector3d> same(10, Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(fitPlane(same));
}

TEST(Plane, TheLargestAcceptedOneIsFoundAmongOthersAndScatter) {
  base::Random random(2);
  const Pose3 floor = fromYawPitchRoll({0, 0, -1.2}, 0.3, 0.05, 0.1);
  const Pose3 wall = fromYawPitchRoll({2, 0, 0}, 0.0, 1.57, 0.0);
  auto points = patch(floor, 300, 0.01, random);
  for (const auto& point : patch(wall, 600, 0.01, random)) points.push_back(point);
  for (int i = 0; i < 500; ++i) {
    points.emplace_back(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
  }

  PlaneSearch search;
  const auto largest = findPlane(points, search, random);
  ASSERT_TRUE(largest);
  EXPECT_LT(angleBetween(largest->plane.normal, wall.linear().col(2)), 0.02);

  search.accepts = [](const Plane& plane) { return plane.normal.z() > 0.8; };
  const auto level = findPlane(points, search, random);
  ASSERT_TRUE(level);
  EXPECT_LT(angleBetween(level->plane.normal, floor.linear().col(2)), 0.02);
  EXPECT_GT(level->plane.normal.z(), 0.0);
  std::size_t own = 0;
  for (const auto i : level->inliers) own += i < 300 ? 1 : 0;
  EXPECT_GT(own, 280U);
  EXPECT_TRUE(std::ranges::is_sorted(level->inliers));
  for (std::uint32_t i = 0; i < points.size(); ++i) {  // its inliers are all points within the tolerance
    EXPECT_EQ(std::ranges::binary_search(level->inliers, i), std::abs(level->plane.signedDistance(points[i])) <= 0.03);
  }
}

TEST(Plane, ToleranceMayGrowWithRange) {
  base::Random random(3);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 500; ++i) {
    const double range = random.uniform(0.5, 6.0);
    points.emplace_back(range, random.uniform(-1, 1), random.normal(0.0, 0.004 * range * range));
  }
  PlaneSearch search;
  search.tolerance = [](const Eigen::Vector3d& p) { return 0.01 + 0.012 * p.x() * p.x(); };
  const auto found = findPlane(points, search, random);
  ASSERT_TRUE(found);
  EXPECT_GT(found->inliers.size(), 480U);
}

TEST(Plane, NothingIsFoundWhereNothingIsAccepted) {
  base::Random random(4);
  const auto points = patch(Pose3::Identity(), 100, 0.0, random);
  PlaneSearch search;
  search.accepts = [](const Plane& plane) { return std::abs(plane.normal.x()) > 0.9; };
  EXPECT_FALSE(findPlane(points, search, random));
  EXPECT_FALSE(findPlane({}, {}, random));
}

TEST(Plane, TheSameSeedFindsTheSamePlane) {
  base::Random random(5);
  const auto points = patch(Pose3::Identity(), 300, 0.05, random);
  base::Random a(7);
  base::Random b(7);
  const auto first = findPlane(points, {}, a);
  const auto second = findPlane(points, {}, b);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->plane.normal, second->plane.normal);
  EXPECT_EQ(first->inliers, second->inliers);
}

}  // namespace
}  // namespace prodomos::geometry

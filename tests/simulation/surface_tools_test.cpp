// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/surface_tools.hpp"

#include "prodomos/base/random.hpp"

#include "tiny_world.hpp"

#include <gtest/gtest.h>

namespace prodomos::simulation {
namespace {

double areaOf(const Surface& surface) {
  double area = 0.0;
  for (const auto& [a, b, c] : surface.triangles) {
    const auto& v = surface.vertices;
    area += static_cast<double>((v[b] - v[a]).cross(v[c] - v[a]).norm()) / 2.0;
  }
  return area;
}

/// Does a triangle of the level surface cover the point?
bool covers(const Surface& surface, const Eigen::Vector2d& point) {
  return std::ranges::any_of(surface.triangles, [&](const auto& triangle) {
    Polygon corners;
    for (const auto index : triangle)
      corners.emplace_back(surface.vertices[index].template head<2>().template cast<double>());
    return contains(corners, point);
  });
}

TEST(SurfaceTools, PiecesHangTogetherByTheirCorners) {
  const auto surface = test::joined(
      {test::block({0, 0, 0}, {1, 1, 1}), test::block({5, 0, 0}, {6, 1, 1}), test::block({1, 1, 0}, {2, 2, 1})});
  const auto pieces = connectedPieces(surface);
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].triangles.size(), 24U);
  EXPECT_EQ(pieces[1].triangles.size(), 12U);
  EXPECT_EQ(boundsOf(pieces[1]).min().x(), 5.0F);
}

TEST(SurfaceTools, ACutLeavesWhatLiesOutsideOfTheBox) {
  base::Random random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Vector2d corner(random.uniform(-2.0, 9.0), random.uniform(-2.0, 2.0));
    const Eigen::AlignedBox2d hole(corner,
                                   corner + Eigen::Vector2d(random.uniform(0.1, 5.0), random.uniform(0.1, 4.0)));
    const auto cut = cutAway(test::level(3.0), {Eigen::Vector3d(hole.min().x(), hole.min().y(), 2.9),
                                                Eigen::Vector3d(hole.max().x(), hole.max().y(), 3.1)});
    const Eigen::AlignedBox2d whole(Eigen::Vector2d(0, 0), Eigen::Vector2d(10, 3));
    const auto common = whole.intersection(hole);
    EXPECT_NEAR(areaOf(cut), 30.0 - (common.isEmpty() ? 0.0 : common.volume()), 1e-4);
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector2d point(random.uniform(0.0, 10.0), random.uniform(0.0, 3.0));
      EXPECT_EQ(covers(cut, point), !hole.contains(point)) << point.transpose();
    }
  }
}

TEST(SurfaceTools, ACutKeepsTexturesInPlace) {
  const auto cut = cutAway(test::level(0.0), {Eigen::Vector3d(2, 1, -1), Eigen::Vector3d(5, 2, 1)});
  ASSERT_EQ(cut.textureCoordinates.size(), cut.vertices.size());
  for (std::size_t i = 0; i < cut.vertices.size(); ++i) {
    EXPECT_TRUE(cut.textureCoordinates[i].isApprox(cut.vertices[i].head<2>(), 1e-5F)) << i;
  }
}

TEST(SurfaceTools, ACutThatMeetsNothingChangesNothing) {
  const auto surface = test::frame();
  EXPECT_EQ(cutAway(surface, {Eigen::Vector3d(5, 5, 5), Eigen::Vector3d(6, 6, 6)}).triangles.size(),
            surface.triangles.size());
}

TEST(SurfaceTools, ASliceRunsRoundABox) {
  double length = 0.0;
  for (const auto& segment : sliceAt(test::block({1, 2, 0}, {4, 3, 2}), 1.2)) length += (segment.b - segment.a).norm();
  EXPECT_NEAR(length, 8.0, 1e-5);
  EXPECT_TRUE(sliceAt(test::block({1, 2, 0}, {4, 3, 2}), 2.5).empty());
}

}  // namespace
}  // namespace prodomos::simulation

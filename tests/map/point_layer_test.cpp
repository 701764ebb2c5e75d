// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/point_layer.hpp"

#include "prodomos/base/random.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <set>

namespace prodomos::map {
namespace {

constexpr sensors::Rgb kRed{255, 0, 0};
constexpr sensors::Rgb kBlue{0, 0, 255};

sensors::Reading readingOf(sensors::ReadingData data) {
  return {.time = {}, .sensor = "s", .data = std::move(data)};
}

TEST(PointLayer, KeepsTheFirstPointOfEachVoxel) {
  PointLayer layer({.voxel = 0.5, .maxRange = 10.0});
  layer.insert({0.1F, 0.1F, 0.1F}, kRed);
  layer.insert({0.4F, 0.4F, 0.4F}, kBlue);
  layer.insert({-0.1F, 0.1F, 0.1F}, kBlue);
  ASSERT_EQ(layer.points().size(), 2U);
  EXPECT_EQ(layer.points()[0].color, kRed);
  EXPECT_EQ(layer.points()[1].color, kBlue);
}

TEST(PointLayer, MeetsTheOracleOnRandomPoints) {
  base::Random random(3);
  for (const double voxel : {0.05, 0.1, 0.37, 2.0}) {
    PointLayer layer({.voxel = voxel, .maxRange = 10.0});
    std::set<std::array<int, 3>> voxels;
    for (int i = 0; i < 5000; ++i) {
      const Eigen::Vector3f point(static_cast<float>(random.uniform(-3, 3)), static_cast<float>(random.uniform(-3, 3)),
                                  static_cast<float>(random.uniform(-1, 1)));
      std::array<int, 3> index{};
      for (int axis = 0; axis < 3; ++axis) {
        index[static_cast<std::size_t>(axis)] = static_cast<int>(std::floor(static_cast<double>(point[axis]) / voxel));
      }
      const auto before = layer.points().size();
      layer.insert(point, kRed);
      ASSERT_EQ(layer.points().size() - before, voxels.insert(index).second ? 1U : 0U);
    }
  }
}

TEST(PointLayer, TakesTheEndPointsOfAScan) {
  sensors::LaserScan scan;
  scan.T_body_sensor = geometry::toPose3({0.0, 0.0, 0.0}, 0.3);
  scan.firstAngle = -std::numbers::pi / 2;
  scan.angleStep = std::numbers::pi / 2;
  scan.maxRange = 20.0;
  scan.ranges = {1.0F,  sensors::LaserScan::kNoReturn, 2.0F,
                 15.0F, sensors::LaserScan::kInvalid,  std::numeric_limits<float>::quiet_NaN()};
  PointLayer layer({.voxel = 0.1, .maxRange = 10.0});
  const auto reading = readingOf(scan);
  EXPECT_TRUE(
      layer.integrate({.reading = reading, .T_submap_body = geometry::toPose3({5.0, 0.0, std::numbers::pi / 2})}));
  ASSERT_EQ(layer.points().size(), 2U);
  EXPECT_TRUE(layer.points()[0].position_in_submap.isApprox(Eigen::Vector3f(6.0F, 0.0F, 0.3F), 1e-5F));
  EXPECT_TRUE(layer.points()[1].position_in_submap.isApprox(Eigen::Vector3f(3.0F, 0.0F, 0.3F), 1e-5F));
}

TEST(PointLayer, LeavesOutTheBeamsOfMovers) {
  sensors::LaserScan scan;
  scan.angleStep = 0.5;
  scan.maxRange = 20.0;
  scan.ranges = {1.0F, 2.0F, 3.0F};
  sensors::Mask movers(3, 1);
  movers(1, 0) = 1;
  PointLayer layer;
  const auto reading = readingOf(scan);
  layer.integrate({.reading = reading, .movers = &movers});
  EXPECT_EQ(layer.points().size(), 2U);
}

TEST(PointLayer, TakesColoursWhereThereAreAny) {
  sensors::PointCloud cloud;
  cloud.points_in_sensor = {{1, 0, 0}, {2, 0, 0}, {50, 0, 0}};
  PointLayer plain;
  auto reading = readingOf(cloud);
  EXPECT_TRUE(plain.integrate({.reading = reading}));
  EXPECT_EQ(plain.points().size(), 2U) << "farther than the range";
  EXPECT_EQ(plain.points()[0].color, plain.points()[1].color);

  cloud.color = {kRed, kBlue, kBlue};
  PointLayer coloured;
  reading = readingOf(cloud);
  coloured.integrate({.reading = reading});
  EXPECT_EQ(coloured.points()[0].color, kRed);
  EXPECT_EQ(coloured.points()[1].color, kBlue);
}

TEST(PointLayer, TakesDepthWithColour) {
  sensors::RgbdFrame frame;
  frame.T_body_camera = sensors::cameraAxesInBody();
  frame.camera = {.fx = 10.0, .fy = 10.0, .cx = 0.0, .cy = 0.0, .distortion = {}};
  frame.depth = sensors::Image<float>(8, 8, 0.0F);
  frame.depth(0, 0) = 2.0F;
  frame.depth(4, 0) = 1.0F;
  frame.depth(0, 4) = std::numeric_limits<float>::quiet_NaN();
  frame.color = sensors::Image<sensors::Rgb>(8, 8, kBlue);
  frame.color(0, 0) = kRed;
  PointLayer layer;
  const auto reading = readingOf(frame);
  EXPECT_TRUE(layer.integrate({.reading = reading}));
  ASSERT_EQ(layer.points().size(), 2U);
  EXPECT_TRUE(layer.points()[0].position_in_submap.isApprox(Eigen::Vector3f(2, 0, 0)));
  EXPECT_EQ(layer.points()[0].color, kRed);
  EXPECT_TRUE(layer.points()[1].position_in_submap.isApprox(Eigen::Vector3f(1.0F, -0.4F, 0.0F)));
}

TEST(PointLayer, TakesNothingFromReadingsWithoutPoints) {
  PointLayer layer;
  for (const auto& reading :
       {readingOf(sensors::Odometry()), readingOf(sensors::RgbdFrame()), readingOf(sensors::KeyPoints())}) {
    EXPECT_FALSE(layer.integrate({.reading = reading}));
  }
  EXPECT_TRUE(layer.points().empty());
}

TEST(PointLayer, MergesUnderAPoseInSpace) {
  PointLayer other;
  other.insert({1, 0, 0}, kRed);
  PointLayer layer;
  layer.insert({9, 9, 9}, kBlue);
  layer.merge(other, geometry::fromYawPitchRoll({10, 0, 3}, std::numbers::pi / 2, 0, 0));
  ASSERT_EQ(layer.points().size(), 2U);
  EXPECT_TRUE(layer.points()[1].position_in_submap.isApprox(Eigen::Vector3f(10, 1, 3), 1e-5F));
}

TEST(PointLayer, DrawsAndCountsItsPoints) {
  PointLayer layer;
  layer.insert({1, 2, 3}, kRed);
  const auto drawing = layer.draw();
  ASSERT_EQ(drawing.points.size(), 1U);
  EXPECT_EQ(drawing.points[0].position_in_submap, Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(drawing.points[0].color, (Rgba{255, 0, 0, 255}));
  EXPECT_THAT(layer.summary(), testing::ElementsAre(testing::Pair("points", "1")));
}

}  // namespace
}  // namespace prodomos::map

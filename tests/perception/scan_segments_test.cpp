// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/scan_segments.hpp"

#include "perception/flat_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace prodomos::perception {
namespace {

using Eigen::Vector2d;
using test::FlatWorld;
using testing::IsEmpty;
using testing::SizeIs;

TEST(ScanSegments, ACornerParts) {
  FlatWorld world;
  world.addWall({3.0, -2.0}, {3.0, 2.0});
  world.addWall({3.0, 2.0}, {-1.0, 2.0});
  base::Random noise(1, "noise");
  const auto segments = segmentsOf(beamsOf(world.scan({}, &noise)));
  ASSERT_THAT(segments, SizeIs(2));
  EXPECT_NEAR((segments[0].first - Vector2d(3.0, -2.0)).norm(), 0.0, 0.07);
  EXPECT_NEAR((segments[0].last - Vector2d(3.0, 2.0)).norm(), 0.0, 0.07);
  EXPECT_NEAR(segments[1].length(), 4.0, 0.15);
  EXPECT_NEAR(std::abs(segments[1].along().x()), 1.0, 1e-3);
}

TEST(ScanSegments, WhatStandsBeforeAWallIsApart) {
  FlatWorld world;
  world.addWall({3.0, -2.0}, {3.0, 2.0});
  world.addWall({2.0, -0.4}, {2.0, 0.4});
  EXPECT_THAT(segmentsOf(beamsOf(world.scan({}))), SizeIs(3));
}

TEST(ScanSegments, AMissingBeamPartsNothing) {
  FlatWorld world;
  world.addWall({3.0, -2.0}, {3.0, 2.0});
  auto scan = world.scan({});
  scan.ranges[270] = sensors::LaserScan::kInvalid;
  scan.ranges[280] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(segmentsOf(beamsOf(scan)), SizeIs(1));
}

TEST(ScanSegments, APointIsOffItsLine) {
  FlatWorld world;
  world.addWall({3.0, -2.0}, {3.0, 2.0});
  const auto segments = segmentsOf(beamsOf(world.scan({})));
  ASSERT_THAT(segments, SizeIs(1));
  EXPECT_NEAR(std::abs(segments[0].offset({2.5, 7.0})), 0.5, 1e-3);
}

TEST(ScanSegments, NothingIsMadeOfNothing) {
  EXPECT_THAT(segmentsOf({}), IsEmpty());
  EXPECT_THAT(segmentsOf(beamsOf(FlatWorld().scan({}))), IsEmpty()) << "no returns";
  sensors::LaserScan broken;
  broken.angleStep = 0.01;
  broken.ranges.assign(100, std::numeric_limits<float>::quiet_NaN());
  EXPECT_THAT(segmentsOf(beamsOf(broken)), IsEmpty());
  broken.ranges.assign(100, 2.0F);
  broken.angleStep = 0.0;
  for (const auto& segment : segmentsOf(beamsOf(broken))) EXPECT_LT(segment.length(), 0.01);
}

}  // namespace
}  // namespace prodomos::perception

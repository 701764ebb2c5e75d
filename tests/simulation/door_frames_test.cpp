// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/worlds/door_frames.hpp"

#include "tiny_world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prodomos::simulation {
namespace {

TEST(DoorFrames, TheOpeningIsWhatTheFrameLeavesClear) {
  for (const double angle : {0.0, 0.4, 1.5708, 2.5, -1.1}) {
    const auto T_world_frame = geometry::toPose3({3.0, -2.0, angle}, 1.5);
    const auto opening = openingOf(transformed(T_world_frame, test::frame()));
    ASSERT_TRUE(opening) << angle;
    EXPECT_NEAR(opening->width, 0.93, 1e-4);
    EXPECT_NEAR(opening->height, 2.065, 1e-4);
    EXPECT_NEAR(opening->bottom, 1.5, 1e-4);
    EXPECT_NEAR(opening->pose.x, 3.0, 1e-4);
    EXPECT_NEAR(opening->pose.y, -2.0, 1e-4);
    // Either way through it.
    EXPECT_NEAR(std::abs(std::sin(opening->pose.theta - angle)), 0.0, 1e-4) << angle;
    EXPECT_NEAR(signedArea(opening->footprint), 0.16 * 1.0, 1e-4);
  }
}

TEST(DoorFrames, WhatNobodyCanPassIsNoDoor) {
  EXPECT_FALSE(openingOf(test::block({0, 0, 0}, {0.1, 0.1, 2.0})));
  geometry::Pose3 T = geometry::Pose3::Identity();
  T.linear() = Eigen::Vector3d(1.0, 0.3, 1.0).asDiagonal();
  EXPECT_FALSE(openingOf(transformed(T, test::frame())));
  T.linear() = Eigen::Vector3d(1.0, 1.0, 0.5).asDiagonal();
  EXPECT_FALSE(openingOf(transformed(T, test::frame())));
}

}  // namespace
}  // namespace prodomos::simulation

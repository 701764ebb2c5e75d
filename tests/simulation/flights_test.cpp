// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/worlds/flights.hpp"

#include "tiny_world.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace prodomos::simulation {
namespace {

TEST(Flights, StepsAreMeasuredInAllFourDirections) {
  for (const double direction : {0.0, 0.5, 1.0, 1.5}) {
    const double angle = direction * std::numbers::pi;
    const auto found =
        flightOf(transformed(geometry::toPose3({2.0, 5.0, angle}, -1.0), test::flight(10, 0.28, 0.17, 1.4)));
    ASSERT_TRUE(found) << direction;
    const auto& stairs = found->stairs;
    EXPECT_NEAR(std::cos(stairs.direction - angle), 1.0, 1e-9) << direction;
    EXPECT_EQ(stairs.stepCount, 10);
    EXPECT_NEAR(stairs.stepDepth, 0.28, 1e-4);
    EXPECT_NEAR(stairs.stepHeight, 0.17, 1e-4);
    EXPECT_NEAR(stairs.width, 1.4, 1e-4);
    EXPECT_TRUE(stairs.foot.isApprox(Eigen::Vector3d(2.0, 5.0, -1.0), 1e-4)) << stairs.foot.transpose();
    EXPECT_NEAR(headOf(stairs).z(), 0.7, 1e-3);
  }
}

TEST(Flights, ALandingIsNoStep) {
  auto surface = test::flight(8, 0.25, 0.2, 1.0);
  addRectangle(surface, {2.0, -0.5, 1.6}, {1.5, 0.0, 0.0}, {0.0, 1.0, 0.0});
  const auto found = flightOf(surface);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->stairs.stepCount, 8);
  EXPECT_NEAR(found->stairs.stepDepth, 0.25, 1e-4);
  EXPECT_NEAR(found->steps.max().x(), 2.0, 1e-4);
  EXPECT_NEAR(found->extent.max().x(), 3.5, 1e-4);
}

TEST(Flights, WhatHasNoStepsIsNoFlight) {
  EXPECT_FALSE(flightOf(test::block({0, 0, 0}, {3, 1, 1})));
  EXPECT_FALSE(flightOf(test::flight(2, 0.25, 0.2, 1.0)));
  // Shelves lie one above the other.
  EXPECT_FALSE(flightOf(test::joined({test::level(0.5), test::level(1.0), test::level(1.5)})));
}

}  // namespace
}  // namespace prodomos::simulation

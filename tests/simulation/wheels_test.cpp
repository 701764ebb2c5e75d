// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/wheels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace prodomos::simulation {
namespace {

using geometry::Pose2;

constexpr WheelModel kPerfect{0.0, 0.0, 0.0, 0.0, 0.0, 0.0};

/// A lap of ten metres each way, in steps of `step` metres.
std::vector<geometry::Pose3> straightWay(double length, double step) {
  std::vector<geometry::Pose3> way;
  for (int i = 0; i * step <= length + 1e-9; ++i) way.push_back(geometry::toPose3({5.0 + i * step, -3.0, 0.0}));
  return way;
}

Pose2 endOf(Wheels wheels, const std::vector<geometry::Pose3>& way) {
  Pose2 end;
  for (const auto& pose : way) end = wheels.moveTo(pose);
  return end;
}

TEST(Wheels, BeginAtTheOriginOfTheirOwnFrame) {
  Wheels wheels(WheelModel{}, 1);
  EXPECT_EQ(wheels.moveTo(geometry::toPose3({4.0, 2.0, 1.0})), (Pose2{}));
}

TEST(Wheels, WithoutErrorsTellTheWaySeenFromItsBegin) {
  Wheels wheels(kPerfect, 1);
  const Pose2 begin{4.0, 2.0, 2.5};
  wheels.moveTo(geometry::toPose3(begin));
  for (const Pose2 pose : {Pose2{4.5, 2.5, 3.0}, Pose2{4.0, 3.0, -3.0}, Pose2{3.0, 3.0, -1.0}}) {
    const auto told = wheels.moveTo(geometry::toPose3(pose, 7.0));
    const auto expected = inverse(begin) * pose;
    EXPECT_NEAR(told.x, expected.x, 1e-12);
    EXPECT_NEAR(told.y, expected.y, 1e-12);
    EXPECT_NEAR(geometry::normalizeAngle(told.theta - expected.theta), 0.0, 1e-12);
  }
}

TEST(Wheels, ARobotThatStandsDoesNotDrift) {
  Wheels wheels(WheelModel{}, 3);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(wheels.moveTo(geometry::toPose3({1.0, 1.0, 0.3}, 0.1 * i)), (Pose2{}));
}

TEST(Wheels, TheSameSeedErrsAlikeAndAnotherOtherwise) {
  const auto way = straightWay(10.0, 0.1);
  EXPECT_EQ(endOf(Wheels({}, 5), way), endOf(Wheels({}, 5), way));
  EXPECT_NE(endOf(Wheels({}, 5), way), endOf(Wheels({}, 6), way));
}

TEST(Wheels, NoiseGrowsWithTheRootOfTheWayHoweverFineItsSteps) {
  WheelModel model = kPerfect;
  model.distanceNoise = 0.02;
  for (const double step : {0.02, 0.5}) {
    double squares = 0.0;
    constexpr int kRobots = 400;
    for (int robot = 0; robot < kRobots; ++robot) {
      const double error = endOf(Wheels(model, static_cast<std::uint64_t>(robot)), straightWay(9.0, step)).x - 9.0;
      squares += error * error;
    }
    EXPECT_NEAR(std::sqrt(squares / kRobots), 0.06, 0.008) << "steps of " << step << " m";
  }
}

TEST(Wheels, OneRobotsScaleIsTheSameAllTheWay) {
  WheelModel model = kPerfect;
  model.scaleSigma = 0.05;
  Wheels wheels(model, 11);
  wheels.moveTo(geometry::toPose3({}));
  const double first = wheels.moveTo(geometry::toPose3({1.0, 0.0, 0.0})).x;
  const double second = wheels.moveTo(geometry::toPose3({2.0, 0.0, 0.0})).x - first;
  EXPECT_NE(first, 1.0);
  EXPECT_NEAR(first, second, 1e-12);
}

}  // namespace
}  // namespace prodomos::simulation

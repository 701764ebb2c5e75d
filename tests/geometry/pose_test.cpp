// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/pose.hpp"

#include "prodomos/base/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace prodomos::geometry {
namespace {

constexpr double kPi = std::numbers::pi;

Pose3 randomPose(base::Random& random) {
  return fromYawPitchRoll({random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5)}, random.uniform(-3, 3),
                          random.uniform(-1.5, 1.5), random.uniform(-3, 3));
}

TEST(Pose, AnglesAreWrappedIntoOneTurn) {
  EXPECT_DOUBLE_EQ(normalizeAngle(3 * kPi), kPi);
  EXPECT_DOUBLE_EQ(normalizeAngle(-kPi), kPi);
  EXPECT_NEAR(normalizeAngle(2 * kPi + 0.3), 0.3, 1e-12);
}

TEST(Pose, InThePlaneComposesLikeInSpace) {
  base::Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Pose2 a{random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-3, 3)};
    const Pose2 b{random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-3, 3)};
    EXPECT_TRUE(toPose3(a * b).isApprox(toPose3(a) * toPose3(b), 1e-12));
    EXPECT_TRUE(toPose3(inverse(a)).isApprox(toPose3(a).inverse(), 1e-12));
  }
}

TEST(Pose, InThePlaneMapsPointsLikeInSpace) {
  const Pose2 pose{1.0, -2.0, 2.5};
  const Eigen::Vector2d point(0.3, 0.7);
  const Eigen::Vector3d inSpace = toPose3(pose) * Eigen::Vector3d(0.3, 0.7, 0.0);
  EXPECT_LT((pose * point - inSpace.head<2>()).norm(), 1e-12);
}

TEST(Pose, YawPitchRollTurnsInThisOrder) {
  const Pose3 pose = fromYawPitchRoll({1, 2, 3}, kPi / 2, 0.2, 0.0);
  EXPECT_NEAR(yaw(pose), kPi / 2, 1e-12);
  EXPECT_LT((pose * Eigen::Vector3d::UnitX()).z(), 3.0) << "a positive pitch looks down";
}

TEST(Pose, InterpolationMeetsItsEndsAndGoesOnBeyond) {
  base::Random random(2);
  for (int i = 0; i < 50; ++i) {
    const Pose3 a = randomPose(random);
    const Pose3 b = randomPose(random);
    EXPECT_TRUE(interpolate(a, b, 0).isApprox(a, 1e-9));
    EXPECT_TRUE(interpolate(a, b, 1).isApprox(b, 1e-9));
  }
  const Pose3 beyond = interpolate(toPose3({0, 0, 0}), toPose3({1, 0, 0.1}), 2.0);
  EXPECT_NEAR(beyond.translation().x(), 2.0, 1e-12);
  EXPECT_NEAR(yaw(beyond), 0.2, 1e-12);
}

TEST(Pose, LevelledKeepsPositionAndHeading) {
  const Pose3 tilted = fromYawPitchRoll({1, 2, 3}, 0.7, 0.3, -0.2);
  const Pose3 level = levelled(tilted);
  EXPECT_TRUE(level.translation().isApprox(tilted.translation()));
  EXPECT_NEAR(yaw(level), yaw(tilted), 1e-12);
  EXPECT_TRUE(Eigen::Vector3d(level.linear().col(2)).isApprox(Eigen::Vector3d::UnitZ()));
}

TEST(Pose, QuaternionsNeedNotBeOfLengthOne) {
  const Pose3 pose = fromQuaternion({0, 0, 0}, Eigen::Quaterniond(2, 0, 0, 2));
  EXPECT_NEAR(yaw(pose), kPi / 2, 1e-12);
}

TEST(Pose, NotANumberIsNotFinite) {
  Pose3 pose = Pose3::Identity();
  EXPECT_TRUE(isFinite(pose));
  pose.translation().y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(isFinite(pose));
}

}  // namespace
}  // namespace prodomos::geometry

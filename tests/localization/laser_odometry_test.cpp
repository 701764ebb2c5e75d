// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/laser_odometry.hpp"

#include "localization/flat_building.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace prodomos::localization {
namespace {

using geometry::Pose2;
using test::FlatBuilding;
using test::kDegree;

/// Along the corridor, into two rooms and out again.
const std::vector<Eigen::Vector2d> kTour = {{-8.0, 0.0}, {-5.0, 0.0}, {-5.0, 4.0}, {-6.5, 4.5}, {-5.0, 3.0},
                                            {-5.0, 0.0}, {2.0, 0.2},  {5.0, 0.0},  {5.0, -4.0}, {6.5, -4.5},
                                            {5.0, -3.0}, {5.0, 0.0},  {-8.0, -0.1}};

/// A robot that turns on the spot and drives straight on, `step` metres or three times as many radians a scan.
std::vector<Pose2> drive(const std::vector<Eigen::Vector2d>& tour, double step = 0.1) {
  std::vector<Pose2> poses = {{tour[0].x(), tour[0].y(), 0.0}};
  for (const auto& target : tour) {
    for (;;) {
      const auto& last = poses.back();
      const Eigen::Vector2d way = target - Eigen::Vector2d(last.x, last.y);
      if (way.norm() < 0.5 * step) break;
      const double turn = geometry::normalizeAngle(std::atan2(way.y(), way.x()) - last.theta);
      const double most = 1.5 * step;
      poses.push_back(std::abs(turn) > 1e-6 ? last * Pose2{0.0, 0.0, std::clamp(turn, -most, most)}
                                            : last * Pose2{std::min(step, way.norm()), 0.0, 0.0});
    }
  }
  return poses;
}

/// Six rooms of 20 by 12 metres, three on either side of a corridor, each with furniture of its own.
FlatBuilding building(std::uint64_t seed) {
  FlatBuilding building;
  building.addBox({}, 20.0, 14.0);
  for (const double y : {-1.1, 1.1}) building.addWallWithDoors({-10.0, y}, {10.0, y}, {5.0, 11.0, 15.0});
  for (const double x : {-3.0, 3.0}) {
    building.addWall({x, 1.1}, {x, 7.0});
    building.addWall({x, -7.0}, {x, -1.1});
  }
  base::Random random(seed);
  building.addFurniture(random, 16, 20.0, 14.0, drive(kTour));
  return building;
}

using Wheels = std::function<std::optional<Pose2>(const Pose2& step)>;

std::optional<Pose2> noWheels(const Pose2&) {
  return std::nullopt;
}

/// Wheels that slip: the way is told to a tenth.
Wheels slipping(base::Random& random) {
  return [&random](const Pose2& step) -> std::optional<Pose2> {
    return Pose2{step.x * random.normal(1.0, 0.1), 0.0, step.theta * random.normal(1.0, 0.1)};
  };
}

/// Wheels of a wrong size, one a little larger than the other.
std::optional<Pose2> wrongWheels(const Pose2& step) {
  return Pose2{1.2 * step.x, 0.0, step.theta + 2.0 * kDegree * step.x};
}

struct Outcome {
  test::PoseError worst{0.0, 0.0};
  test::PoseError last{0.0, 0.0};
  double chiSquared = 0.0;  ///< of the last pose, by the covariances of all steps
  int lost = 0;
};

constexpr double kAhead = std::numbers::pi;  // what the laser sees

std::vector<Eigen::Vector2d> lookFrom(const FlatBuilding& building, const Pose2& pose, base::Random& random) {
  return test::pointsOf(building.scan(pose, &random, 0.01, kAhead));
}

Outcome follow(
    const FlatBuilding& building, const std::vector<Pose2>& truth, const Wheels& wheels, base::Random& random,
    const std::function<bool(std::size_t)>& isBlind = [](std::size_t) { return false; }) {
  LaserOdometry odometry;
  Outcome outcome;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Pose2 before;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto points = isBlind(i) ? std::vector<Eigen::Vector2d>() : lookFrom(building, truth[i], random);
    const auto step = i > 0 ? wheels(geometry::inverse(truth[i - 1]) * truth[i]) : std::nullopt;
    const auto estimate = odometry.track(points, step);
    outcome.lost += estimate.isLost ? 1 : 0;
    outcome.last = test::errorOf(estimate.T_travel_body, geometry::inverse(truth[0]) * truth[i]);
    outcome.worst = {std::max(outcome.worst.metres, outcome.last.metres),
                     std::max(outcome.worst.radians, outcome.last.radians)};

    // The error of before, seen from here, and that of the step.
    const auto T_now_before = geometry::inverse(estimate.T_travel_body) * before;
    Eigen::Matrix3d adjoint = Eigen::Matrix3d::Identity();
    adjoint.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(T_now_before.theta).toRotationMatrix();
    adjoint(0, 2) = T_now_before.y;
    adjoint(1, 2) = -T_now_before.x;
    covariance = adjoint * covariance * adjoint.transpose() + estimate.covariance;
    before = estimate.T_travel_body;
  }
  const auto off = geometry::inverse(geometry::inverse(truth[0]) * truth.back()) * before;
  const Eigen::Vector3d error(off.x, off.y, off.theta);
  outcome.chiSquared = error.dot(covariance.inverse() * error);
  return outcome;
}

TEST(LaserOdometry, FollowsADriveThoughTheWheelsSlip) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    base::Random random(seed);
    const auto outcome = follow(building(seed), drive(kTour), slipping(random), random);
    EXPECT_LT(outcome.worst.metres, 0.1);
    EXPECT_LT(outcome.worst.radians, 1.0 * kDegree);
    EXPECT_EQ(outcome.lost, 0);
  }
}

TEST(LaserOdometry, FollowsADriveThoughTheWheelsAreOfAWrongSize) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    base::Random random(seed);
    const auto outcome = follow(building(seed), drive(kTour), wrongWheels, random);
    EXPECT_LT(outcome.worst.metres, 0.25);
    EXPECT_LT(outcome.worst.radians, 1.5 * kDegree);
    EXPECT_EQ(outcome.lost, 0);
  }
}

TEST(LaserOdometry, FollowsADriveWithoutWheels) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    base::Random random(seed);
    const auto outcome = follow(building(seed), drive(kTour), noWheels, random);
    EXPECT_LT(outcome.worst.metres, 0.15);
    EXPECT_LT(outcome.worst.radians, 1.0 * kDegree);
    EXPECT_EQ(outcome.lost, 0);
  }
}

TEST(LaserOdometry, DoesNotClaimToErrLessThanItDoes) {
  double sum = 0.0;
  constexpr int kDrives = 6;
  for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
    base::Random random(seed);
    const auto outcome = follow(building(seed), drive(kTour), slipping(random), random);
    sum += outcome.chiSquared / 3.0;
  }
  EXPECT_LT(sum / kDrives, 3.0);
  // Walls here are straighter, and noise is whiter, than anything real: it may well claim to err more.
  EXPECT_GT(sum / kDrives, 2e-4);
}

TEST(LaserOdometry, GoesOnByTheWheelsWhileItIsBlind) {
  base::Random random(4);
  const auto world = building(4);
  const auto exact = [](const Pose2& step) { return std::optional(step * Pose2{0.002, 0.0, 0.001}); };
  const auto isBlind = [](std::size_t i) { return i >= 30 && i < 45; };
  const auto outcome = follow(world, drive(kTour), exact, random, isBlind);
  EXPECT_EQ(outcome.lost, 15);
  EXPECT_LT(outcome.worst.metres, 0.15);
  EXPECT_LT(outcome.last.metres, 0.15);
}

TEST(LaserOdometry, GoesOnAsItDidWhileItIsBlindWithoutWheels) {
  base::Random random(5);
  const auto isBlind = [](std::size_t i) { return i == 12 || i == 13; };
  const auto outcome = follow(building(5), drive({{-8.0, 0.0}, {6.0, 0.0}}), noWheels, random, isBlind);
  EXPECT_EQ(outcome.lost, 2);
  EXPECT_LT(outcome.worst.metres, 0.2);
}

TEST(LaserOdometry, IsLostWhereNothingFitsAndLessSure) {
  base::Random random(6);
  const auto world = building(6);
  LaserOdometry odometry;
  const Pose2 place{-6.0, 4.0, 0.3};
  const Pose2 still;
  odometry.track(lookFrom(world, place, random), std::nullopt);
  const Pose2 step{0.2, 0.0, 0.0};
  const auto known = odometry.track(lookFrom(world, place * step, random), step);
  EXPECT_FALSE(known.isLost);
  const auto blind = odometry.track({}, step);
  EXPECT_TRUE(blind.isLost);
  EXPECT_GT(blind.covariance.trace(), 10.0 * known.covariance.trace());
  EXPECT_NEAR(blind.T_travel_body.x, 0.4, 0.02) << "as the wheels tell";
  const auto again = odometry.track(lookFrom(world, place * step * step, random), still);
  EXPECT_FALSE(again.isLost) << "it finds itself in what it knew before";
  EXPECT_LT(test::errorOf(again.T_travel_body, step * step).metres, 0.03);
}

TEST(LaserOdometry, BeginsWithWhatItSeesFirstThoughThatIsLate) {
  // The first scans are empty, and the robot stands still all the while.
  base::Random random(7);
  const auto world = building(7);
  LaserOdometry odometry;
  for (int i = 0; i < 5; ++i) odometry.track({}, Pose2{});
  LaserOdometry::Estimate estimate;
  for (int i = 0; i < 3; ++i) estimate = odometry.track(lookFrom(world, {-6.0, 4.0, 0.3}, random), Pose2{});
  EXPECT_FALSE(estimate.isLost);
  EXPECT_LT(test::errorOf(estimate.T_travel_body, {}).metres, 0.01);
}

TEST(LaserOdometry, GoesOnBitByBitWhereItWasSaved) {
  base::Random random(8);
  const auto world = building(8);
  const auto truth = drive(kTour);
  const auto wheels = slipping(random);
  for (const std::size_t pause : {std::size_t{0}, std::size_t{1}, std::size_t{150}, std::size_t{330}}) {
    LaserOdometry odometry;
    LaserOdometry resumed;
    for (std::size_t i = 0; i < std::min(pause + 60, truth.size()); ++i) {
      if (i == pause) {
        base::ByteWriter out;
        odometry.save(out);
        base::ByteReader in(out.bytes());
        resumed.load(in);
        EXPECT_EQ(in.left(), 0U);
        base::ByteWriter again;
        resumed.save(again);
        EXPECT_EQ(again.bytes(), out.bytes());
      }
      const auto points = lookFrom(world, truth[i], random);
      const auto step = i > 0 && i % 7 != 0 ? wheels(geometry::inverse(truth[i - 1]) * truth[i]) : std::nullopt;
      const auto estimate = odometry.track(points, step);
      if (i < pause) continue;
      const auto other = resumed.track(points, step);
      ASSERT_EQ(other.T_travel_body, estimate.T_travel_body) << i;
      ASSERT_EQ(other.covariance, estimate.covariance) << i;
      ASSERT_EQ(other.isLost, estimate.isLost) << i;
    }
  }
}

TEST(LaserOdometry, NeitherDriftsNorDoubtsWhileItStandsStill) {
  for (const bool hasWheels : {true, false}) {
    base::Random random(9);
    const auto world = building(9);
    // A corridor's end is far: what is not known is known less with each step that is counted.
    const auto truth = drive({{-8.0, 0.0}, {-2.0, 0.0}});
    LaserOdometry odometry;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const auto step = i > 0 ? geometry::inverse(truth[i - 1]) * truth[i] : Pose2{};
      odometry.track(lookFrom(world, truth[i], random), hasWheels ? std::optional(step) : std::nullopt);
    }
    Eigen::Matrix3d soon = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d late = Eigen::Matrix3d::Zero();
    LaserOdometry::Estimate estimate;
    for (int i = 0; i < 600; ++i) {
      estimate =
          odometry.track(lookFrom(world, truth.back(), random), hasWheels ? std::optional(Pose2{}) : std::nullopt);
      (i < 60 ? soon : late) += estimate.covariance;
    }
    const auto error = test::errorOf(estimate.T_travel_body, geometry::inverse(truth[0]) * truth.back());
    EXPECT_LT(error.metres, 0.05);
    EXPECT_LT(error.radians, 0.5 * kDegree);
    EXPECT_LT(std::sqrt(late.trace()), 0.01);
    EXPECT_LE(late.trace(), soon.trace() + 1e-8) << "nine times as long";
  }
}

}  // namespace
}  // namespace prodomos::localization

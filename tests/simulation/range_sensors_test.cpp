// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/range_sensors.hpp"

#include "support/simulated_rooms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

namespace prodomos::simulation {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// From a point within a rectangle around the origin to its wall.
double distanceToWall(const Eigen::Vector2d& from, double angle, const Eigen::Vector2d& size) {
  const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
  double nearest = 1e9;
  for (int axis = 0; axis < 2; ++axis) {
    if (std::abs(direction[axis]) < 1e-12) continue;
    const double wall = std::copysign(size[axis] / 2.0, direction[axis]);
    nearest = std::min(nearest, (wall - from[axis]) / direction[axis]);
  }
  return nearest;
}

RangeNoise exact() {
  return {.sigma = 0.0, .missing = 0.0};
}

TEST(Laser, MeasuresARoomAsGeometryHasIt) {
  const RayScene scene(test::emptyRoom({8.0, 5.0, 2.8}));
  base::Random random(1);
  const LaserModel model{.noise = exact()};
  // Moved and turned, so that frames matter.
  const geometry::Pose3 T_world_sensor = geometry::fromYawPitchRoll({1.2, -0.7, 0.4}, 0.6, 0.0, 0.0);
  const auto scan = castLaser(scene, T_world_sensor, geometry::Pose3::Identity(), model, random);
  ASSERT_EQ(scan.ranges.size(), 541U);
  EXPECT_NEAR(scan.firstAngle, -135.0 * kDegree, 1e-12);
  EXPECT_NEAR(scan.firstAngle + 540 * scan.angleStep, 135.0 * kDegree, 1e-9);
  for (std::size_t beam = 0; beam < scan.ranges.size(); ++beam) {
    const double angle = 0.6 + scan.firstAngle + static_cast<double>(beam) * scan.angleStep;
    EXPECT_NEAR(scan.ranges[beam], distanceToWall({1.2, -0.7}, angle, {8.0, 5.0}), 1e-4) << "beam " << beam;
  }
}

TEST(Laser, SeesTheFloorWhereItIsTilted) {
  const RayScene scene(test::emptyRoom({20.0, 20.0, 2.8}));
  base::Random random(1);
  const LaserModel model{.beams = 1, .firstAngle = 0.0, .aperture = 0.0, .noise = exact()};
  const double down = 20.0 * kDegree;
  const auto scan = castLaser(scene, geometry::fromYawPitchRoll({0.0, 0.0, 0.5}, 0.3, down, 0.0),
                              geometry::Pose3::Identity(), model, random);
  ASSERT_EQ(scan.ranges.size(), 1U);
  EXPECT_NEAR(scan.ranges[0], 0.5 / std::sin(down), 1e-4);
}

TEST(Laser, ErrsAsItsSigmaSays) {
  const RayScene scene(test::emptyRoom({8.0, 5.0, 2.8}));
  base::Random random(5, "laser");
  const LaserModel model{.noise = {.sigma = 0.03, .missing = 0.0}};
  double sum = 0.0;
  double squares = 0.0;
  int count = 0;
  for (int i = 0; i < 40; ++i) {
    const auto scan = castLaser(scene, geometry::fromYawPitchRoll({0.0, 0.0, 0.4}, 0.0, 0.0, 0.0),
                                geometry::Pose3::Identity(), model, random);
    for (std::size_t beam = 0; beam < scan.ranges.size(); ++beam) {
      const double angle = scan.firstAngle + static_cast<double>(beam) * scan.angleStep;
      const double error = scan.ranges[beam] - distanceToWall({0.0, 0.0}, angle, {8.0, 5.0});
      sum += error;
      squares += error * error;
      ++count;
    }
  }
  EXPECT_NEAR(sum / count, 0.0, 0.001);
  EXPECT_NEAR(std::sqrt(squares / count), 0.03, 0.001);
}

TEST(Laser, HasNoReturnBeyondItsRangeFromGlassAndFromBlack) {
  base::Random random(1);
  const auto returned = [&](double infrared, double maxRange) {
    const RayScene scene(test::emptyRoom({8.0, 5.0, 2.8}, infrared));
    const LaserModel model{.noise = {.sigma = 0.0, .maxRange = maxRange, .missing = 0.0}};
    const auto scan = castLaser(scene, geometry::fromYawPitchRoll({0.0, 0.0, 0.4}, 0.0, 0.0, 0.0),
                                geometry::Pose3::Identity(), model, random);
    for (const float range : scan.ranges) EXPECT_TRUE(range == sensors::LaserScan::kNoReturn || range <= maxRange);
    return static_cast<double>(std::ranges::count_if(scan.ranges, [](float range) { return std::isfinite(range); })) /
           541.0;
  };
  EXPECT_EQ(returned(0.8, 30.0), 1.0);
  EXPECT_EQ(returned(0.0, 30.0), 0.0) << "glass";
  // Soot on a wall 2.5 m away: what comes back is 0.005 cos³ / 2.5², enough down to that cosine.
  const double least = std::cbrt(LaserModel{}.noise.leastSignal * 2.5 * 2.5 / 0.005);
  ASSERT_LT(least, 1.0);
  EXPECT_NEAR(returned(0.005, 30.0), 4.0 * std::acos(least) / (1.5 * std::numbers::pi), 0.01) << "soot";
  // Within 3 m of the middle lies a piece of either long wall.
  EXPECT_NEAR(returned(0.8, 3.0), 4.0 * std::acos(2.5 / 3.0) / (1.5 * std::numbers::pi), 0.01);
}

TEST(Laser, SaysNothingOfWhatIsTooNear) {
  const RayScene scene(test::emptyRoom({8.0, 5.0, 2.8}));
  base::Random random(1);
  const LaserModel model{.beams = 1, .firstAngle = 0.0, .aperture = 0.0, .noise = exact()};
  const auto scan = castLaser(scene, geometry::fromYawPitchRoll({3.95, 0.0, 0.4}, 0.0, 0.0, 0.0),
                              geometry::Pose3::Identity(), model, random);
  EXPECT_EQ(scan.ranges.at(0), sensors::LaserScan::kInvalid);
}

TEST(Laser, LosesTheShareOfBeamsItIsToldTo) {
  const RayScene scene(test::emptyRoom({8.0, 5.0, 2.8}));
  base::Random random(7, "laser");
  const LaserModel model{.beams = 20001, .noise = {.missing = 0.05}};
  const auto scan = castLaser(scene, geometry::fromYawPitchRoll({0.0, 0.0, 0.4}, 0.0, 0.0, 0.0),
                              geometry::Pose3::Identity(), model, random);
  EXPECT_NEAR(static_cast<double>(std::ranges::count(scan.ranges, sensors::LaserScan::kInvalid)), 1000.0, 120.0);
}

TEST(Laser, IsTheSameForTheSameSeed) {
  const RayScene scene(test::emptyRoom({8.0, 5.0, 2.8}));
  const auto scanOf = [&](std::uint64_t seed) {
    base::Random random(seed, "laser");
    return castLaser(scene, geometry::fromYawPitchRoll({0.0, 0.0, 0.4}, 0.0, 0.0, 0.0), geometry::Pose3::Identity(), {},
                     random)
        .ranges;
  };
  EXPECT_EQ(scanOf(1), scanOf(1));
  EXPECT_NE(scanOf(1), scanOf(2));
}

TEST(Lidar, HasItsRingsWhereTheDataSheetsHaveThem) {
  const auto sixteen = elevations16();
  ASSERT_EQ(sixteen.size(), 16U);
  for (std::size_t ring = 0; ring < 16; ++ring)
    EXPECT_NEAR(sixteen[ring], (2.0 * static_cast<double>(ring) - 15.0) * kDegree, 1e-12);
  const auto sixtyFour = elevations64();
  ASSERT_EQ(sixtyFour.size(), 64U);
  EXPECT_NEAR(sixtyFour.front(), -24.8 * kDegree, 1e-12);
  EXPECT_NEAR(sixtyFour.back(), 2.0 * kDegree, 1e-12);
  EXPECT_TRUE(std::ranges::is_sorted(sixtyFour));
}

TEST(Lidar, SeesPointsOnTheWallsAlongItsRings) {
  const RayScene scene(test::emptyRoom({12.0, 9.0, 2.8}));
  base::Random random(1);
  LidarModel model;
  model.noise = {.sigma = 0.0, .leastRange = 0.1, .leastSignal = 0.0, .missing = 0.0};
  const Eigen::Vector3d position(0.5, 0.3, 1.4);
  const auto cloud =
      castLidar(scene, geometry::fromYawPitchRoll(position, 0.0, 0.0, 0.0), geometry::Pose3::Identity(), model, random);
  ASSERT_EQ(cloud.points_in_sensor.size(), 16U * 900U);
  ASSERT_EQ(cloud.labels.size(), cloud.points_in_sensor.size());
  ASSERT_EQ(cloud.intensity.size(), cloud.points_in_sensor.size());
  std::set<std::uint16_t> classes;
  for (std::size_t i = 0; i < cloud.points_in_sensor.size(); ++i) {
    const Eigen::Vector3f& point = cloud.points_in_sensor[i];
    EXPECT_NEAR(std::asin(point.z() / point.norm()), model.elevations[i / 900], 1e-5);
    const Eigen::Vector3d in_world = point.cast<double>() + position;
    const double toWall = std::min(6.0 - std::abs(in_world.x()), 4.5 - std::abs(in_world.y()));
    EXPECT_NEAR(std::min({toWall, in_world.z(), 2.8 - in_world.z()}), 0.0, 1e-4);
    classes.insert(cloud.labels[i]);
  }
  EXPECT_EQ(classes, (std::set{classId("wall"), classId("floor"), classId("ceiling")}));
}

TEST(Lidar, LeavesOutWhatHasNoReturn) {
  const RayScene scene(test::emptyRoom({8.0, 5.0, 2.8}, 0.0));
  base::Random random(1);
  const auto cloud = castLidar(scene, geometry::fromYawPitchRoll({0.0, 0.0, 1.2}, 0.0, 0.0, 0.0),
                               geometry::Pose3::Identity(), {}, random);
  EXPECT_TRUE(cloud.points_in_sensor.empty());
}

}  // namespace
}  // namespace prodomos::simulation

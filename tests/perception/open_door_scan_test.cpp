// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/open_door_scan.hpp"

#include "prodomos/perception/open_door_detector.hpp"

#include "perception/flat_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace prodomos::perception {
namespace {

using Eigen::Vector2d;
using geometry::Pose2;
using test::FlatWorld;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kWidth = 0.9;   // metres
constexpr double kThick = 0.16;  // of the wall, whose near face is the x-axis

/// A corridor along the x-axis, below y = 0, with an opening about the origin into a room above.
FlatWorld corridor(double width = kWidth) {
  FlatWorld world;
  world.addWall({-8.0, -2.0}, {8.0, -2.0});
  for (const double side : {-1.0, 1.0}) {
    const double jamb = side * width / 2.0;
    world.addWall({side * 8.0, 0.0}, {jamb, 0.0});
    world.addWall({jamb, 0.0}, {jamb, kThick});
    world.addWall({jamb, kThick}, {side * 3.0, kThick});
    world.addWall({side * 3.0, kThick}, {side * 3.0, 4.0});
  }
  world.addWall({-3.0, 4.0}, {3.0, 4.0});
  return world;
}

/// At the left (-1) or the right jamb; `angle` from closed, positive into the room.
void addLeaf(FlatWorld& world, double side, double angle, double width = kWidth) {
  constexpr double kLeaf = 0.04;  // metres, its thickness
  const double closing = side > 0.0 ? std::numbers::pi - angle : angle;
  const Vector2d hinge(side * kWidth / 2.0, angle > 0.0 ? kThick : 0.0);
  const Vector2d along(std::cos(closing), std::sin(closing));
  const Vector2d inward = Vector2d(-side, 0.0);  // a leaf at right angles must not stand in its wall
  const Vector2d middle = hinge + 0.5 * width * along + 0.5 * kLeaf * inward;
  world.addBox({middle.x(), middle.y(), closing}, width, kLeaf);
}

std::vector<DoorSighting> sightings(const FlatWorld& world, const Pose2& T_world_body, base::Random* noise = nullptr) {
  return findOpenDoors(world.scan(T_world_body, noise), geometry::toPose3(T_world_body), 0.0, base::Time{}, {});
}

TEST(OpenDoorScan, ALeafInTheRoomTellsItsDoor) {
  base::Random noise(7, "noise");
  for (const double side : {-1.0, 1.0}) {
    for (const double angle : {30.0, 50.0, 70.0, 85.0, 95.0}) {
      auto world = corridor();
      addLeaf(world, side, angle * kDegree);
      const auto found = sightings(world, {-0.5 * side, -1.2, 0.5 * std::numbers::pi}, &noise);
      ASSERT_THAT(found, SizeIs(1)) << side << " " << angle;
      const auto& door = found[0];
      EXPECT_TRUE(door.door.hasLeaf);
      EXPECT_EQ(door.door.state, angle < 60.0 ? map::DoorState::kAjar : map::DoorState::kOpen) << angle;
      EXPECT_NEAR(door.openAngle, angle * kDegree, 3.0 * kDegree);
      EXPECT_NEAR(door.door.width, kWidth, 0.05) << angle;
      EXPECT_NEAR(door.T_submap_door.translation().x(), 0.0, 0.04);
      EXPECT_NEAR(door.T_submap_door.translation().y(), kThick, 0.08);
      EXPECT_NEAR(geometry::yaw(door.T_submap_door), 90.0 * kDegree, 2.0 * kDegree) << "away from the observer";
      EXPECT_EQ(door.door.hingeSide, side < 0.0 ? map::HingeSide::kLeft : map::HingeSide::kRight);
      EXPECT_EQ(door.hingeEvidence > 0.0, side < 0.0);
      EXPECT_GT(door.evidence, 0.0);
    }
  }
}

TEST(OpenDoorScan, ALeafTowardsTheObserverTellsItsDoor) {
  base::Random noise(8, "noise");
  for (const double angle : {40.0, 80.0}) {
    auto world = corridor();
    addLeaf(world, -1.0, -angle * kDegree);
    const auto found = sightings(world, {1.2, -1.0, 0.8 * std::numbers::pi}, &noise);
    ASSERT_THAT(found, SizeIs(1)) << angle;
    EXPECT_NEAR(found[0].openAngle, angle * kDegree, 5.0 * kDegree);
    EXPECT_NEAR(found[0].T_submap_door.translation().x(), 0.0, 0.08);
    EXPECT_NEAR(found[0].T_submap_door.translation().y(), 0.0, 0.1);
    EXPECT_EQ(found[0].door.hingeSide, map::HingeSide::kLeft);
  }
}

TEST(OpenDoorScan, IsTheSameHoweverTheWorldIsTurned) {
  auto world = corridor();
  addLeaf(world, -1.0, 80.0 * kDegree);
  const Pose2 T_world_body{0.5, -1.2, 0.5 * std::numbers::pi};
  const auto scan = world.scan(T_world_body);
  const auto inWorld = findOpenDoors(scan, geometry::toPose3(T_world_body), 0.0, base::Time{}, {});
  const Pose2 T_submap_world{5.0, -3.0, 2.1};
  const auto inSubmap = findOpenDoors(scan, geometry::toPose3(T_submap_world * T_world_body), 1.5, base::Time{}, {});
  ASSERT_THAT(inWorld, SizeIs(1));
  ASSERT_THAT(inSubmap, SizeIs(1));
  const auto expected = T_submap_world * geometry::toPose2(inWorld[0].T_submap_door);
  const auto actual = geometry::toPose2(inSubmap[0].T_submap_door);
  EXPECT_NEAR(actual.x, expected.x, 1e-6);
  EXPECT_NEAR(actual.y, expected.y, 1e-6);
  EXPECT_NEAR(geometry::normalizeAngle(actual.theta - expected.theta), 0.0, 1e-6);
  EXPECT_DOUBLE_EQ(inSubmap[0].T_submap_door.translation().z(), 1.5) << "on the floor";
}

TEST(OpenDoorScan, ASensorThatIsTurnedOnTheRobotSeesTheSame) {
  auto world = corridor();
  addLeaf(world, -1.0, 80.0 * kDegree);
  const Pose2 T_world_body{0.5, -1.2, 0.5 * std::numbers::pi};
  const auto T_body_sensor = geometry::fromYawPitchRoll({0.2, 0.1, 0.4}, 0.5, 0.0, 0.0);
  const auto scan = world.scan(T_world_body, nullptr, T_body_sensor);
  const auto found = findOpenDoors(scan, geometry::toPose3(T_world_body), 0.0, base::Time{}, {});
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_NEAR(found[0].T_submap_door.translation().x(), 0.0, 0.04);
}

TEST(OpenDoorScan, ADoorwayHasNoLeaf) {
  base::Random noise(9, "noise");
  const auto world = corridor();
  for (const double x : {-2.0, -1.0, 0.0, 1.0, 2.0})
    EXPECT_THAT(sightings(world, {x, -1.0, 0.5 * std::numbers::pi}, &noise), IsEmpty());
}

TEST(OpenDoorScan, AClosedDoorIsNotOpen) {
  auto world = corridor();
  world.addWall({-kWidth / 2.0, 0.05}, {kWidth / 2.0, 0.05});
  for (const double x : {-2.0, -1.0, 0.0, 1.0, 2.0})
    EXPECT_THAT(sightings(world, {x, -1.0, 0.5 * std::numbers::pi}), IsEmpty());
}

TEST(OpenDoorScan, WhatIsLongerOrShorterThanTheGapIsNoLeafOfIt) {
  for (const double width : {0.6, 1.5}) {
    auto world = corridor();
    addLeaf(world, -1.0, 80.0 * kDegree, width);
    EXPECT_THAT(sightings(world, {0.5, -1.2, 0.5 * std::numbers::pi}), IsEmpty()) << width;
  }
}

TEST(OpenDoorScan, WhatStandsAwayFromTheJambIsNoLeaf) {
  auto world = corridor();
  world.addBox({-0.1, 0.9, 85.0 * kDegree}, kWidth, 0.04);
  EXPECT_THAT(sightings(world, {0.5, -1.2, 0.5 * std::numbers::pi}), IsEmpty());
}

TEST(OpenDoorScan, TheWallOfASideCorridorIsNoLeaf) {
  FlatWorld world;
  world.addWall({-8.0, -2.0}, {8.0, -2.0});
  for (const double side : {-1.0, 1.0}) {
    world.addWall({side * 8.0, 0.0}, {side * 0.5, 0.0});
    world.addWall({side * 0.5, 0.0}, {side * 0.5, 6.0});
  }
  for (const double x : {-2.0, -1.0, 0.0, 1.0, 2.0})
    EXPECT_THAT(sightings(world, {x, -1.0, 0.5 * std::numbers::pi}), IsEmpty());
}

TEST(OpenDoorScan, BadScansInventNothing) {
  auto world = corridor();
  addLeaf(world, -1.0, 80.0 * kDegree);
  const Pose2 T_world_body{0.5, -1.2, 0.5 * std::numbers::pi};
  const auto T_submap_body = geometry::toPose3(T_world_body);
  const auto good = world.scan(T_world_body);
  const auto find = [&](const sensors::LaserScan& scan, const geometry::Pose3& T) {
    return findOpenDoors(scan, T, 0.0, base::Time{}, {});
  };
  ASSERT_THAT(find(good, T_submap_body), SizeIs(1));

  auto scan = good;
  scan.ranges.clear();
  EXPECT_THAT(find(scan, T_submap_body), IsEmpty());
  for (const float range : {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN(), sensors::LaserScan::kNoReturn}) {
    scan.ranges.assign(541, range);
    EXPECT_THAT(find(scan, T_submap_body), IsEmpty()) << range;
  }
  scan = good;
  scan.T_body_sensor = geometry::fromYawPitchRoll({0.0, 0.0, 0.35}, 0.0, 0.5, 0.0);
  EXPECT_THAT(find(scan, T_submap_body), IsEmpty()) << "a tilted sensor";
  scan = good;
  scan.T_body_sensor.translation().z() = 2.5;
  EXPECT_THAT(find(scan, T_submap_body), IsEmpty()) << "above doors";
  auto broken = T_submap_body;
  broken.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(find(good, broken), IsEmpty());
}

TEST(OpenDoorScan, CanBeSwitchedOff) {
  auto world = corridor();
  addLeaf(world, -1.0, 80.0 * kDegree);
  const Pose2 T_world_body{0.5, -1.2, 0.5 * std::numbers::pi};
  const auto scan = world.scan(T_world_body);
  OpenDoorDetectorConfig config;
  config.fromLaser = false;
  EXPECT_THAT(findOpenDoors(scan, geometry::toPose3(T_world_body), 0.0, base::Time{}, config), IsEmpty());
  config = {};
  config.enabled = false;
  EXPECT_THAT(findOpenDoors(scan, geometry::toPose3(T_world_body), 0.0, base::Time{}, config), IsEmpty());
}

}  // namespace
}  // namespace prodomos::perception

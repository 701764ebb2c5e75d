// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/open_door_detector.hpp"

#include "perception/depth_scene.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <optional>

namespace prodomos::perception {
namespace {

using geometry::Pose3;
using test::cameraAt;
using test::DepthScene;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kFar = 2.5;     // metres to the wall with the door, whose near face is at x = kFar
constexpr double kThick = 0.16;  // of it
constexpr double kHigh = 2.05;   // of the opening
constexpr double kCeiling = 2.8;

/// A wall across a room, with an opening from y = right to y = left.
DepthScene wallWithOpening(double right = -0.45, double left = 0.45, double bottom = 0.0, double top = kHigh) {
  DepthScene scene;
  const auto addWall = [&](double from, double to, double low, double high) {
    if (high <= low) return;
    scene.addBlock(geometry::fromYawPitchRoll({kFar, 0.5 * (from + to), low}, 0.0, 0.0, 0.0),
                   {kThick, to - from, high - low});
  };
  addWall(-6.0, right, 0.0, kCeiling);
  addWall(left, 6.0, 0.0, kCeiling);
  addWall(right, left, top, kCeiling);
  addWall(right, left, 0.0, bottom);
  return scene;
}

/// A leaf hinged at y = hinge, as wide as reaches the other jamb; `angle` from closed, positive: into the far room.
void addLeaf(DepthScene& scene, double hinge, double angle) {
  const double width = 0.9;
  const double closing = hinge > 0.0 ? -1.0 : 1.0;
  const double x = angle > 0.0 ? kFar + kThick - 0.02 : kFar + 0.02;
  const Pose3 axis = geometry::fromYawPitchRoll({x, hinge, 0.0}, closing * (0.5 * std::numbers::pi - angle), 0.0, 0.0);
  scene.addBlock(axis, {width, 0.04, 2.0});
}

std::vector<DoorSighting> sightings(const sensors::RgbdFrame& frame, const Pose3& T_submap_camera,
                                    double floor_z = 0.0) {
  const RgbdView view{.frame = frame, .T_submap_camera = T_submap_camera, .floor_z = floor_z};
  return findOpenDoors(view, findSurfaces(view, {}), {});
}

std::vector<DoorSighting> sightings(const DepthScene& scene, const Pose3& T_world_camera) {
  return sightings(scene.look(T_world_camera), T_world_camera);
}

const Pose3 kBefore = cameraAt({0.0, 0.0, 1.2}, 0.0);

TEST(OpenDoorDetector, FindsADoorwayWithoutALeaf) {
  const auto found = sightings(wallWithOpening(), kBefore);
  ASSERT_EQ(found.size(), 1U);
  const auto& doorway = found.front();
  EXPECT_FALSE(doorway.door.hasLeaf);
  EXPECT_EQ(doorway.door.state, map::DoorState::kOpen);
  EXPECT_NEAR(doorway.T_submap_door.translation().x(), kFar + 0.5 * kThick, 0.05);
  EXPECT_NEAR(doorway.T_submap_door.translation().y(), 0.0, 0.05);
  EXPECT_NEAR(doorway.T_submap_door.translation().z(), 0.0, 0.05);
  EXPECT_NEAR(geometry::yaw(doorway.T_submap_door), 0.0, 2.0 * kDegree) << "away from the observer";
  EXPECT_NEAR(doorway.door.width, 0.9, 0.07);
  EXPECT_NEAR(doorway.door.height, kHigh, 0.1);
  EXPECT_NEAR(doorway.range, kFar, 0.15);
  EXPECT_GT(doorway.evidence, 0.0);
  EXPECT_GT(doorway.widthSigma, 0.0);
}

TEST(OpenDoorDetector, FindsItFromTheSideAndInAMovedSubmap) {
  const auto scene = wallWithOpening();
  const Pose3 T_world_camera = cameraAt({0.6, -1.6, 1.2}, 40.0 * kDegree);
  const Pose3 T_submap_world = geometry::fromYawPitchRoll({-4.0, 7.0, 1.5}, 2.0, 0.0, 0.0);
  const auto found = sightings(scene.look(T_world_camera), T_submap_world * T_world_camera, 1.5);
  ASSERT_EQ(found.size(), 1U);
  const Pose3 T_world_door = T_submap_world.inverse() * found.front().T_submap_door;
  EXPECT_NEAR(T_world_door.translation().x(), kFar + 0.5 * kThick, 0.08);
  EXPECT_NEAR(T_world_door.translation().y(), 0.0, 0.08);
  EXPECT_NEAR(geometry::yaw(T_world_door), 0.0, 3.0 * kDegree);
}

TEST(OpenDoorDetector, TellsALeafThatStandsOpenIntoTheFarRoom) {
  auto scene = wallWithOpening();
  addLeaf(scene, -0.45, 80.0 * kDegree);
  const auto found = sightings(scene, cameraAt({0.4, 0.9, 1.2}, -20.0 * kDegree));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found.front().door.hasLeaf);
  EXPECT_EQ(found.front().door.state, map::DoorState::kOpen);
  EXPECT_EQ(found.front().door.hingeSide, map::HingeSide::kRight);
  EXPECT_LT(found.front().hingeEvidence, 0.0);
  EXPECT_NEAR(found.front().openAngle, 80.0 * kDegree, 8.0 * kDegree);
}

TEST(OpenDoorDetector, TellsALeafThatIsAjarIntoTheFarRoom) {
  for (const double hinge : {-0.45, 0.45}) {
    auto scene = wallWithOpening();
    addLeaf(scene, hinge, 35.0 * kDegree);
    const auto found = sightings(scene, kBefore);
    ASSERT_EQ(found.size(), 1U) << hinge;
    EXPECT_TRUE(found.front().door.hasLeaf) << hinge;
    EXPECT_EQ(found.front().door.state, map::DoorState::kAjar) << hinge;
    EXPECT_EQ(found.front().door.hingeSide, hinge > 0.0 ? map::HingeSide::kLeft : map::HingeSide::kRight);
    EXPECT_NEAR(found.front().openAngle, 35.0 * kDegree, 8.0 * kDegree) << hinge;
  }
}

TEST(OpenDoorDetector, TellsALeafThatIsAjarTowardsTheObserver) {
  auto scene = wallWithOpening();
  addLeaf(scene, 0.45, -20.0 * kDegree);
  const auto found = sightings(scene, kBefore);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found.front().door.hasLeaf);
  EXPECT_EQ(found.front().door.state, map::DoorState::kAjar);
  EXPECT_EQ(found.front().door.hingeSide, map::HingeSide::kLeft);
  EXPECT_NEAR(found.front().T_submap_door.translation().y(), 0.0, 0.08);
}

TEST(OpenDoorDetector, AClosedLeafInItsRecessIsNotOpen) {
  auto scene = wallWithOpening();
  scene.addBlock(geometry::fromYawPitchRoll({kFar + 0.1, 0.0, 0.0}, 0.0, 0.0, 0.0), {0.04, 0.9, kHigh});
  EXPECT_TRUE(sightings(scene, kBefore).empty());
}

TEST(OpenDoorDetector, AWindowIsNone) {
  EXPECT_TRUE(sightings(wallWithOpening(-0.5, 0.5, 0.9, 2.0), kBefore).empty());
}

TEST(OpenDoorDetector, AHatchIsNone) {
  EXPECT_TRUE(sightings(wallWithOpening(-0.5, 0.5, 0.0, 1.5), kBefore).empty());
}

TEST(OpenDoorDetector, ANicheIsNone) {
  auto scene = wallWithOpening();
  scene.addBlock(geometry::fromYawPitchRoll({kFar + 0.4, 0.0, 0.0}, 0.0, 0.0, 0.0), {0.1, 2.0, kCeiling});
  EXPECT_TRUE(sightings(scene, kBefore).empty());
}

TEST(OpenDoorDetector, TheMouthOfACorridorIsNone) {
  EXPECT_TRUE(sightings(wallWithOpening(-0.9, 0.9, 0.0, kCeiling), kBefore).empty());
}

TEST(OpenDoorDetector, AWallAndACupboardAreNone) {
  auto scene = wallWithOpening(6.0, 6.0);
  scene.addBlock(geometry::fromYawPitchRoll({kFar - 0.5, 0.8, 0.0}, 0.0, 0.0, 0.0), {0.5, 0.9, 1.9});
  EXPECT_TRUE(sightings(scene, kBefore).empty());
  EXPECT_TRUE(sightings(scene, cameraAt({0.4, -1.4, 1.2}, 35.0 * kDegree)).empty());
}

TEST(OpenDoorDetector, BadInputInventsNothing) {
  sensors::RgbdFrame frame = wallWithOpening().look(kBefore);
  sensors::RgbdFrame bad = frame;
  bad.depth = {frame.depth.width(), frame.depth.height(), 0.0F};
  EXPECT_TRUE(sightings(bad, kBefore).empty());
  bad.depth = {frame.depth.width(), frame.depth.height(), std::numeric_limits<float>::quiet_NaN()};
  EXPECT_TRUE(sightings(bad, kBefore).empty());
  EXPECT_TRUE(sightings(frame, cameraAt({0.0, 0.0, 1.2}, 0.0, 0.0, std::numbers::pi)).empty()) << "upside down";
  const RgbdView view{.frame = frame, .T_submap_camera = kBefore};
  EXPECT_TRUE(findOpenDoors(view, findSurfaces(view, {}), {.enabled = false}).empty());
}

TEST(OpenDoorDetector, DrawsTheWallWithItsOpeningAndLeaf) {
  const test::TemporaryFolder folder;
  DebugImages debug(folder.path());
  const auto frame = wallWithOpening().look(kBefore);
  const RgbdView view{.frame = frame, .T_submap_camera = kBefore};
  findOpenDoors(view, findSurfaces(view, {}), {}, &debug);
  EXPECT_FALSE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace prodomos::perception

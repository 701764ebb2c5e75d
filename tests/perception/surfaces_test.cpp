// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/surfaces.hpp"

#include "perception/depth_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

namespace prodomos::perception {
namespace {

using geometry::Pose3;
using test::cameraAt;
using test::DepthScene;

Surfaces surfacesOf(const sensors::RgbdFrame& frame, const Pose3& T_submap_camera, double floor_z = 0.0,
                    const sensors::Mask* movers = nullptr) {
  return findSurfaces({.frame = frame, .T_submap_camera = T_submap_camera, .floor_z = floor_z, .movers = movers}, {});
}

/// Patches within 5 cm and 3 degrees of the plane.
std::vector<PlanarPatch> patchesOn(const Surfaces& surfaces, const geometry::Plane& plane) {
  std::vector<PlanarPatch> found;
  std::ranges::copy_if(surfaces.patches, std::back_inserter(found), [&](const PlanarPatch& patch) {
    return patch.plane_in_submap.normal.dot(plane.normal) > std::cos(0.05) &&
           std::abs(plane.signedDistance(patch.centroid_in_submap)) < 0.05;
  });
  return found;
}

TEST(Surfaces, AreWallsAndFloorOfARoom) {
  const DepthScene scene({5.0, 4.0, 2.8});
  const Pose3 T_world_camera = cameraAt({-1.5, 0.0, 1.2}, 0.2);
  const Surfaces surfaces = surfacesOf(scene.look(T_world_camera), T_world_camera);
  const auto front = patchesOn(surfaces, {-Eigen::Vector3d::UnitX(), -2.5});
  const auto left = patchesOn(surfaces, {-Eigen::Vector3d::UnitY(), -2.0});
  const auto floor = patchesOn(surfaces, {Eigen::Vector3d::UnitZ(), 0.0});
  ASSERT_EQ(front.size(), 1U);
  ASSERT_EQ(left.size(), 1U);
  ASSERT_EQ(floor.size(), 1U);
  EXPECT_GT(front[0].area, 4.0);
  EXPECT_NEAR(front[0].tilt(), std::numbers::pi / 2.0, 0.02);
  EXPECT_NEAR(floor[0].tilt(), 0.0, 0.02);
  EXPECT_TRUE(surfaces.floorIsSeen);
  EXPECT_NEAR(surfaces.floor_z, 0.0, 0.01);
}

TEST(Surfaces, AreTheSameSeenFromAMovedAndRolledCamera) {
  const DepthScene scene({5.0, 4.0, 2.8});
  const Pose3 T_world_camera = cameraAt({-1.0, 0.5, 1.5}, -0.3, 0.3, 0.4);
  const Pose3 T_submap_world = geometry::fromYawPitchRoll({3.0, -7.0, 2.0}, 2.1, 0.0, 0.0);
  const Surfaces surfaces = surfacesOf(scene.look(T_world_camera), T_submap_world * T_world_camera, 2.1);
  EXPECT_TRUE(surfaces.floorIsSeen);
  EXPECT_NEAR(surfaces.floor_z, 2.0, 0.01);
  const Eigen::Vector3d normal = T_submap_world.linear() * -Eigen::Vector3d::UnitX();
  const Eigen::Vector3d onWall = T_submap_world * Eigen::Vector3d(2.5, 0.0, 1.0);
  EXPECT_EQ(patchesOn(surfaces, {normal, normal.dot(onWall)}).size(), 1U);
}

TEST(Surfaces, KeepAFarWallInOnePiece) {
  const DepthScene scene({14.0, 6.0, 2.8});
  for (const double distance : {4.2, 4.5, 4.8}) {
    const Pose3 T_world_camera = cameraAt({7.0 - distance, 0.0, 1.2}, 0.1);
    const Surfaces surfaces = surfacesOf(scene.look(T_world_camera), T_world_camera);
    double largest = 0.0;
    double all = 0.0;
    for (const PlanarPatch& patch : surfaces.patches) {
      if (std::abs(patch.plane_in_submap.normal.x()) < 0.9) continue;
      largest = std::max(largest, patch.area);
      all += patch.area;
    }
    EXPECT_GT(largest, 0.95 * all) << distance;
    EXPECT_GT(largest, 4.0) << distance;
  }
}

TEST(Surfaces, GiveEachCellToOnePatch) {
  DepthScene scene;
  scene.addBlock(Pose3(Eigen::Translation3d(1.5, 0.0, 0.0)), {0.6, 0.8, 0.7});
  const Pose3 T_world_camera = cameraAt({0.0, 0.0, 1.2}, 0.0, 0.2);
  const Surfaces surfaces = surfacesOf(scene.look(T_world_camera), T_world_camera);
  std::set<std::uint32_t> taken;
  for (const PlanarPatch& patch : surfaces.patches) {
    EXPECT_TRUE(std::ranges::is_sorted(patch.cells));
    for (const std::uint32_t cell : patch.cells) EXPECT_TRUE(taken.insert(cell).second);
    // The normal is turned to the camera.
    EXPECT_GT(patch.plane_in_submap.signedDistance(T_world_camera.translation()), 0.0);
  }
  EXPECT_TRUE(std::ranges::is_sorted(surfaces.patches, std::ranges::greater{}, &PlanarPatch::area));
  EXPECT_TRUE(std::ranges::is_sorted(surfaces.voxels));
}

TEST(Surfaces, TellABoxFromTheFloor) {
  DepthScene scene;
  scene.addBlock(Pose3(Eigen::Translation3d(1.5, 0.0, 0.0)), {0.6, 0.8, 0.7});
  const Pose3 T_world_camera = cameraAt({-0.5, 0.0, 1.2}, 0.0, 0.2);
  const Surfaces surfaces = surfacesOf(scene.look(T_world_camera), T_world_camera);
  const auto top = patchesOn(surfaces, {Eigen::Vector3d::UnitZ(), 0.7});
  const auto front = patchesOn(surfaces, {-Eigen::Vector3d::UnitX(), -1.5});
  ASSERT_EQ(top.size(), 1U);
  ASSERT_EQ(front.size(), 1U);
  EXPECT_NEAR(top[0].area, 0.48, 0.06);
  EXPECT_NEAR(front[0].area, 0.56, 0.06);
}

TEST(Surfaces, AreTheSameEachTime) {
  const DepthScene scene;
  const Pose3 T_world_camera = cameraAt({2.0, 0.0, 1.2}, 0.4);
  const sensors::RgbdFrame frame = scene.look(T_world_camera);
  const Surfaces once = surfacesOf(frame, T_world_camera);
  const Surfaces again = surfacesOf(frame, T_world_camera);
  ASSERT_EQ(once.patches.size(), again.patches.size());
  for (std::size_t i = 0; i < once.patches.size(); ++i) {
    EXPECT_EQ(once.patches[i].cells, again.patches[i].cells);
    EXPECT_EQ(once.patches[i].plane_in_submap.offset, again.patches[i].plane_in_submap.offset);
  }
}

TEST(Surfaces, LeaveOutWhatMoves) {
  const DepthScene scene;
  const Pose3 T_world_camera = cameraAt({3.0, 0.0, 1.2}, 0.0);
  const sensors::RgbdFrame frame = scene.look(T_world_camera);
  const sensors::Mask everything(frame.depth.width(), frame.depth.height(), 1);
  EXPECT_TRUE(surfacesOf(frame, T_world_camera, 0.0, &everything).patches.empty());
}

TEST(Surfaces, SayTheFloorOfTheViewWhereTheyShowNone) {
  const DepthScene scene;
  const Pose3 T_world_camera = cameraAt({4.5, 0.0, 1.2}, 0.0, -0.6);
  const Surfaces surfaces = surfacesOf(scene.look(T_world_camera), T_world_camera, 0.05);
  EXPECT_FALSE(surfaces.floorIsSeen);
  EXPECT_EQ(surfaces.floor_z, 0.05);
}

TEST(Surfaces, DoNotTakeACeilingForTheFloor) {
  // Upside down in a pose that says otherwise.
  const DepthScene scene;
  const Pose3 T_world_camera = cameraAt({2.0, 0.0, 1.2}, 0.0, 0.0, std::numbers::pi);
  const Surfaces believed = surfacesOf(scene.look(T_world_camera), cameraAt({2.0, 0.0, 1.2}, 0.0));
  EXPECT_FALSE(believed.floorIsSeen);
  // And in the true pose all is well.
  EXPECT_TRUE(surfacesOf(scene.look(T_world_camera), T_world_camera).floorIsSeen);
}

TEST(Surfaces, AreNoneWithoutUsableDepth) {
  const Pose3 T_world_camera = cameraAt({0.0, 0.0, 1.2}, 0.0);
  sensors::RgbdFrame frame;
  frame.camera = {525.0, 525.0, 319.5, 239.5, {}};
  EXPECT_TRUE(surfacesOf(frame, T_world_camera).patches.empty());
  for (const float depth :
       {0.0F, -1.0F, 100.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    frame.depth = sensors::Image<float>(640, 480, depth);
    EXPECT_TRUE(surfacesOf(frame, T_world_camera).patches.empty()) << depth;
  }
  frame.depth = sensors::Image<float>(640, 480, 2.0F);
  EXPECT_FALSE(surfacesOf(frame, T_world_camera).patches.empty());
  Pose3 nowhere = T_world_camera;
  nowhere.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(surfacesOf(frame, nowhere).patches.empty());
  frame.camera.fx = 0.0;
  EXPECT_TRUE(surfacesOf(frame, T_world_camera).patches.empty());
  frame.camera.fx = 525.0;
  frame.depth = sensors::Image<float>(3, 2, 2.0F);
  EXPECT_TRUE(surfacesOf(frame, T_world_camera).patches.empty());
}

}  // namespace
}  // namespace prodomos::perception

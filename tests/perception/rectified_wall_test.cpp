// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/rectified_wall.hpp"

#include "support/door_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prodomos::perception {
namespace {

using test::DoorScene;
using test::DrawnDoor;

constexpr double kStraight = std::numbers::pi / 2.0;

/// What a camera at (x, y) sees, and its planes. The frame must live as long as the view.
struct Scene {
  Scene(const DoorScene& drawn, double x, double y, double yaw)
      : frame(drawn.see(x, y, yaw)),
        view{.frame = frame, .T_submap_camera = DoorScene::cameraPose(x, y, yaw), .floor_z = 0.0},
        surfaces(findSurfaces(view, SurfacesConfig{})) {}
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  sensors::RgbdFrame frame;
  RgbdView view;
  Surfaces surfaces;
};

bool isLike(const cv::Vec3b& pixel, int r, int g, int b) {
  const double sum = pixel[0] + pixel[1] + pixel[2] + 1.0;
  const double like = r + g + b;
  return std::abs(pixel[0] / sum - r / like) < 0.05 && std::abs(pixel[1] / sum - g / like) < 0.05 &&
         std::abs(pixel[2] / sum - b / like) < 0.05;
}

TEST(RectifiedWall, WallsFrameLiesBelowTheCamerasFoot) {
  const Scene scene(DoorScene({}), 0.7, -2.5, kStraight + 0.3);
  const auto walls = findWalls(scene.view, scene.surfaces);
  ASSERT_FALSE(walls.empty());
  EXPECT_NEAR(walls[0].distance, 2.5, 0.03);
  EXPECT_NEAR(walls[0].cameraHeight, DoorScene::cameraHeight(), 0.03);
  EXPECT_NEAR(walls[0].T_submap_wall.translation().x(), 0.7, 0.05);
  EXPECT_NEAR(walls[0].T_submap_wall.translation().y(), 0.0, 0.03);
  EXPECT_GT(walls[0].T_submap_wall.linear()(0, 0), 0.99);  // to the observer's right
  EXPECT_GT(walls[0].T_submap_wall.linear()(1, 1), 0.99);  // away
}

TEST(RectifiedWall, LeafAndWallAroundItAreOneWall) {
  const Scene scene(DoorScene({DrawnDoor{.recess = 0.12}}), 0.0, -3.0, kStraight);
  EXPECT_EQ(findWalls(scene.view, scene.surfaces).size(), 1U);
}

TEST(RectifiedWall, ColorsLieWhereTheyAreOnTheWall) {
  DoorScene drawn({});
  drawn.add({0.5, -0.01, 0.9}, {1.1, 0.0, 1.6}, {200, 40, 40}, "poster");
  const Scene scene(drawn, -1.0, -2.2, kStraight - 0.4);
  const auto walls = findWalls(scene.view, scene.surfaces);
  ASSERT_FALSE(walls.empty());
  const RectifiedWall wall(scene.view, scene.surfaces, walls[0], 8.0);
  ASSERT_FALSE(wall.empty());
  const auto at = [&](double x, double z) {
    const double x_in_wall = x - walls[0].T_submap_wall.translation().x();
    return wall.color().at<cv::Vec3b>(static_cast<int>(std::lround(wall.rowOf(z))),
                                      static_cast<int>(std::lround(wall.columnOf(x_in_wall))));
  };
  for (const auto& [x, z] : {std::pair{0.58, 0.98}, {1.02, 1.52}, {0.58, 1.52}, {1.02, 0.98}}) {
    EXPECT_TRUE(isLike(at(x, z), 200, 40, 40)) << x << ' ' << z;
  }
  for (const auto& [x, z] : {std::pair{0.42, 1.2}, {1.18, 1.2}, {0.8, 0.82}, {0.8, 1.68}}) {
    EXPECT_FALSE(isLike(at(x, z), 200, 40, 40)) << x << ' ' << z;
  }
}

TEST(RectifiedWall, TellsWhatHidesItAndWhatLiesBeyond) {
  DoorScene drawn({DrawnDoor{.left = 0.6, .leaves = 0}});
  drawn.add({-1.2, -0.6, 0.0}, {-0.5, -0.1, 1.0}, {120, 120, 125}, "cupboard");
  const Scene scene(drawn, 0.0, -3.4, kStraight);
  const auto walls = findWalls(scene.view, scene.surfaces);
  ASSERT_FALSE(walls.empty());
  const RectifiedWall wall(scene.view, scene.surfaces, walls[0], 8.0);
  const auto seenAt = [&](double x, double z) {
    return wall.seen(static_cast<int>(wall.columnOf(x)), static_cast<int>(wall.rowOf(z)));
  };
  EXPECT_EQ(seenAt(-0.9, 0.5), Seen::kHiding);
  EXPECT_EQ(seenAt(0.0, 1.2), Seen::kWall);
  EXPECT_EQ(seenAt(0.8, 1.2), Seen::kBeyond);
}

TEST(RectifiedWall, PlanesBehindAreDrawnTogether) {
  const Scene scene(DoorScene({}), 0.0, -2.0, kStraight);
  const auto walls = findWalls(scene.view, scene.surfaces);
  ASSERT_FALSE(walls.empty());
  const RectifiedWall wall(scene.view, scene.surfaces, walls[0], 8.0);
  EXPECT_NEAR(wall.shrinkage(0.0), 1.0, 1e-12);
  EXPECT_NEAR(wall.shrinkage(2.0), 0.5, 0.01);
}

}  // namespace
}  // namespace prodomos::perception

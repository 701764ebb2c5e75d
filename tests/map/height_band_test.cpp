// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/occupancy_grid.hpp"
#include "prodomos/map/point_layer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

/// What grid and points take from sensors that see in three dimensions: a room with a floor, a table and a wall, seen
/// by a camera and by a lidar that never err.
namespace prodomos::map {
namespace {

/// Floor at z = 0; a wall at x = 4; a table top 0.7 m high for x in [2, 2.6], |y| <= 0.5; a lamp 2.2 m high at x = 1.5.
class Room {
 public:
  bool hasTable = true;
  bool hasSill = false;  ///< 0.1 m high, all along x in [2, 2.1]

  /// Distance along the ray to the first thing; none where it leaves the room.
  std::optional<double> range(const Eigen::Vector3d& origin, const Eigen::Vector3d& way) const {
    std::optional<double> nearest;
    const auto meet = [&](double distance, bool inside) {
      if (inside && distance > 1e-9 && (!nearest || distance < *nearest)) nearest = distance;
    };
    const auto at = [&](double distance) -> Eigen::Vector3d { return origin + distance * way; };
    meet(-origin.z() / way.z(), true);
    meet((kWall - origin.x()) / way.x(), true);
    if (hasTable) {
      const double top = (0.7 - origin.z()) / way.z();
      meet(top, at(top).x() >= 2.0 && at(top).x() <= 2.6 && std::abs(at(top).y()) <= 0.5);
      const double front = (2.0 - origin.x()) / way.x();
      meet(front, at(front).z() >= 0.6 && at(front).z() <= 0.7 && std::abs(at(front).y()) <= 0.5);
    }
    if (hasSill) {
      const double front = (2.0 - origin.x()) / way.x();
      meet(front, at(front).z() >= 0.0 && at(front).z() <= 0.1);
    }
    const double lamp = (1.5 - origin.x()) / way.x();
    meet(lamp, at(lamp).z() >= 2.2 && at(lamp).z() <= 2.4);
    return nearest;
  }

  static constexpr double kWall = 4.0;
};

constexpr int kWidth = 160;
constexpr int kHeight = 120;

sensors::RgbdFrame look(const Room& room, const geometry::Pose3& T_body_camera, const geometry::Pose3& T_map_body) {
  sensors::RgbdFrame frame;
  frame.T_body_camera = T_body_camera;
  frame.camera = {.fx = 110.0, .fy = 110.0, .cx = (kWidth - 1) / 2.0, .cy = (kHeight - 1) / 2.0, .distortion = {}};
  frame.depth = sensors::Image<float>(kWidth, kHeight);
  const geometry::Pose3 T_map_camera = T_map_body * T_body_camera;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Eigen::Vector3d way((x - frame.camera.cx) / frame.camera.fx, (y - frame.camera.cy) / frame.camera.fy, 1.0);
      // The way is 1 long along the camera's z, so that the distance is the depth.
      const auto depth = room.range(T_map_camera.translation(), T_map_camera.linear() * way);
      frame.depth(x, y) = depth ? static_cast<float>(*depth) : 0.0F;
    }
  }
  return frame;
}

sensors::PointCloud sweep(const Room& room, const geometry::Pose3& T_body_sensor, const geometry::Pose3& T_map_body) {
  sensors::PointCloud cloud;
  cloud.T_body_sensor = T_body_sensor;
  const geometry::Pose3 T_map_sensor = T_map_body * T_body_sensor;
  for (int ring = -30; ring <= 30; ++ring) {
    for (int turn = -90; turn <= 90; ++turn) {
      const double up = ring * std::numbers::pi / 180.0;
      const double left = turn * std::numbers::pi / 360.0;
      const Eigen::Vector3d way(std::cos(up) * std::cos(left), std::cos(up) * std::sin(left), std::sin(up));
      const auto distance = room.range(T_map_sensor.translation(), T_map_sensor.linear() * way);
      if (distance) cloud.points_in_sensor.push_back((*distance * way).cast<float>());
    }
  }
  return cloud;
}

geometry::Pose3 cameraPose(double pitch, double roll = 0.0) {
  return geometry::fromYawPitchRoll({0.1, 0.0, 1.0}, 0.0, pitch, roll) * sensors::cameraAxesInBody();
}

OccupancyGrid gridOf(sensors::ReadingData data, const geometry::Pose3& T_submap_body,
                     const sensors::Mask* movers = nullptr) {
  OccupancyGridConfig config;
  config.resolution = 0.1;
  OccupancyGrid grid(config);
  const sensors::Reading reading{.time = {}, .sensor = "s", .data = std::move(data)};
  EXPECT_TRUE(grid.integrate({.reading = reading, .T_submap_body = T_submap_body, .movers = movers}));
  return grid;
}

/// Columns of the row that runs ahead of the robot, at a height seen from above.
std::optional<double> firstOccupied(const OccupancyGrid& grid, double y) {
  for (double x = 0.05; x < 6.0; x += 0.1) {
    if (grid.state(grid.cellAt({x, y})) == CellState::kOccupied) return x;
  }
  return std::nullopt;
}

struct View {
  const char* name;
  double pitch;
  double roll;
  bool lidar;
};

class HeightBand3d : public testing::TestWithParam<View> {
 protected:
  OccupancyGrid see(const Room& room) const {
    const auto& view = GetParam();
    const auto T_map_body = geometry::Pose3::Identity();
    if (!view.lidar) return gridOf(look(room, cameraPose(view.pitch, view.roll), T_map_body), T_map_body);
    const auto T_body_sensor = geometry::fromYawPitchRoll({0.1, 0.0, 1.0}, 0.0, view.pitch, view.roll);
    return gridOf(sweep(room, T_body_sensor, T_map_body), T_map_body);
  }
};

TEST_P(HeightBand3d, TheFloorIsFreeAndTheWallAnObstacle) {
  Room room;
  room.hasTable = false;
  const auto grid = see(room);
  for (const double y : {-0.75, 0.05, 0.85}) {
    ASSERT_TRUE(firstOccupied(grid, y)) << y;
    EXPECT_NEAR(*firstOccupied(grid, y), Room::kWall, 0.11) << y;
    for (double x = 0.55; x < 3.8; x += 0.1) {
      if (std::abs(y) > 0.4 * x) continue;  // beside the picture
      EXPECT_EQ(grid.state(grid.cellAt({x, y})), CellState::kFree) << x << ", " << y;
    }
  }
}

TEST_P(HeightBand3d, ATableIsAnObstacleThoughFloorIsSeenBehindIt) {
  const auto grid = see(Room());
  ASSERT_TRUE(firstOccupied(grid, 0.05));
  EXPECT_NEAR(*firstOccupied(grid, 0.05), 2.05, 0.11);
  ASSERT_TRUE(firstOccupied(grid, 1.25));
  EXPECT_NEAR(*firstOccupied(grid, 1.25), Room::kWall, 0.11) << "beside the table";
}

TEST_P(HeightBand3d, ALowSillIsNone) {
  Room room;
  room.hasTable = false;
  room.hasSill = true;
  const auto grid = see(room);
  ASSERT_TRUE(firstOccupied(grid, 0.05));
  EXPECT_NEAR(*firstOccupied(grid, 0.05), Room::kWall, 0.11);
}

INSTANTIATE_TEST_SUITE_P(Views, HeightBand3d,
                         testing::Values(View{"camera_level", 0.0, 0.0, false}, View{"camera_down", 0.3, 0.0, false},
                                         View{"camera_tilted", 0.2, 0.25, false}, View{"lidar_level", 0.0, 0.0, true},
                                         View{"lidar_tilted", 0.2, -0.15, true}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(HeightBand, MovesWithTheRobot) {
  // The same room from elsewhere, in a sub-map of its own: what is seen lies where it lies.
  const auto T_map_body = geometry::toPose3({0.5, 0.3, 0.2});
  const auto grid = gridOf(look(Room(), cameraPose(0.1), T_map_body), T_map_body);
  ASSERT_TRUE(firstOccupied(grid, 0.35));
  EXPECT_NEAR(*firstOccupied(grid, 0.35), 2.05, 0.11);
}

TEST(HeightBand, ASinglePointIsNoise) {
  sensors::PointCloud cloud;
  cloud.points_in_sensor = {{2.0F, 0.001F, 1.0F}};
  EXPECT_EQ(firstOccupied(gridOf(cloud, geometry::Pose3::Identity()), 0.0), std::nullopt);
  cloud.points_in_sensor.push_back({2.0F, 0.001F, 1.1F});
  EXPECT_NE(firstOccupied(gridOf(cloud, geometry::Pose3::Identity()), 0.0), std::nullopt);
}

TEST(HeightBand, PointsThatAreNotANumberAreLeftOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  sensors::PointCloud cloud;
  cloud.points_in_sensor = {{nan, 0, 1}, {2, nan, 1}, {2, 0, nan}, {std::numeric_limits<float>::infinity(), 0, 1}};
  EXPECT_TRUE(gridOf(cloud, geometry::Pose3::Identity()).knownBox().empty());
  PointLayer points;
  const sensors::Reading reading{.time = {}, .sensor = "s", .data = cloud};
  points.integrate({.reading = reading});
  EXPECT_TRUE(points.points().empty());
}

TEST(HeightBand, MoversInACloudAreLeftOut) {
  Room room;
  room.hasTable = false;
  const auto pose = geometry::Pose3::Identity();
  const auto T_body_sensor = geometry::fromYawPitchRoll({0.1, 0, 1.0}, 0, 0, 0);
  auto cloud = sweep(room, T_body_sensor, pose);
  const auto walls = cloud.points_in_sensor.size();
  for (int i = 0; i < 20; ++i) cloud.points_in_sensor.emplace_back(1.5F, 0.0F, -0.5F + 0.02F * static_cast<float>(i));
  const int count = static_cast<int>(cloud.points_in_sensor.size());
  sensors::Mask movers(count, 1);
  for (int i = static_cast<int>(walls); i < count; ++i) movers(i, 0) = 1;

  EXPECT_NEAR(firstOccupied(gridOf(cloud, pose), 0.0).value_or(0), 1.6, 0.11);
  EXPECT_NEAR(firstOccupied(gridOf(cloud, pose, &movers), 0.0).value_or(0), Room::kWall, 0.11);
  PointLayer points;
  const sensors::Reading reading{.time = {}, .sensor = "s", .data = cloud};
  points.integrate({.reading = reading, .movers = &movers});
  for (const auto& point : points.points()) {
    EXPECT_FALSE(std::abs(point.position_in_submap.x() - 1.6F) < 0.01F && point.position_in_submap.z() > 0.4F);
  }
}

TEST(HeightBand, MoversInAnImageAreLeftOut) {
  const auto pose = geometry::Pose3::Identity();
  const auto frame = look(Room(), cameraPose(0.1), pose);
  sensors::Mask movers(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) movers(x, y) = frame.depth(x, y) < 2.7F;
  }
  EXPECT_NEAR(firstOccupied(gridOf(frame, pose), 0.05).value_or(0), 2.05, 0.11);
  EXPECT_NEAR(firstOccupied(gridOf(frame, pose, &movers), 0.05).value_or(0), Room::kWall, 0.11);
}

TEST(HeightBand, AnEmptyMaskSaysThatNothingMoves) {
  const sensors::Mask nothing;
  const auto pose = geometry::Pose3::Identity();
  const auto frame = look(Room(), cameraPose(0.1), pose);
  const auto cloud = sweep(Room(), geometry::fromYawPitchRoll({0.1, 0, 1.0}, 0, 0, 0), pose);
  EXPECT_NE(firstOccupied(gridOf(frame, pose, &nothing), 0.05), std::nullopt);
  EXPECT_NE(firstOccupied(gridOf(cloud, pose, &nothing), 0.05), std::nullopt);
  PointLayer points;
  for (const auto& reading : {sensors::Reading{.time = {}, .sensor = "s", .data = frame},
                              sensors::Reading{.time = {}, .sensor = "s", .data = cloud}}) {
    points.integrate({.reading = reading, .movers = &nothing});
  }
  EXPECT_FALSE(points.points().empty());
}

}  // namespace
}  // namespace prodomos::map

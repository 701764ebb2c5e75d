// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/surface_layer.hpp"

#include "prodomos/base/random.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace prodomos::map {
namespace {

using geometry::Pose2;

constexpr double kDegree = std::numbers::pi / 180.0;

std::vector<std::byte> bytesOf(const SurfaceLayer& layer) {
  base::ByteWriter out;
  layer.save(out);
  return out.take();
}

SurfaceLayer loaded(const std::vector<std::byte>& bytes) {
  SurfaceLayer layer;
  base::ByteReader in(bytes);
  layer.load(in, layer.version());
  EXPECT_EQ(in.left(), 0U);
  return layer;
}

/// The slow way: a mean in a map.
class SlowSurface {
 public:
  explicit SlowSurface(double resolution) : resolution_(resolution) {}

  void insert(const Eigen::Vector2d& point) {
    const Eigen::Vector2f rounded = point.cast<float>();
    const auto cell = geometry::cellAt(static_cast<double>(rounded.x()), static_cast<double>(rounded.y()), resolution_);
    auto& mean = means_[cell];
    mean.position += (rounded.cast<double>() - mean.position) / (mean.count + 1.0);
    mean.count = std::min(mean.count + 1.0, static_cast<double>(SurfaceLayer::kMostCount));
  }

  void expectEqual(const SurfaceLayer& layer) const {
    ASSERT_EQ(layer.points().size(), means_.size());
    for (const auto& point : layer.points()) {
      const auto position = point.position_in_submap();
      const auto found = means_.find(geometry::cellAt(position.x(), position.y(), resolution_));
      ASSERT_NE(found, means_.end());
      EXPECT_LT((position - found->second.position).norm(), 1e-5);
      EXPECT_EQ(static_cast<double>(point.count), found->second.count);
    }
  }

 private:
  struct Mean {
    Eigen::Vector2d position = Eigen::Vector2d::Zero();
    double count = 0.0;
  };
  double resolution_;
  std::map<geometry::CellIndex, Mean> means_;
};

Eigen::Vector2d randomPoint(base::Random& random, double reach) {
  return {random.uniform(-reach, reach), random.uniform(-reach, reach)};
}

SurfaceLayer randomSurface(std::uint64_t seed, int count = 500) {
  base::Random random(seed);
  SurfaceLayer layer;
  for (int i = 0; i < count; ++i) {
    layer.insert(randomPoint(random, 5.0));
    if (i % 20 == 0) layer.addViewpoint(randomPoint(random, 5.0));
  }
  return layer;
}

sensors::Reading scanOf(std::vector<float> ranges) {
  sensors::LaserScan scan;
  scan.firstAngle = -0.2;
  scan.angleStep = 0.1;
  scan.maxRange = 50.0;
  scan.ranges = std::move(ranges);
  return {.time = {}, .sensor = "laser", .data = scan};
}

TEST(SurfaceLayer, HoldsTheMeanOfThePointsInEachCell) {
  for (const double resolution : {0.05, 0.2, 1.0}) {
    base::Random random(3);
    SurfaceLayer layer({.resolution = resolution});
    SlowSurface slow(resolution);
    // Ever farther out, so that storage grows to all sides; some cells are hit more often than is counted.
    for (int i = 0; i < 20000; ++i) {
      const auto point = randomPoint(random, i < 15000 ? 1.0 + i * 2e-4 : 40.0);
      slow.insert(point);
      layer.insert(point);
    }
    slow.expectEqual(layer);
  }
}

TEST(SurfaceLayer, TellsWhetherACellWasHitForTheFirstTime) {
  SurfaceLayer layer;
  EXPECT_TRUE(layer.insert({0.01, 0.01}));
  EXPECT_FALSE(layer.insert({0.04, 0.03}));
  EXPECT_TRUE(layer.insert({-0.01, 0.01}));
}

TEST(SurfaceLayer, FollowsWhatMovesWithinACell) {
  SurfaceLayer layer({.resolution = 0.1});
  for (int i = 0; i < 1000; ++i) layer.insert({0.02, 0.05});
  for (int i = 0; i < 300; ++i) layer.insert({0.08, 0.05});
  ASSERT_EQ(layer.points().size(), 1U);
  EXPECT_NEAR(layer.points()[0].position_in_submap().x(), 0.08, 0.001);
}

TEST(SurfaceLayer, KnowsNormalAndDistanceOfAWallToAMillimetre) {
  base::Random random(4);
  for (int wall = 0; wall < 40; ++wall) {
    const Eigen::Vector2d middle = randomPoint(random, 20.0);
    const double angle = random.uniform(-std::numbers::pi, std::numbers::pi);
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d normal(-along.y(), along.x());
    SurfaceLayer layer;
    for (int i = 0; i < 2000; ++i) layer.insert(middle + random.uniform(-1.0, 1.0) * along);
    for (int i = 0; i < 50; ++i) {
      const double distance = random.uniform(-0.12, 0.12);
      const Eigen::Vector2d place = middle + random.uniform(-0.7, 0.7) * along + distance * normal;
      const auto patch = layer.patchAt(place);
      ASSERT_TRUE(patch);
      EXPECT_NEAR(std::abs(patch->normal.dot(normal)), 1.0, 1e-4);
      EXPECT_NEAR(patch->normal.norm(), 1.0, 1e-9);
      EXPECT_NEAR(std::abs(patch->normal.dot(place - patch->mean)), std::abs(distance), 1e-3);
      EXPECT_LT(patch->thickness, 1e-3);
      EXPECT_GT(patch->extent, 0.03);
    }
  }
}

TEST(SurfaceLayer, TellsAHeapFromAWall) {
  base::Random random(5);
  SurfaceLayer layer;
  for (int i = 0; i < 3000; ++i) layer.insert(randomPoint(random, 0.3));
  const auto patch = layer.patchAt({0.0, 0.0});
  ASSERT_TRUE(patch);
  EXPECT_GT(patch->thickness, 0.8 * patch->extent);
}

TEST(SurfaceLayer, HasNoPatchWhereNothingIsWithinReach) {
  SurfaceLayer layer;
  EXPECT_FALSE(layer.patchAt({0.0, 0.0}));
  layer.insert({1.0, 1.0});
  EXPECT_FALSE(layer.patchAt({1.0 + SurfaceLayer::kReach + 0.001, 1.0}));
  EXPECT_TRUE(layer.patchAt({1.0 + SurfaceLayer::kReach - 0.001, 1.0}));
  for (const double far : {-1e5, 1e5, 1e7}) EXPECT_FALSE(layer.patchAt({far, far}));
}

TEST(SurfaceLayer, IsNearWhereACellWithinTwoHasAPoint) {
  const auto layer = randomSurface(6, 300);
  base::Random random(7);
  const auto cellOf = [&](const Eigen::Vector2d& place) {
    return geometry::cellAt(place.x(), place.y(), layer.resolution());
  };
  int near = 0;
  for (int i = 0; i < 5000; ++i) {
    const auto cell = cellOf(randomPoint(random, 6.0));
    const Eigen::Vector2d place(geometry::cellCentre(cell.x, layer.resolution()),
                                geometry::cellCentre(cell.y, layer.resolution()));
    const bool expected = std::ranges::any_of(layer.points(), [&](const auto& point) {
      const auto there = cellOf(point.position_in_submap());
      return std::abs(there.x - cell.x) <= 2 && std::abs(there.y - cell.y) <= 2;
    });
    EXPECT_EQ(layer.isNear(place), expected) << place.transpose();
    near += expected ? 1 : 0;
  }
  EXPECT_GT(near, 100);
  EXPECT_FALSE(SurfaceLayer().isNear({0.0, 0.0}));
}

TEST(SurfaceLayer, IsLoadedAsItWasSavedAndGoesOnAlike) {
  auto layer = randomSurface(8);
  auto copy = loaded(bytesOf(layer));
  EXPECT_EQ(bytesOf(copy), bytesOf(layer));
  base::Random random(9);
  for (int i = 0; i < 300; ++i) {
    const auto point = randomPoint(random, 8.0);
    EXPECT_EQ(layer.insert(point), copy.insert(point));
    const auto patch = layer.patchAt(point);
    EXPECT_EQ(copy.patchAt(point)->mean, patch->mean);
    EXPECT_EQ(copy.patchAt(point)->normal, patch->normal);
  }
  EXPECT_EQ(bytesOf(copy), bytesOf(layer));
  EXPECT_EQ(bytesOf(loaded(bytesOf(SurfaceLayer()))), bytesOf(SurfaceLayer()));
}

TEST(SurfaceLayer, KeepsItsConfigurationWhereItIsLoaded) {
  SurfaceLayer layer({.maxRange = 2.5});
  const auto bytes = bytesOf(SurfaceLayer());
  base::ByteReader in(bytes);
  layer.load(in, 1);
  EXPECT_TRUE(layer.integrate({.reading = scanOf({2.0F, 3.0F})}));
  EXPECT_EQ(layer.points().size(), 1U);
}

/// Bytes as save() writes them, with what it never would.
struct Written {
  double resolution = 0.05;
  std::vector<SurfaceLayer::Point> points;
  std::vector<SurfaceLayer::Viewpoint> viewpoints;
};

TEST(SurfaceLayer, RefusesBytesThatNoSurfaceWrites) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  const std::vector<Written> bad = {
      {.resolution = 0.0},
      {.resolution = -0.05},
      {.resolution = static_cast<double>(nan)},
      {.resolution = static_cast<double>(infinite)},
      {.points = {{nan, 0.0F, 1.0F}}},
      {.points = {{0.0F, infinite, 1.0F}}},
      {.points = {{0.0F, 1e30F, 1.0F}}},
      {.points = {{0.0F, 0.0F, 1.0F}, {1e6F, 1e6F, 1.0F}}},
      {.points = {{0.0F, 0.0F, nan}}},
      {.points = {{0.0F, 0.0F, 0.0F}}},
      {.points = {{0.0F, 0.0F, -1.0F}}},
      {.points = {{0.0F, 0.0F, 65.0F}}},
      {.points = {{0.01F, 0.01F, 1.0F}, {0.02F, 0.01F, 1.0F}}},
      {.viewpoints = {{nan, 0.0F}}},
      {.viewpoints = {{0.0F, -infinite}}},
  };
  for (std::size_t i = 0; i < bad.size(); ++i) {
    base::ByteWriter out;
    out << bad[i].resolution << bad[i].points << bad[i].viewpoints;
    auto layer = randomSurface(10);
    const auto before = bytesOf(layer);
    base::ByteReader in(out.bytes());
    EXPECT_THROW(layer.load(in, 1), base::Error) << i;
    EXPECT_EQ(bytesOf(layer), before) << i;
  }
}

TEST(SurfaceLayer, RefusesOtherVersions) {
  const auto bytes = bytesOf(randomSurface(11));
  for (const int version : {-1, 0, 2}) {
    SurfaceLayer layer;
    base::ByteReader in(bytes);
    EXPECT_THROW(layer.load(in, version), base::Error) << version;
  }
}

TEST(SurfaceLayer, MergesAnotherOneWhereItsPoseSays) {
  const auto other = randomSurface(12, 200);
  const Pose2 pose{1.0, -2.0, 0.7};
  SurfaceLayer layer;
  layer.insert({50.0, 50.0});
  layer.merge(other, geometry::toPose3(pose));
  const auto T_other_layer = geometry::inverse(pose);
  for (std::size_t i = 1; i < layer.points().size(); ++i) {
    const auto position = layer.points()[i].position_in_submap();
    const auto back = T_other_layer * Pose2{position.x(), position.y(), 0.0};
    EXPECT_TRUE(other.isNear({back.x, back.y}));
  }
  ASSERT_EQ(layer.viewpoints().size(), other.viewpoints().size());
  const auto first = other.viewpoints()[0].position_in_submap();
  const auto expected = pose * Pose2{first.x(), first.y(), 0.0};
  EXPECT_NEAR(layer.viewpoints()[0].position_in_submap().x(), expected.x, 1e-5);
  EXPECT_NEAR(layer.viewpoints()[0].position_in_submap().y(), expected.y, 1e-5);
}

TEST(SurfaceLayer, MergesMeansByHowMuchWasSeen) {
  SurfaceLayer layer;
  for (int i = 0; i < 30; ++i) layer.insert({0.01, 0.02});
  SurfaceLayer other;
  for (int i = 0; i < 10; ++i) other.insert({0.03, 0.02});
  layer.merge(other, geometry::Pose3::Identity());
  ASSERT_EQ(layer.points().size(), 1U);
  EXPECT_NEAR(layer.points()[0].position_in_submap().x(), 0.015, 1e-6);
  EXPECT_EQ(layer.points()[0].count, 40.0F);

  // Both have seen as much as is counted: the middle, not what came last.
  SurfaceLayer here;
  SurfaceLayer there;
  for (int i = 0; i < 100; ++i) here.insert({0.01, 0.02});
  for (int i = 0; i < 100; ++i) there.insert({0.03, 0.02});
  here.merge(there, geometry::Pose3::Identity());
  EXPECT_NEAR(here.points()[0].position_in_submap().x(), 0.02, 1e-6);
  EXPECT_EQ(here.points()[0].count, SurfaceLayer::kMostCount);
}

TEST(SurfaceLayer, IsClonedAsOneOfItsOwn) {
  const auto layer = randomSurface(13);
  const auto before = bytesOf(layer);
  const auto copy = layer.clone();
  EXPECT_EQ(bytesOf(dynamic_cast<SurfaceLayer&>(*copy)), before);
  dynamic_cast<SurfaceLayer&>(*copy).insert({7.0, 7.0});
  dynamic_cast<SurfaceLayer&>(*copy).addViewpoint({70.0, 7.0});
  EXPECT_EQ(bytesOf(layer), before);
}

TEST(SurfaceLayer, RemembersWhereTheSensorStoodOnceAMetre) {
  SurfaceLayer layer;
  sensors::Reading reading = scanOf({1.0F});
  std::get<sensors::LaserScan>(reading.data).T_body_sensor = geometry::toPose3({0.3, 0.0, 0.0});
  for (int i = 0; i <= 100; ++i)
    layer.integrate({.reading = reading, .T_submap_body = geometry::toPose3({0.04 * i, 0.0, 0.0})});
  for (int i = 0; i <= 100; ++i)
    layer.integrate({.reading = reading, .T_submap_body = geometry::toPose3({0.04 * i, 0.0, 0.0})});
  EXPECT_NEAR(layer.viewpoints()[0].position_in_submap().x(), 0.3, 1e-6);
  EXPECT_THAT(layer.viewpoints().size(), testing::AllOf(testing::Ge(4U), testing::Le(5U)));
  for (const auto& a : layer.viewpoints()) {
    for (const auto& b : layer.viewpoints()) {
      EXPECT_TRUE(&a == &b || (a.position_in_submap() - b.position_in_submap()).norm() > 0.999);
    }
  }
}

TEST(SurfaceLayer, TakesAScansEndPointsWithinRangeThatAreOfNothingMoving) {
  const auto reading = scanOf({2.0F, 31.0F, sensors::LaserScan::kNoReturn, sensors::LaserScan::kInvalid, 4.0F, 5.0F,
                               std::numeric_limits<float>::quiet_NaN()});
  sensors::Mask movers(7, 1);
  movers(4, 0) = 1;
  SurfaceLayer layer;
  const auto T_submap_body = geometry::toPose3({1.0, 2.0, 0.2});
  EXPECT_TRUE(layer.integrate({.reading = reading, .T_submap_body = T_submap_body, .movers = &movers}));
  ASSERT_EQ(layer.points().size(), 2U);
  EXPECT_NEAR(layer.points()[0].position_in_submap().x(), 3.0, 1e-5);
  EXPECT_NEAR(layer.points()[0].position_in_submap().y(), 2.0, 1e-5);
  EXPECT_NEAR(layer.points()[1].position_in_submap().x(), 1.0 + 5.0 * std::cos(0.5), 1e-5);
}

TEST(SurfaceLayer, TakesFromACloudWhatStandsInTheHeightBand) {
  sensors::PointCloud cloud;
  const auto post = [&](float x, float least, float most) {
    for (int i = 0; i <= 4; ++i)
      cloud.points_in_sensor.emplace_back(x, 0.02F * x, least + (most - least) * static_cast<float>(i) / 4.0F);
  };
  post(2.0F, 0.5F, 1.0F);
  cloud.points_in_sensor.emplace_back(-1.0F, 0.01F, 0.05F);  // a sill
  cloud.points_in_sensor.emplace_back(-1.0F, 0.01F, 0.08F);
  for (const float z : {2.1F, 2.2F}) cloud.points_in_sensor.emplace_back(0.01F, 1.5F, z);    // a lamp
  for (const float z : {0.6F, 0.7F}) cloud.points_in_sensor.emplace_back(0.01F, -35.0F, z);  // too far
  const sensors::Reading reading{.time = {}, .sensor = "lidar", .data = cloud};
  SurfaceLayer layer;
  EXPECT_TRUE(layer.integrate({.reading = reading}));
  ASSERT_EQ(layer.points().size(), 1U);
  EXPECT_NEAR(layer.points()[0].position_in_submap().x(), 2.0, 0.01);

  sensors::Mask movers(static_cast<int>(cloud.points_in_sensor.size()), 1);
  for (int i = 0; i < 5; ++i) movers(i, 0) = 1;
  SurfaceLayer still;
  EXPECT_TRUE(still.integrate({.reading = reading, .movers = &movers}));
  EXPECT_TRUE(still.points().empty());
}

TEST(SurfaceLayer, TakesFromADepthImageWhatStandsInTheHeightBand) {
  sensors::RgbdFrame frame;
  frame.T_body_camera = geometry::toPose3({0, 0, 0}, 1.0) * sensors::cameraAxesInBody();
  frame.camera = {.fx = 100.0, .fy = 100.0, .cx = 79.5, .cy = 59.5, .distortion = {}};
  frame.depth = sensors::Image<float>(160, 120);
  // A floor up to a wall three metres ahead.
  for (int y = 0; y < 120; ++y) {
    const double down = (y - frame.camera.cy) / frame.camera.fy;
    for (int x = 0; x < 160; ++x) frame.depth(x, y) = static_cast<float>(down > 1.0 / 3.0 ? 1.0 / down : 3.0);
  }
  const sensors::Reading reading{.time = {}, .sensor = "camera", .data = frame};
  SurfaceLayer layer;
  EXPECT_TRUE(layer.integrate({.reading = reading}));
  EXPECT_GT(layer.points().size(), 50U);
  for (const auto& point : layer.points()) EXPECT_NEAR(point.position_in_submap().x(), 3.0, 0.01);
  const sensors::Mask movers = [] {
    sensors::Mask all(160, 120);
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 160; ++x) all(x, y) = 1;
    }
    return all;
  }();
  SurfaceLayer still;
  still.integrate({.reading = reading, .movers = &movers});
  EXPECT_TRUE(still.points().empty());
}

TEST(SurfaceLayer, LeavesOtherReadingsAlone) {
  const sensors::Reading reading{.time = {}, .sensor = "wheels", .data = sensors::Odometry{}};
  SurfaceLayer layer;
  EXPECT_FALSE(layer.integrate({.reading = reading}));
  EXPECT_TRUE(layer.points().empty() && layer.viewpoints().empty());
}

}  // namespace
}  // namespace prodomos::map

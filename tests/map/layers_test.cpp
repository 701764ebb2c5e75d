// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/random.hpp"
#include "prodomos/map/config.hpp"
#include "prodomos/map/layer.hpp"
#include "prodomos/map/submap.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

/// What every type of layer must keep to, a new one too: the suite goes over the table in src/map/layers.cpp.
namespace prodomos::map {
namespace {

std::vector<std::byte> bytesOf(const MapLayer& layer) {
  base::ByteWriter out;
  layer.save(out);
  return out.take();
}

sensors::ReadingData randomData(base::Random& random, int kind) {
  if (kind == 0) {
    sensors::LaserScan scan;
    scan.firstAngle = random.uniform(-3, 3);
    scan.angleStep = 0.02;
    scan.maxRange = 20.0;
    for (int i = 0; i < 200; ++i) {
      scan.ranges.push_back(random.uniform() < 0.1 ? sensors::LaserScan::kNoReturn
                                                   : static_cast<float>(random.uniform(0, 12)));
    }
    return scan;
  }
  if (kind == 1) {
    sensors::PointCloud cloud;
    for (int i = 0; i < 300; ++i) {
      cloud.points_in_sensor.emplace_back(static_cast<float>(random.uniform(-9, 9)),
                                          static_cast<float>(random.uniform(-9, 9)),
                                          static_cast<float>(random.uniform(0, 2)));
      cloud.color.push_back({static_cast<std::uint8_t>(random.integer(0, 255)), 7, 9});
    }
    return cloud;
  }
  sensors::RgbdFrame frame;
  frame.T_body_camera = geometry::toPose3({0, 0, 0}, 1.0) * sensors::cameraAxesInBody();
  frame.camera = {.fx = 40.0, .fy = 40.0, .cx = 23.5, .cy = 15.5, .distortion = {}};
  frame.depth = sensors::Image<float>(48, 32);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 48; ++x) frame.depth(x, y) = static_cast<float>(std::max(0.0, random.uniform(-1, 6)));
  }
  return frame;
}

class EveryLayer : public testing::TestWithParam<std::string_view> {
 protected:
  static std::unique_ptr<MapLayer> empty() { return makeLayer(GetParam(), {}); }

  /// After readings of all kinds; some layer that takes none of them would be no layer.
  static std::unique_ptr<MapLayer> filled(std::uint64_t seed) {
    base::Random random(seed);
    auto layer = empty();
    bool taken = false;
    for (int i = 0; i < 9; ++i) {
      const sensors::Reading reading{.time = {}, .sensor = "s", .data = randomData(random, i % 3)};
      const auto T_submap_body =
          geometry::toPose3({random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-3, 3)});
      taken |= layer->integrate({.reading = reading, .T_submap_body = T_submap_body});
    }
    EXPECT_TRUE(taken);
    return layer;
  }

  static std::unique_ptr<MapLayer> loaded(const std::vector<std::byte>& bytes) {
    auto layer = empty();
    base::ByteReader in(bytes);
    layer->load(in, layer->version());
    EXPECT_EQ(in.left(), 0U);
    return layer;
  }
};

TEST_P(EveryLayer, IsMadeByItsType) {
  const auto layer = empty();
  ASSERT_NE(layer, nullptr);
  EXPECT_EQ(layer->typeId(), GetParam());
  EXPECT_EQ(filled(1)->typeId(), GetParam()) << "what it holds does not change it";
  EXPECT_GE(layer->version(), 1);
}

TEST_P(EveryLayer, IsClonedWithAllThatItHolds) {
  const auto layer = filled(2);
  const auto copy = layer->clone();
  EXPECT_EQ(bytesOf(*copy), bytesOf(*layer));
  EXPECT_EQ(copy->summary(), layer->summary());
  const auto before = bytesOf(*layer);
  copy->merge(*filled(3), geometry::toPose3({1, 2, 0.3}));
  EXPECT_EQ(bytesOf(*layer), before) << "a clone is of its own";
}

TEST_P(EveryLayer, IsLoadedAsItWasSaved) {
  for (const std::uint64_t seed : {4, 5, 6}) {
    const auto layer = filled(seed);
    const auto bytes = bytesOf(*layer);
    const auto copy = loaded(bytes);
    EXPECT_EQ(bytesOf(*copy), bytes);
    EXPECT_EQ(copy->summary(), layer->summary());
  }
}

TEST_P(EveryLayer, IsTheSameAgainFromTheSameReadings) {
  EXPECT_EQ(bytesOf(*filled(7)), bytesOf(*filled(7)));
}

TEST_P(EveryLayer, IsSavedAndLoadedEmptyToo) {
  const auto bytes = bytesOf(*empty());
  EXPECT_EQ(bytesOf(*loaded(bytes)), bytes);
  const auto drawing = loaded(bytes)->draw();
  EXPECT_TRUE(drawing.rasters.empty() && drawing.points.empty() && drawing.boxes.empty() && drawing.lines.empty());
}

TEST_P(EveryLayer, LosesWhatItHeldWhereItIsLoaded) {
  auto layer = filled(8);
  const auto bytes = bytesOf(*empty());
  base::ByteReader in(bytes);
  layer->load(in, layer->version());
  EXPECT_EQ(bytesOf(*layer), bytes);
}

TEST_P(EveryLayer, RefusesBytesThatAreCutOff) {
  const auto bytes = bytesOf(*filled(9));
  // Every length near both ends, some between.
  for (std::size_t length = 0; length < bytes.size(); length += length < 200 || length + 50 > bytes.size() ? 1 : 37) {
    const auto layer = empty();
    base::ByteReader in(std::span<const std::byte>(bytes).first(length));
    EXPECT_THROW(layer->load(in, layer->version()), base::Error) << length << " of " << bytes.size() << " bytes";
  }
}

TEST_P(EveryLayer, RefusesAVersionItDoesNotKnow) {
  const auto bytes = bytesOf(*filled(10));
  const auto layer = empty();
  for (const int version : {layer->version() + 1, 0, -1}) {
    base::ByteReader in(bytes);
    EXPECT_THROW(layer->load(in, version), base::Error) << version;
  }
}

TEST_P(EveryLayer, IsNotChangedByMergingAnEmptyOne) {
  const auto layer = filled(11);
  const auto before = bytesOf(*layer);
  layer->merge(*empty(), geometry::toPose3({3, -2, 1}));
  EXPECT_EQ(bytesOf(*layer), before);
}

TEST_P(EveryLayer, BecomesWhatIsMergedIntoAnEmptyOne) {
  const auto layer = filled(12);
  const auto merged = empty();
  merged->merge(*layer, geometry::Pose3::Identity());
  EXPECT_EQ(bytesOf(*merged), bytesOf(*layer));
}

TEST_P(EveryLayer, DrawsAndSumsUpWhatItHolds) {
  const auto layer = filled(13);
  const auto drawing = layer->draw();
  EXPECT_FALSE(drawing.rasters.empty() && drawing.points.empty() && drawing.boxes.empty() && drawing.lines.empty());
  EXPECT_FALSE(layer->summary().empty());
}

INSTANTIATE_TEST_SUITE_P(Types, EveryLayer, testing::ValuesIn(layerTypes()),
                         [](const auto& info) { return std::string(info.param); });

TEST(Layers, HaveTheTypesThatStandInMapFiles) {
  EXPECT_THAT(layerTypes(), testing::IsSupersetOf({"occupancy_grid", "points"}));
}

TEST(Layers, OfAnUnknownTypeAreNone) {
  EXPECT_EQ(makeLayer("smell", {}), nullptr);
  EXPECT_EQ(makeLayer("", {}), nullptr);
}

TEST(Layers, AreAllInANewSubMap) {
  Node node;
  node.id = {7};
  const auto submap = makeSubMap(node, {});
  EXPECT_EQ(submap.node.id, base::SubMapId{7});
  for (const auto type : layerTypes()) EXPECT_NE(submap.findLayer(type), nullptr) << type;
  EXPECT_EQ(submap.findLayer("smell"), nullptr);
}

TEST(Layers, AreConfiguredBothWays) {
  LayersConfig config;
  config.grid.resolution = 0.2;
  config.points.voxel = 0.3;
  const auto read =
      base::readConfig<LayersConfig>({.file = {}, .text = base::writeConfig(config, true), .assignments = {}});
  EXPECT_EQ(read.grid.resolution, 0.2);
  EXPECT_EQ(read.points.voxel, 0.3);
  EXPECT_THROW(base::readConfig<LayersConfig>({.file = {}, .text = "", .assignments = {"grid.resolution=0"}}),
               base::UsageError);
}

}  // namespace
}  // namespace prodomos::map

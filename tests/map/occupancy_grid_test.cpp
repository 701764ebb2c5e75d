// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/occupancy_grid.hpp"

#include "prodomos/base/random.hpp"

#include "map/slow_grid.hpp"
#include "support/sample_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prodomos::map {
namespace {

using Beam = OccupancyGrid::Beam;
using test::gridFromText;
using test::SlowGrid;
using test::toText;

constexpr double kPi = std::numbers::pi;

OccupancyGridConfig configOf(double resolution, double maxRange = 30.0) {
  OccupancyGridConfig config;
  config.resolution = resolution;
  config.maxRange = maxRange;
  return config;
}

sensors::Reading readingOf(sensors::ReadingData data) {
  return {.time = {}, .sensor = "sensor", .data = std::move(data)};
}

/// All cells of both are the same; the fast grid's may have any storage around.
void expectSame(const OccupancyGrid& grid, const SlowGrid& oracle, const std::string& when) {
  auto box = grid.box();
  for (const auto& [cell, value] : oracle.values()) box.add(cell);
  int different = 0;
  std::string first;
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) {
      const auto expected = oracle.value({x, y}).value_or(OccupancyGrid::kUnknownCell);
      const int found = grid.cell({x, y});
      if (found == expected) continue;
      if (different++ == 0) {
        first = std::to_string(x) + ", " + std::to_string(y) + " is " + std::to_string(found) + " and should be " +
                std::to_string(expected);
      }
    }
  }
  ASSERT_EQ(different, 0) << when << ": the first is cell " << first;
}

// --- insertion against the oracle

struct World {
  const char* name;
  double resolution;
  double maxRange;
  int beams;
  double firstAngle;
  double angleStep;
  double size;  ///< metres; how far walls stand
  bool tilted;  ///< the sensor too, not the robot alone
};

class OccupancyGridOracle : public testing::TestWithParam<World> {};

/// A wall with edges and noise, and every kind of beam that is none.
sensors::LaserScan randomScan(base::Random& random, const World& world) {
  sensors::LaserScan scan;
  scan.firstAngle = world.firstAngle;
  scan.angleStep = world.angleStep;
  scan.maxRange = world.size * 1.5;
  double wall = random.uniform(0.1, world.size);
  for (int i = 0; i < world.beams; ++i) {
    if (random.uniform() < 0.1) wall = random.uniform(0, world.size);
    const double kind = random.uniform();
    scan.ranges.push_back(kind < 0.03   ? sensors::LaserScan::kNoReturn
                          : kind < 0.06 ? sensors::LaserScan::kInvalid
                          : kind < 0.08 ? std::numeric_limits<float>::quiet_NaN()
                          : kind < 0.10 ? 0.0F
                                        : static_cast<float>(wall * random.uniform(0.98, 1.02)));
  }
  return scan;
}

TEST_P(OccupancyGridOracle, IsMetByManyScansFromManyPoses) {
  const auto& world = GetParam();
  base::Random random(17);
  for (int run = 0; run < 3; ++run) {
    auto config = configOf(world.resolution, world.maxRange);
    config.hit = random.uniform(0.55, 0.9);
    config.miss = random.uniform(0.2, 0.48);
    config.clampLow = random.uniform(0.06, 0.3);
    config.clampHigh = random.uniform(0.7, 0.98);
    config.noReturn = random.uniform(0.2, 1.2) * world.size;
    OccupancyGrid grid(config);
    SlowGrid oracle(config);
    for (int step = 0; step < 12; ++step) {
      auto scan = randomScan(random, world);
      const double tilt = world.tilted ? 0.3 : 0.0;
      scan.T_body_sensor = geometry::fromYawPitchRoll({0.2, -0.1, 0.4}, random.uniform(-4, 4),
                                                      random.uniform(-tilt, tilt), random.uniform(-tilt, tilt));
      const auto reach = world.size;
      const auto T_submap_body =
          geometry::toPose3({random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-4, 4)});
      const auto reading = readingOf(scan);
      ASSERT_TRUE(grid.integrate({.reading = reading, .T_submap_body = T_submap_body}));
      const geometry::Pose3 T_submap_sensor = T_submap_body * scan.T_body_sensor;
      oracle.insert(T_submap_sensor.translation().head<2>(), test::beamsOf(scan, T_submap_sensor, config.noReturn));
      ASSERT_NO_FATAL_FAILURE(expectSame(grid, oracle, "run " + std::to_string(run) + " step " + std::to_string(step)));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Worlds, OccupancyGridOracle,
                         testing::Values(World{"sick", 0.05, 30.0, 181, -kPi / 2, kPi / 180, 4.0, false},
                                         World{"hokuyo", 0.1, 30.0, 541, -0.75 * kPi, kPi / 360, 8.0, false},
                                         World{"clockwise", 0.1, 30.0, 271, 0.75 * kPi, -kPi / 180, 8.0, false},
                                         World{"full_turn_and_a_bit", 0.2, 30.0, 730, 0.3, kPi / 360, 12.0, false},
                                         World{"coarse", 0.73, 30.0, 361, -kPi, kPi / 180, 20.0, false},
                                         World{"fine", 0.02, 30.0, 91, -kPi / 2, kPi / 90, 1.2, false},
                                         World{"beyond_range", 0.1, 3.0, 361, -kPi, kPi / 180, 6.0, false},
                                         World{"sparse", 0.1, 30.0, 13, -kPi, 0.5, 8.0, false},
                                         World{"narrow", 0.1, 30.0, 200, -0.05, 0.0005, 8.0, false},
                                         World{"tilted", 0.1, 5.0, 361, -kPi, kPi / 180, 6.0, true}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(OccupancyGrid, MeetsTheOracleOnBeamsInAnyOrderAlongBordersAndThroughCorners) {
  base::Random random(23);
  const auto config = configOf(0.25);
  OccupancyGrid grid(config);
  SlowGrid oracle(config);
  for (int run = 0; run < 60; ++run) {
    const auto corner = [&]() -> Eigen::Vector2d {
      return Eigen::Vector2d(random.integer(-12, 12), random.integer(-12, 12)) * 0.25;
    };
    const Eigen::Vector2d origin = corner();
    std::vector<Beam> beams;
    for (int i = 0; i < 30; ++i) beams.push_back({corner(), random.uniform() < 0.7});
    grid.insert(origin, beams);
    oracle.insert(origin, beams);
    ASSERT_NO_FATAL_FAILURE(expectSame(grid, oracle, "run " + std::to_string(run)));
  }
}

TEST(OccupancyGrid, MeetsTheOracleOnLongRowsOfCells) {
  // Whole rows are updated many cells at a time; of every length, from every offset.
  const auto config = configOf(1.0, 200.0);
  OccupancyGrid grid(config);
  SlowGrid oracle(config);
  for (int length = 0; length < 70; ++length) {
    const Eigen::Vector2d origin(0.5 - length % 17, 0.5 + length % 5);
    const std::vector<Beam> beams{{origin + Eigen::Vector2d(length, 0.0), length % 3 == 0},
                                  {origin + Eigen::Vector2d(-length / 2.0, 0.0), length % 2 == 0}};
    grid.insert(origin, beams);
    oracle.insert(origin, beams);
  }
  expectSame(grid, oracle, "in the end");
}

// --- what a cell holds

TEST(OccupancyGrid, KnowsNothingAtFirst) {
  const OccupancyGrid grid;
  EXPECT_TRUE(grid.box().empty());
  EXPECT_TRUE(grid.knownBox().empty());
  EXPECT_EQ(grid.state({0, 0}), CellState::kUnknown);
  EXPECT_EQ(grid.probability({-7, 9}), 0.5);
  EXPECT_TRUE(grid.draw().rasters.empty());
}

TEST(OccupancyGrid, MarksTheWayFreeAndTheEndOccupied) {
  OccupancyGrid grid(configOf(1.0));
  const Beam beam{.end = {5.5, 2.5}, .hit = true};
  grid.insert({0.5, 0.5}, {&beam, 1});
  EXPECT_EQ(toText(grid),
            "    .#\n"
            " .... \n"
            "..    \n");
}

TEST(OccupancyGrid, UpdatesACellOnceAScanHoweverManyBeamsPassIt) {
  OccupancyGrid grid(configOf(1.0));
  std::vector<Beam> beams;
  for (int i = 0; i < 50; ++i) beams.push_back({{10.5, 0.3 + 0.008 * i}, true});
  grid.insert({0.5, 0.5}, beams);
  EXPECT_EQ(grid.cell({0, 0}), SlowGrid::inUnits(0.4));
  EXPECT_EQ(grid.cell({5, 0}), SlowGrid::inUnits(0.4));
  EXPECT_EQ(grid.cell({10, 0}), SlowGrid::inUnits(0.7));
  EXPECT_NEAR(grid.probability({10, 0}), 0.7, 0.005);
  EXPECT_NEAR(grid.probability({5, 0}), 0.4, 0.005);
}

TEST(OccupancyGrid, CountsACellAsHitThoughOtherBeamsPassIt) {
  OccupancyGrid grid(configOf(1.0));
  const std::vector<Beam> beams{{{9.5, 0.5}, true}, {{4.5, 0.5}, true}};
  grid.insert({0.5, 0.5}, beams);
  EXPECT_EQ(toText(grid), "....#....#\n");
}

TEST(OccupancyGrid, HoldsProbabilitiesWithinTheClamps) {
  auto config = configOf(1.0);
  config.clampLow = 0.2;
  config.clampHigh = 0.9;
  OccupancyGrid grid(config);
  const Beam beam{.end = {2.5, 0.5}, .hit = true};
  for (int i = 0; i < 100; ++i) grid.insert({0.5, 0.5}, {&beam, 1});
  EXPECT_NEAR(grid.probability({0, 0}), 0.2, 0.005);
  EXPECT_NEAR(grid.probability({2, 0}), 0.9, 0.005);
  const Beam longer{.end = {3.5, 0.5}, .hit = true};
  for (int i = 0; i < 8; ++i) grid.insert({0.5, 0.5}, {&longer, 1});
  EXPECT_EQ(toText(grid), "...#\n") << "clamped cells change their mind soon";
}

TEST(OccupancyGrid, NeverCallsATouchedCellUnknown) {
  auto config = configOf(1.0);
  config.hit = 0.501;
  config.miss = 0.499;
  OccupancyGrid grid(config);
  const Beam beam{.end = {2.5, 0.5}, .hit = true};
  grid.insert({0.5, 0.5}, {&beam, 1});
  EXPECT_EQ(toText(grid), "..#\n");
}

// --- which beams count

TEST(OccupancyGrid, CutsBeamsAtTheConfiguredRangeWhereTheyHitNothing) {
  OccupancyGrid grid(configOf(1.0, 4.0));
  const Beam beam{.end = {9.5, 0.5}, .hit = true};
  grid.insert({0.5, 0.5}, {&beam, 1});
  EXPECT_EQ(toText(grid), ".....\n");
}

TEST(OccupancyGrid, TrustsBeamsWithoutAReturnForAShortWayAlone) {
  sensors::LaserScan scan;
  scan.maxRange = 3.0;
  scan.ranges = {sensors::LaserScan::kNoReturn};
  auto config = configOf(1.0);
  for (const auto& [noReturn, drawn] : {std::pair{2.0, "...\n"}, {50.0, "....\n"}}) {
    config.noReturn = noReturn;
    OccupancyGrid grid(config);
    grid.insert(scan, geometry::toPose3({0.5, 0.5, 0}));
    EXPECT_EQ(toText(grid), drawn) << noReturn << " m, or the scanner's own range";
  }
}

TEST(OccupancyGrid, LearnsNothingFromInvalidBeams) {
  OccupancyGrid grid;
  sensors::LaserScan scan;
  scan.angleStep = 0.1;
  scan.maxRange = 3.0;
  scan.ranges = {sensors::LaserScan::kInvalid, std::numeric_limits<float>::quiet_NaN(), -0.5F};
  grid.insert(scan, geometry::Pose3::Identity());
  grid.insert(sensors::LaserScan(), geometry::Pose3::Identity());
  EXPECT_TRUE(grid.knownBox().empty());
}

TEST(OccupancyGrid, LeavesOutTheBeamsOfMovers) {
  sensors::LaserScan scan;
  scan.angleStep = kPi / 2;
  scan.maxRange = 20.0;
  scan.ranges = {3.0F, 3.0F, 3.0F};  // ahead, left, behind
  sensors::Mask movers(3, 1);
  movers(0, 0) = 1;
  const auto reading = readingOf(scan);
  OccupancyGrid grid(configOf(1.0));
  EXPECT_TRUE(
      grid.integrate({.reading = reading, .T_submap_body = geometry::toPose3({0.5, 0.5, 0}), .movers = &movers}));
  EXPECT_EQ(grid.state({3, 0}), CellState::kUnknown);
  EXPECT_EQ(grid.state({0, 3}), CellState::kOccupied);
  EXPECT_EQ(grid.state({-3, 0}), CellState::kOccupied);
  EXPECT_EQ(grid.overlap({.reading = reading, .T_submap_body = geometry::toPose3({0.5, 0.5, 0}), .movers = &movers}),
            1.0);

  const sensors::Mask nothingMoves;
  grid.integrate({.reading = reading, .T_submap_body = geometry::toPose3({0.5, 0.5, 0}), .movers = &nothingMoves});
  EXPECT_EQ(grid.state({3, 0}), CellState::kOccupied);
}

TEST(OccupancyGrid, TakesNothingFromReadingsThatRangeNothing) {
  OccupancyGrid grid;
  for (const auto& reading :
       {readingOf(sensors::Odometry()), readingOf(sensors::Detections()), readingOf(sensors::RgbdFrame())}) {
    EXPECT_FALSE(grid.integrate({.reading = reading}));
    EXPECT_EQ(grid.overlap({.reading = reading}), 1.0);
  }
  EXPECT_TRUE(grid.knownBox().empty());
}

// --- storage

TEST(OccupancyGrid, GrowsInAllDirectionsAndForgetsNothing) {
  const auto config = configOf(0.5, 1000.0);
  OccupancyGrid grid(config);
  SlowGrid oracle(config);
  Eigen::Vector2d origin(0.1, 0.1);
  for (const auto& step : std::vector<Eigen::Vector2d>{{0, 0}, {90, 0}, {0, 95}, {-300, 0}, {0, -280}, {100, 200}}) {
    origin += step;
    std::vector<Beam> beams;
    for (int i = 0; i < 8; ++i) beams.push_back({origin + 3.0 * Eigen::Vector2d(std::cos(i), std::sin(i)), true});
    grid.insert(origin, beams);
    oracle.insert(origin, beams);
    for (const auto& [cell, value] : oracle.values()) ASSERT_EQ(grid.cell(cell), value);
  }
  geometry::CellBox known;
  for (const auto& [cell, value] : oracle.values()) known.add(cell);
  EXPECT_EQ(grid.knownBox(), known);
}

// --- overlap

TEST(OccupancyGrid, OverlapIsTheShareOfEndPointsInKnownCells) {
  auto grid = gridFromText({"#..#"}, 1.0);
  sensors::LaserScan scan;
  scan.angleStep = kPi / 2;
  scan.maxRange = 50.0;
  scan.ranges = {2.0F, 2.0F, 1.0F, 3.0F, 2.0F};  // ahead, left, behind, right, ahead
  auto reading = readingOf(scan);
  EXPECT_DOUBLE_EQ(grid.overlap({.reading = reading, .T_submap_body = geometry::toPose3({1.5, 0.5, 0})}), 3.0 / 5.0);
  EXPECT_EQ(toText(grid), "#..#\n") << "asking changes nothing";
  EXPECT_EQ(grid.overlap({.reading = reading, .T_submap_body = geometry::toPose3({100.5, 0.5, 0})}), 0.0);

  scan.ranges = {sensors::LaserScan::kNoReturn, sensors::LaserScan::kInvalid, 2.0F};
  scan.angleStep = kPi;
  reading = readingOf(scan);
  EXPECT_EQ(grid.overlap({.reading = reading, .T_submap_body = geometry::toPose3({1.5, 0.5, 0})}), 1.0);
}

TEST(OccupancyGrid, OverlapDoesNotCountHitsThatAreTooFarToBeInserted) {
  OccupancyGrid grid(configOf(1.0, 4.0));
  sensors::LaserScan scan;
  scan.angleStep = kPi;
  scan.maxRange = 50.0;
  scan.ranges = {2.0F, 30.0F};
  const auto reading = readingOf(scan);
  const auto T_submap_body = geometry::toPose3({0.5, 0.5, 0});
  grid.integrate({.reading = reading, .T_submap_body = T_submap_body});
  EXPECT_EQ(grid.overlap({.reading = reading, .T_submap_body = T_submap_body}), 1.0);
}

// --- merging

OccupancyGrid randomGrid(base::Random& random, const OccupancyGridConfig& config, double size = 3.0) {
  OccupancyGrid grid(config);
  for (int i = 0; i < 12; ++i) {
    std::vector<Beam> beams;
    for (int k = 0; k < 40; ++k) {
      beams.push_back({{random.uniform(-size, size), random.uniform(-size, size)}, random.uniform() < 0.9});
    }
    grid.insert({random.uniform(-size, size), random.uniform(-size, size)}, beams);
  }
  return grid;
}

TEST(OccupancyGrid, MergedInPlaceIsTheSame) {
  base::Random random(31);
  const auto grid = randomGrid(random, configOf(0.1));
  OccupancyGrid merged(configOf(0.1));
  merged.merge(grid, geometry::Pose3::Identity());
  EXPECT_EQ(toText(merged), toText(grid));
  const auto box = grid.knownBox();
  EXPECT_EQ(merged.knownBox(), box);
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) ASSERT_EQ(merged.cell({x, y}), grid.cell({x, y})) << x << ", " << y;
  }
}

TEST(OccupancyGrid, MergedWithinLimitsLeavesTheRestUnknown) {
  OccupancyGrid source;
  const std::vector<OccupancyGrid::Beam> beams{{{2.0, 0.0}, true}};
  source.insert({0.0, 0.0}, beams);
  OccupancyGrid target;
  target.mergeWithin({{0, -5}, {19, 5}}, source, geometry::Pose3::Identity());
  EXPECT_EQ(target.knownBox(), (geometry::CellBox{{0, 0}, {19, 0}}));
  EXPECT_EQ(target.state({10, 0}), CellState::kFree);
  target.mergeWithin({{100, 100}, {120, 120}}, source, geometry::Pose3::Identity());
  EXPECT_EQ(target.knownBox(), (geometry::CellBox{{0, 0}, {19, 0}}));
}

TEST(OccupancyGrid, MergedUnderAQuarterTurnIsTurned) {
  const auto grid = gridFromText({"##..",  //
                                  "#   "},
                                 1.0);
  OccupancyGrid merged(configOf(1.0));
  merged.merge(grid, geometry::toPose3({10.0, 0.0, kPi / 2}));
  EXPECT_EQ(toText(merged),
            ". \n"
            ". \n"
            "# \n"
            "##\n");
  EXPECT_EQ(merged.knownBox().first, (geometry::CellIndex{8, 0}));
}

TEST(OccupancyGrid, MergedUnderAnyPoseAddsTheNearestCells) {
  base::Random random(37);
  for (int run = 0; run < 12; ++run) {
    const auto source = randomGrid(random, configOf(run % 2 == 0 ? 0.1 : 0.17));
    const auto before = randomGrid(random, configOf(0.1));
    const geometry::Pose2 T_this_source{random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-4, 4)};
    OccupancyGrid merged = before;
    // Height, roll and pitch do not count.
    merged.merge(source,
                 geometry::fromYawPitchRoll({T_this_source.x, T_this_source.y, 3.0}, T_this_source.theta, 0, 0));

    const geometry::Pose3 T_source_this = geometry::toPose3(T_this_source).inverse();
    const int low = SlowGrid::inUnits(0.12);
    const int high = SlowGrid::inUnits(0.97);
    for (int y = -200; y < 200; ++y) {
      for (int x = -200; x < 200; ++x) {
        const Eigen::Vector3d centre(geometry::cellCentre(x, 0.1), geometry::cellCentre(y, 0.1), 0.0);
        const auto seen = source.cell(source.cellAt((T_source_this * centre).head<2>()));
        const auto old = before.cell({x, y});
        int expected = old;
        if (seen != OccupancyGrid::kUnknownCell) {
          expected = std::clamp((old == OccupancyGrid::kUnknownCell ? 0 : old) + seen, low, high);
        }
        ASSERT_EQ(merged.cell({x, y}), expected) << "run " << run << " cell " << x << ", " << y;
      }
    }
  }
}

// --- saving

TEST(OccupancyGrid, IsLoadedAsItWasSaved) {
  base::Random random(41);
  auto config = configOf(0.08, 12.0);
  config.hit = 0.8;
  config.heightBand = {0.3, 1.2};
  for (const auto& grid :
       {randomGrid(random, config), OccupancyGrid(config), gridFromText({"#"}, 0.25, {-1000, 2000})}) {
    base::ByteWriter out;
    grid.save(out);
    OccupancyGrid loaded;
    base::ByteReader in(out.bytes());
    loaded.load(in, 1);
    EXPECT_EQ(in.left(), 0U);
    EXPECT_EQ(loaded.config().resolution, grid.config().resolution);
    EXPECT_EQ(loaded.config().maxRange, grid.config().maxRange);
    EXPECT_EQ(loaded.config().hit, grid.config().hit);
    EXPECT_EQ(loaded.config().heightBand.least, grid.config().heightBand.least);
    EXPECT_EQ(loaded.config().heightBand.most, grid.config().heightBand.most);
    EXPECT_EQ(loaded.knownBox(), grid.knownBox());
    base::ByteWriter again;
    loaded.save(again);
    EXPECT_EQ(again.bytes(), out.bytes());
  }
}

TEST(OccupancyGrid, GoesOnAfterLoadingAsIfItHadNotBeenSaved) {
  base::Random random(43);
  auto grid = randomGrid(random, configOf(0.1));
  base::ByteWriter out;
  grid.save(out);
  OccupancyGrid loaded;
  base::ByteReader in(out.bytes());
  loaded.load(in, 1);
  for (int i = 0; i < 20; ++i) {
    std::vector<Beam> beams;
    for (int k = 0; k < 20; ++k) beams.push_back({{random.uniform(-5, 5), random.uniform(-5, 5)}, true});
    grid.insert({0.0, 0.0}, beams);
    loaded.insert({0.0, 0.0}, beams);
  }
  const auto box = grid.knownBox();
  ASSERT_EQ(loaded.knownBox(), box);
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) ASSERT_EQ(loaded.cell({x, y}), grid.cell({x, y}));
  }
}

TEST(OccupancyGrid, RefusesBytesThatAreDamaged) {
  base::ByteWriter out;
  gridFromText({"#..", "..#"}, 0.5).save(out);
  const auto bytes = out.take();
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    OccupancyGrid grid;
    base::ByteReader in(std::span<const std::byte>(bytes).first(length));
    EXPECT_THROW(grid.load(in, 1), base::Error) << length << " of " << bytes.size() << " bytes";
  }
  auto longer = bytes;
  longer.push_back({});
  OccupancyGrid grid;
  base::ByteReader tooLong(longer);
  EXPECT_THROW(grid.load(tooLong, 1), base::Error);
  base::ByteReader unknownVersion(bytes);
  EXPECT_THROW(grid.load(unknownVersion, 2), base::Error);
}

TEST(OccupancyGrid, RefusesNumbersThatNoGridHas) {
  base::ByteWriter out;
  gridFromText({"#..", "..#"}, 0.5).save(out);
  const auto good = out.take();
  const auto loadWith = [&](std::size_t at, auto number) {
    auto bytes = good;
    std::memcpy(bytes.data() + at, &number, sizeof number);
    OccupancyGrid grid;
    base::ByteReader in(bytes);
    grid.load(in, 1);
  };
  EXPECT_NO_THROW(loadWith(0, 0.25));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double resolution : {0.0, -0.05, nan, infinity}) EXPECT_THROW(loadWith(0, resolution), base::Error);
  for (std::size_t key = 1; key < 9; ++key) {
    EXPECT_THROW(loadWith(8 * key, nan), base::Error) << key;
    EXPECT_THROW(loadWith(8 * key, infinity), base::Error) << key;
  }
  for (std::size_t probability = 3; probability < 7; ++probability) {
    for (const double nonsense : {-0.1, 0.0, 1.0, 7.0}) {
      EXPECT_THROW(loadWith(8 * probability, nonsense), base::Error) << probability << " is " << nonsense;
    }
  }
  for (std::size_t corner = 0; corner < 4; ++corner) {
    for (const int nonsense : {std::numeric_limits<int>::min(), std::numeric_limits<int>::max(), 1'000'000, 5}) {
      EXPECT_THROW(loadWith(72 + 4 * corner, nonsense), base::Error) << corner << " is " << nonsense;
    }
  }
  EXPECT_THROW(loadWith(88, std::int8_t{-127}), base::Error) << "a miss would make it the most occupied of all";
}

// --- drawing

TEST(OccupancyGrid, IsDrawnWithItsLowerLeftCornerWhereItLies) {
  const auto drawing = gridFromText({"#.", " ."}, 0.5, {-4, 6}).draw();
  ASSERT_EQ(drawing.rasters.size(), 1U);
  const auto& raster = drawing.rasters[0];
  EXPECT_EQ(raster.corner_in_submap, Eigen::Vector2d(-2.0, 3.0));
  EXPECT_EQ(raster.resolution, 0.5);
  ASSERT_EQ(raster.pixels.width(), 2);
  ASSERT_EQ(raster.pixels.height(), 2);
  EXPECT_EQ(raster.pixels(0, 0).a, 0) << "unknown is clear";
  EXPECT_EQ(raster.pixels(1, 0), raster.pixels(1, 1)) << "both free";
  EXPECT_LT(raster.pixels(0, 1).r, raster.pixels(1, 1).r) << "occupied is dark";
}

TEST(OccupancyGrid, SumsUpItsAreas) {
  EXPECT_THAT(gridFromText({"#..", " .."}, 0.5).summary(),
              testing::ElementsAre(testing::Pair("free", "1.0 m²"), testing::Pair("occupied", "0.2 m²")));
}

}  // namespace
}  // namespace prodomos::map

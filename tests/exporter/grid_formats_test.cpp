// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/fused_grid.hpp"

#include "exporter/written.hpp"
#include "support/sample_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cstring>

namespace prodomos::exporter {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct Pgm {
  int width = 0;
  int height = 0;
  std::string pixels;

  int at(int x, int rowFromTop) const {
    return static_cast<unsigned char>(pixels.at(static_cast<std::size_t>(rowFromTop * width + x)));
  }
};

Pgm parsePgm(const std::string& bytes) {
  std::istringstream in(bytes);
  std::string magic;
  int most = 0;
  Pgm pgm;
  in >> magic >> pgm.width >> pgm.height >> most;
  EXPECT_EQ(magic, "P5");
  EXPECT_EQ(most, 255);
  pgm.pixels = bytes.substr(static_cast<std::size_t>(in.tellg()) + 1);
  EXPECT_EQ(pgm.pixels.size(), static_cast<std::size_t>(pgm.width * pgm.height));
  return pgm;
}

map::CellState stateOf(int grey) {
  EXPECT_TRUE(grey == 0 || grey == 205 || grey == 254) << grey;
  return grey == 0 ? map::CellState::kOccupied : grey == 254 ? map::CellState::kFree : map::CellState::kUnknown;
}

TEST(Nav2, WritesTheFusedGridOfEachFloorCellByCell) {
  const test::SampleMap sample;
  const auto view = sample.view();
  const auto files = test::writeAll("nav2", view);
  ASSERT_EQ(files.size(), 4U);
  for (const int floor : {0, 1}) {
    const std::string stem = "map_floor" + std::to_string(floor);
    const auto pgm = parsePgm(files.at(stem + ".pgm"));
    const auto yaml = YAML::Load(files.at(stem + ".yaml"));
    EXPECT_EQ(yaml["image"].as<std::string>(), stem + ".pgm");
    EXPECT_EQ(yaml["mode"].as<std::string>(), "trinary");
    EXPECT_EQ(yaml["free_thresh"].as<double>(), 0.196);
    EXPECT_EQ(yaml["occupied_thresh"].as<double>(), 0.65);
    const double resolution = yaml["resolution"].as<double>();
    EXPECT_EQ(resolution, test::SampleMap::kResolution);

    const auto grid = map::fuseGrids(view, floor);
    int known = 0;
    for (int row = 0; row < pgm.height; ++row) {
      for (int column = 0; column < pgm.width; ++column) {
        // As map_server places pixels: the origin is the lower left corner of the lower left pixel.
        const Eigen::Vector2d centre(yaml["origin"][0].as<double>() + (column + 0.5) * resolution,
                                     yaml["origin"][1].as<double>() + (pgm.height - row - 0.5) * resolution);
        const auto state = stateOf(pgm.at(column, row));
        ASSERT_EQ(state, grid.state(grid.cellAt(centre))) << column << ' ' << row;
        known += state != map::CellState::kUnknown ? 1 : 0;
      }
    }
    EXPECT_GT(known, 300);
  }
}

TEST(Nav2, KnowsNothingOfWhatIsPredicted) {
  const test::SampleMap sample;
  const auto yaml = YAML::Load(test::writeAll("nav2", sample.view()).at("map_floor0.yaml"));
  const auto pgm = parsePgm(test::writeAll("nav2", sample.view()).at("map_floor0.pgm"));
  EXPECT_NEAR(yaml["origin"][0].as<double>() + pgm.width * 0.25, 8.0, 1e-9);  // the closed door's wall is the end
}

/// Somebody at the origin of a hall, heading along x, with a wall on the left.
struct HallWithPerson {
  explicit HallWithPerson(int dominantSide) {
    std::vector<std::string> lines(81, std::string(81, '.'));
    lines[30] = std::string(81, '#');  // y = 0.5 m
    const auto grid = test::gridFromText({lines.begin(), lines.end()}, 0.05, {-40, -40});
    map::Entity person;
    person.id = {1};
    person.submap = {1};
    person.attributes = map::Human{.dominantSide = dominantSide};
    map::MapChange change;
    change.sessions = {{.id = {1}, .log = "log", .config = ""}};
    change.floors = {{0, 0.0}};
    change.nodes.resize(1);
    change.nodes[0].id = {1};
    change.nodes[0].session = {1};
    change.nodes[0].floor = 0;
    change.entities = {person};
    change.layers = {{base::SubMapId{1}, &grid}};
    store.commit(change);
  }

  map::MapStore store = map::MapStore::inMemory();
};

TEST(Nav2, TellsPeoplesSpaceAsACostOfItsOwn) {
  const HallWithPerson hall(1);
  const test::TemporaryFolder folder;
  ASSERT_NE(findExporter("nav2")->writeSocial, nullptr);
  findExporter("nav2")->writeSocial(hall.store.view(), folder.path() / "map.yaml");
  const auto yaml = YAML::Load(test::readFile(folder.path() / "map_social.yaml"));
  const auto pgm = parsePgm(test::readFile(folder.path() / "map_social.pgm"));
  EXPECT_EQ(yaml["image"].as<std::string>(), "map_social.pgm");
  EXPECT_EQ(yaml["mode"].as<std::string>(), "scale");
  EXPECT_EQ(yaml["occupied_thresh"].as<double>(), 1.0);
  EXPECT_EQ(yaml["free_thresh"].as<double>(), 0.0);
  // As map_server reads it.
  const auto costAt = [&](double x, double y) {
    const auto column = static_cast<int>((x - yaml["origin"][0].as<double>()) / 0.05);
    const auto row = static_cast<int>((y - yaml["origin"][1].as<double>()) / 0.05);
    return std::round(100.0 * (255 - pgm.at(column, pgm.height - 1 - row)) / 255.0);
  };
  EXPECT_GT(costAt(0.02, 0.02), 70);
  EXPECT_NEAR(costAt(0.62, 0.02), costAt(-0.62, 0.02), 1) << "the same ahead and behind";
  EXPECT_GT(costAt(0.02, 0.32), costAt(0.02, -0.32)) << "the dominant side is the right one";
  EXPECT_GT(costAt(0.02, 0.42), 50);
  EXPECT_EQ(costAt(0.02, 0.72), 0) << "behind the wall";
  EXPECT_EQ(costAt(0.02, -1.6), 0);
}

TEST(Nav2, HasNoPersonWhereThereIsNone) {
  const test::SampleMap sample;
  const test::TemporaryFolder folder;
  findExporter("nav2")->writeSocial(sample.view(), folder.path() / "map.yaml");
  const auto office = parsePgm(test::readFile(folder.path() / "map_floor0_social.pgm"));
  const auto upstairs = parsePgm(test::readFile(folder.path() / "map_floor1_social.pgm"));
  EXPECT_NE(office.pixels.find_first_not_of('\xff'), std::string::npos);
  EXPECT_EQ(upstairs.pixels.find_first_not_of('\xff'), std::string::npos);
}

TEST(Nav2, NamesTheFilesOfASingleFloorAsTold) {
  auto store = map::MapStore::inMemory();
  const auto grid = test::gridFromText({"#.#", "#  "}, 0.05);
  map::MapChange change;
  change.sessions.emplace_back().id = {1};
  change.floors = {{.number = 3, .height = 9.0}};
  auto& node = change.nodes.emplace_back();
  node.id = {1};
  node.session = {1};
  node.floor = 3;
  change.layers = {{node.id, &grid}};
  store.commit(change);
  const auto files = test::writeAll("nav2", store.view());
  ASSERT_EQ(files.size(), 2U);
  const auto pgm = parsePgm(files.at("map.pgm"));
  const std::string expected = {0, static_cast<char>(254), 0, 0, static_cast<char>(205), static_cast<char>(205)};
  EXPECT_EQ(pgm.pixels, expected);
  EXPECT_THAT(files.at("map.yaml"), HasSubstr("image: \"map.pgm\"\n"));
}

TEST(Ply, HoldsAllPointsInTheMapFrame) {
  const test::SampleMap sample;
  const auto bytes = test::write("ply", sample.view());
  EXPECT_THAT(bytes, StartsWith("ply\nformat binary_little_endian 1.0\n"));
  EXPECT_THAT(bytes, HasSubstr("element vertex 2\n"));
  const std::string end = "end_header\n";
  const auto body = bytes.substr(bytes.find(end) + end.size());
  constexpr std::size_t kRow = 3 * sizeof(float) + 3 + sizeof(std::int32_t);
  ASSERT_EQ(body.size(), 2 * kRow);
  float position[3];
  std::memcpy(position, body.data(), sizeof position);
  // (1, 2, 0.5) in s3, which lies at (5, 2.75) and is turned by a quarter.
  EXPECT_NEAR(position[0], 5.0 - 2.0, 1e-5);
  EXPECT_NEAR(position[1], 2.75 + 1.0, 1e-5);
  EXPECT_NEAR(position[2], 0.5, 1e-5);
  EXPECT_EQ(body.substr(12, 3), std::string("\xff\0\0", 3));
  std::int32_t submap = 0;
  std::memcpy(&submap, body.data() + 15, sizeof submap);
  EXPECT_EQ(submap, 3);
}

}  // namespace
}  // namespace prodomos::exporter

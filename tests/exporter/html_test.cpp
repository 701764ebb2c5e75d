// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/exporter/html.hpp"

#include "prodomos/base/error.hpp"

#include "exporter/html_images.hpp"
#include "exporter/simplify.hpp"
#include "support/sample_house.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>

namespace prodomos::exporter {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class HtmlPage : public ::testing::Test {
 protected:
  HtmlPage() {
    folder_ = std::filesystem::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~HtmlPage() override { std::filesystem::remove_all(folder_); }

  std::string page(const map::MapStore& store, const HtmlOptions& options = {}) {
    writeHtml(store.view(), folder_ / "page.html", options);
    std::ifstream in(folder_ / "page.html", std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  static json dataOf(const std::string& page) {
    const std::string begin = R"(<script id="prodomos-data" type="application/json">)";
    const auto from = page.find(begin) + begin.size();
    return json::parse(page.substr(from, page.find("</script>", from) - from));
  }

  std::filesystem::path folder_;
};

// A matcher would print the whole page where it fails.
bool holds(const std::string& page, std::string_view part) {
  return page.find(part) != std::string::npos;
}

std::vector<std::string> idsOf(const json& list) {
  std::vector<std::string> ids;
  for (const auto& thing : list) ids.push_back(thing.at("id"));
  return ids;
}

/// Width and height as the header of a PNG says.
std::pair<int, int> pngSize(const std::string& png) {
  const auto number = [&png](std::size_t at) {
    return static_cast<int>(static_cast<unsigned char>(png.at(at + 2))) * 256 +
           static_cast<int>(static_cast<unsigned char>(png.at(at + 3)));
  };
  return {number(16), number(20)};
}

map::OccupancyGrid lane(double length) {
  map::OccupancyGrid grid;
  const std::array<map::OccupancyGrid::Beam, 1> beam{{{{length, 0.0}, true}}};
  for (int i = 0; i < 3; ++i) grid.insert(Eigen::Vector2d::Zero(), beam);
  return grid;
}

TEST_F(HtmlPage, IsOneFileThatAsksTheNetworkForNothing) {
  const auto text = page(test::sampleHouse());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
  EXPECT_FALSE(std::regex_search(text, std::regex(R"(<(script|img|link|iframe)[^>]*\s(src|href)=(?!["']?data:))")));
  EXPECT_FALSE(holds(text, "sourceMappingURL"));
  EXPECT_FALSE(holds(text, "@import"));
  EXPECT_FALSE(std::regex_search(text, std::regex(R"(url\(["']?(?!["'#]|data:))")));
  EXPECT_TRUE(holds(text, "default-src 'none'"));
  EXPECT_TRUE(holds(text, "Redistribution and use in source and binary forms")) << "Leaflet's licence";
}

TEST_F(HtmlPage, HoldsAllNodesEdgesEntitiesAndPredictions) {
  const auto data = dataOf(page(test::sampleHouse()));
  EXPECT_EQ(idsOf(data["nodes"]), (std::vector<std::string>{"s1", "s2", "s3", "s4", "s5", "s6"}));
  EXPECT_EQ(idsOf(data["edges"]), (std::vector<std::string>{"e1", "e2", "e3", "e4", "e5"}));
  EXPECT_EQ(idsOf(data["entities"]), (std::vector<std::string>{"o1", "o2", "o3", "o4", "o5", "o6"}));
  EXPECT_EQ(idsOf(data["predictions"]), (std::vector<std::string>{"p1"}));
  EXPECT_EQ(data["edges"][1]["cause"], "o1");
  EXPECT_EQ(data["totals"]["submaps"], 5);
  EXPECT_EQ(data["totals"]["predicted"], 1);
  EXPECT_EQ(data["totals"]["places"], 4);
  EXPECT_EQ(data["floors"].size(), 2U);
  EXPECT_EQ(data["floors"][1]["number"], 1);
  EXPECT_EQ(data["floors"][1]["height"], 3.2);
}

TEST_F(HtmlPage, SaysOfANodeWhatItHolds) {
  const auto node = dataOf(page(test::sampleHouse()))["nodes"][3];
  EXPECT_EQ(node["kind"], "observed");
  EXPECT_EQ(node["floor"], 0);
  EXPECT_EQ(node["session"], "r1");
  EXPECT_EQ(node["readings"], 147);
  EXPECT_EQ(node["pose"], (json{11.5, 4.6, 0, 1.4}));
  ASSERT_EQ(node["layers"].size(), map::layerTypes().size());
  EXPECT_EQ(node["layers"][0]["type"], "occupancy_grid");
  EXPECT_FALSE(node["layers"][0]["summary"].empty());
  EXPECT_FALSE(node["thumb"]["png"].get<std::string>().empty());
  EXPECT_EQ(node["outline"].size(), 4U);
}

TEST_F(HtmlPage, DrawsPredictionsInTheMapFrame) {
  const auto area = dataOf(page(test::sampleHouse()))["predictions"][0]["areas"][0];
  // (5, 0) of a node at (20.5, 5.5) that looks along y.
  EXPECT_NEAR(area["outline"][2][0], 20.5, 0.01);
  EXPECT_NEAR(area["outline"][2][1], 10.5, 0.01);
}

TEST_F(HtmlPage, BreaksTheTrajectoryWhereTheFloorChanges) {
  const auto pieces = dataOf(page(test::sampleHouse()))["trajectory"];
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0]["floor"], 0);
  EXPECT_EQ(pieces[1]["floor"], 1);
  EXPECT_LT(pieces[0]["refined"].size(), 40U) << "straight stretches need two points";
}

TEST_F(HtmlPage, TellsNoFolderOfTheMachine) {
  EXPECT_FALSE(holds(page(test::sampleHouse("/home/someone/logs/run.rawlog")), "someone"));
}

TEST_F(HtmlPage, EscapesHostileNames) {
  const std::string hostile = "</script><script>alert('x')<!--<b>\"&@prodomos_title@\xff.rawlog";
  const auto text = page(test::sampleHouse("/data/" + hostile));
  EXPECT_FALSE(holds(text, "<script>alert"));
  EXPECT_FALSE(holds(text, "<b>"));
  EXPECT_THAT(dataOf(text)["title"].get<std::string>(), HasSubstr("script><script>alert('x')<!--<b>\"&"));
}

TEST_F(HtmlPage, IsTheSameForTheSameMap) {
  EXPECT_TRUE(page(test::sampleHouse()) == page(test::sampleHouse()));  // not EXPECT_EQ: it would print both
}

TEST_F(HtmlPage, OfAnEmptyMapIsAPageToo) {
  const auto data = dataOf(page(map::MapStore::inMemory()));
  EXPECT_TRUE(data["nodes"].empty());
  EXPECT_EQ(data["totals"]["submaps"], 0);
}

TEST_F(HtmlPage, FollowsOnlyWhenTold) {
  EXPECT_EQ(dataOf(page(test::sampleHouse()))["followSeconds"], 0.0);
  EXPECT_EQ(dataOf(page(test::sampleHouse(), {.followSeconds = 2.5}))["followSeconds"], 2.5);
}

TEST_F(HtmlPage, StaysSmallForALargeMap) {
  constexpr int kCount = 120;
  const auto withGraphOnly = page(map::MapStore::inMemory()).size();
  const auto perSubMap = (page(test::sampleStoreHouse(kCount)).size() - withGraphOnly) / kCount;
  EXPECT_LT(perSubMap, 15'000U) << "a thousand sub-maps in 20 MB, with room to spare";
}

TEST_F(HtmlPage, SaysWhereItCannotWrite) {
  const auto view = test::sampleHouse().view();
  EXPECT_THROW(writeHtml(view, folder_ / "missing" / "page.html", {}), base::FileError);
}

TEST(PlanImages, AreCoarserWhereTheGridIsTooLarge) {
  const auto grid = lane(10.0);
  const auto images = planImages(grid, {}, {}, {1'000'000, 60});
  ASSERT_EQ(images.size(), 2U);
  EXPECT_EQ(pngSize(images[0].png).first, 201);
  EXPECT_EQ(images[0].pixel, grid.resolution());
  EXPECT_LE(pngSize(images[1].png).first, 101);
  EXPECT_GT(images[1].pixel, grid.resolution());
  EXPECT_NEAR(images[1].size.x(), images[0].size.x(), 0.2);
  EXPECT_TRUE(planImages(map::OccupancyGrid(), {}, {}, {100}).empty());
}

TEST(ThumbnailImage, LiesWithTheHeadingUp) {
  const auto thumbnail = thumbnailImage(lane(10.0), 160);
  ASSERT_TRUE(thumbnail);
  const auto [width, height] = pngSize(thumbnail->png);
  EXPECT_EQ(width, 1);
  EXPECT_GT(height, 90);
  EXPECT_LE(height, 160);
}

TEST(TopView, LeavesCeilingsOut) {
  TopView view(0.05);
  map::Drawing drawing;
  drawing.points.push_back({{1.0F, 1.0F, 2.6F}, {255, 0, 0, 255}});
  view.add(drawing, geometry::Pose3::Identity());
  EXPECT_TRUE(view.empty());
  drawing.points.push_back({{-1.0F, 1.0F, 0.4F}, {255, 0, 0, 255}});
  view.add(drawing, geometry::Pose3::Identity());
  EXPECT_FALSE(view.empty());
  const auto image = view.image(4);
  EXPECT_EQ(pngSize(image.png), std::pair(64, 64));
  EXPECT_NEAR(image.corner.x(), -12.8, 1e-9);
}

TEST(Simplified, KeepsCornersAndDropsWhatLiesBetween) {
  EXPECT_EQ(simplified({{0, 0}, {1, 0.001}, {2, 0}, {2, 1}, {2, 2}}, 0.01), (Polyline{{0, 0}, {2, 0}, {2, 2}}));
  EXPECT_EQ(simplified({{0, 0}}, 0.01).size(), 1U);
  EXPECT_EQ(simplified({{0, 0}, {0, 0}, {0, 0}}, 0.01).size(), 2U);
}

TEST(Base64, IsThatOfTheStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace prodomos::exporter

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/score_page.hpp"

#include "prodomos/base/error.hpp"

#include "evaluation/flat.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <sstream>

namespace prodomos::evaluation {
namespace {

using test::FlatMap;
using test::flat::at;
using test::flat::kFloor;
using testing::HasSubstr;
using testing::Not;

std::string contentOf(const std::filesystem::path& path) {
  std::ostringstream content;
  content << std::ifstream(path, std::ios::binary).rdbuf();
  return content.str();
}

std::size_t countIn(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// Every element that is opened is closed, in their order.
void expectBalanced(const std::string& svg) {
  std::vector<std::string> open;
  for (auto at = svg.find('<'); at != std::string::npos; at = svg.find('<', at + 1)) {
    const auto end = svg.find('>', at);
    ASSERT_NE(end, std::string::npos);
    if (svg[end - 1] == '/') continue;
    const auto name = svg.substr(at + 1, svg.find_first_of(" >", at) - at - 1);
    if (!name.starts_with('/')) {
      open.push_back(name);
      continue;
    }
    ASSERT_FALSE(open.empty());
    EXPECT_EQ(open.back(), name.substr(1));
    open.pop_back();
  }
  EXPECT_TRUE(open.empty());
}

class ScorePageFile : public testing::Test {
 protected:
  const test::TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "page.html";
};

TEST_F(ScorePageFile, HasTablesAndPicturesAndNeedsNoNetwork) {
  const ScorePage page{.title = "Scores of <a & b>",
                       .lines = {"one \"line\""},
                       .tables = {{.title = "Doors", .columns = {"", "recall"}, .rows = {{"visible", "0.912"}}}},
                       .pictures = {{.title = "Plan", .svg = "<svg></svg>", .legend = {{"way", "the way", true}}}}};
  writeScorePage(page, path_);
  const auto html = contentOf(path_);
  EXPECT_THAT(html, HasSubstr("<h1>Scores of &lt;a &amp; b&gt;</h1>"));
  EXPECT_THAT(html, HasSubstr("one &quot;line&quot;"));
  EXPECT_THAT(html, HasSubstr("<th>recall</th>"));
  EXPECT_THAT(html, HasSubstr("<td>visible</td><td>0.912</td>"));
  EXPECT_THAT(html, HasSubstr("the way"));
  EXPECT_THAT(html, HasSubstr("prefers-color-scheme: dark"));
  EXPECT_THAT(html, Not(HasSubstr("http")));
  writeScorePage(page, path_);
  EXPECT_EQ(contentOf(path_), html);
}

TEST_F(ScorePageFile, ThatCannotBeWrittenIsAnError) {
  EXPECT_THROW(writeScorePage({}, folder_.path() / "none" / "page.html"), base::FileError);
}

TEST(Figures, ThatAreNoneAreADash) {
  EXPECT_EQ(figure(0.91249), "0.912");
  EXPECT_EQ(figure(-0.0001, 2), "0.00");
  EXPECT_EQ(figure(std::nullopt), "–");
  EXPECT_EQ(figure(std::numeric_limits<double>::quiet_NaN()), "–");
}

Truth withDoors() {
  auto truth = test::flat::truth();
  truth.rooms[1].entered = at(9);
  auto& door = truth.doors[0];
  door.leaves = 1;
  door.sighting.visible = true;
  auto other = door;
  other.id = "missed one";
  other.T_world_door = geometry::toPose3({0.0, 2.0, 0.0}, kFloor);
  truth.doors.push_back(other);
  truth.people = {
      {.id = "ada",
       .states = {{.time = at(0), .position = {1, 1, kFloor}}, {.time = at(1), .position = {2, 1, kFloor}}}}};
  return truth;
}

TEST(PlanPicture, ShowsWhatIsFoundMissedAndWrong) {
  const auto truth = withDoors();
  FlatMap map;
  map.add(1, geometry::toPose3({4.1, 2.05, 0.0}, kFloor + 1.0), map::Door{.width = 0.9});
  map.add(1, geometry::toPose3({2.0, 3.9, 1.5}, kFloor + 1.0), map::Door{.width = 0.9});
  const auto pictures = planPictures(map.view(), truth);
  ASSERT_EQ(pictures.size(), 1U);  // the robot was on one storey
  const auto& svg = pictures[0].svg;
  expectBalanced(svg);
  EXPECT_EQ(countIn(svg, "<circle class=\"claim right\""), 1U);
  EXPECT_EQ(countIn(svg, "<circle class=\"claim wrong\""), 1U);
  EXPECT_EQ(countIn(svg, "class=\"missed\""), 1U);
  EXPECT_THAT(svg, HasSubstr("missed one is missed"));
  EXPECT_EQ(countIn(svg, "class=\"room entered\""), 1U);
  EXPECT_EQ(countIn(svg, "class=\"room\""), 1U);
  EXPECT_EQ(countIn(svg, "class=\"way\""), 1U);
  EXPECT_EQ(countIn(svg, "class=\"mapped-way\""), 1U);
  EXPECT_EQ(countIn(svg, "<polyline class=\"person\""), 1U);
  EXPECT_EQ(countIn(svg, ">OFFICE</text>"), 2U);
}

TEST(PlanPicture, NamesRoomsOnlyWhereTheNameFits) {
  auto truth = withDoors();
  truth.rooms[0].outline = {{0, 0}, {1, 0}, {1, 4}, {0, 4}};
  truth.rooms[0].label = "A VERY LONG NAME OF A CUPBOARD";
  FlatMap map;
  const auto pictures = planPictures(map.view(), truth);
  EXPECT_THAT(pictures[0].svg, Not(HasSubstr(">A VERY LONG NAME OF A CUPBOARD</text>")));
  EXPECT_THAT(pictures[0].svg, HasSubstr("<title>A VERY LONG NAME OF A CUPBOARD a</title>"));
}

TEST(PlanPicture, IsTheSameWhereverTheMapLies) {
  const auto truth = withDoors();
  FlatMap still(geometry::Pose3::Identity());
  FlatMap moved;
  for (auto* map : {&still, &moved}) {
    map->add(1, geometry::toPose3({4.1, 2.05, 0.0}, kFloor + 1.0), map::Door{.width = 0.9});
  }
  for (auto* map : {&still, &moved}) {
    EXPECT_THAT(planPictures(map->view(), truth)[0].svg,
                HasSubstr(R"(<circle class="claim right" cx="229.5" cy="132.8")"));
  }
}

TEST(ReliabilityPicture, HasADotForEachBinThatHoldsBets) {
  std::vector<Bet> bets;
  for (int i = 0; i < 30; ++i) bets.push_back({0.05 + 0.1 * (i % 3), i % 2 == 0});
  const auto picture = reliabilityPicture(*calibrationOf(bets));
  expectBalanced(picture.svg);
  EXPECT_EQ(countIn(picture.svg, "class=\"dot\""), 3U);
  EXPECT_EQ(countIn(picture.svg, "class=\"bar\""), 3U);
  EXPECT_THAT(picture.title, HasSubstr("30 bets"));
  EXPECT_THAT(picture.svg, HasSubstr("10 said 0.05, came true 0.50"));
}

}  // namespace
}  // namespace prodomos::evaluation

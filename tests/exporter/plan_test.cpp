// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/plan.hpp"

#include "exporter/palette.hpp"
#include "exporter/written.hpp"
#include "support/sample_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prodomos::exporter {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

Picture samplePlan() {
  const test::SampleMap sample;
  return planOf(sample.view());
}

const Group& group(const Picture& picture, std::string_view name) {
  return *std::ranges::find(picture.groups, name, &Group::name);
}

std::vector<std::string> texts(const Group& group) {
  std::vector<std::string> found;
  for (const auto& shape : group.shapes) {
    if (const auto* const text = std::get_if<Text>(&shape)) found.push_back(text->text);
  }
  return found;
}

TEST(Plan, DrawsEachNodeOnceInTheColourOfItsPlace) {
  const auto picture = samplePlan();
  const auto& nodes = group(picture, "nodes").shapes;
  ASSERT_EQ(nodes.size(), 6U);
  const auto fill = [&](std::size_t i) { return *std::get<Circle>(nodes.at(i)).style.fill; };
  EXPECT_EQ(fill(0), fill(1));  // s1 and s2 share a place
  EXPECT_NE(fill(1), fill(2));  // a door lies between s2 and s3
  EXPECT_EQ(std::get<Circle>(nodes.at(5)).style.stroke, kPredictedColor);
}

TEST(Plan, StandsFloorsSideBySideAtOneScale) {
  const auto picture = samplePlan();
  EXPECT_THAT(texts(group(picture, "title")), testing::IsSupersetOf({"floor 0", "floor 1"}));
  const auto& nodes = group(picture, "nodes").shapes;
  const auto at = [&](std::size_t i) { return std::get<Circle>(nodes.at(i)).centre; };
  EXPECT_NEAR((at(1) - at(0)).norm(), (at(4) - at(3)).norm(), 1e-6);  // both 5 m
  EXPECT_GT(at(3).x(), at(2).x());
}

TEST(Plan, HasYUpwards) {
  const auto picture = samplePlan();
  const auto& nodes = group(picture, "nodes").shapes;
  EXPECT_LT(std::get<Circle>(nodes.at(2)).centre.y(), std::get<Circle>(nodes.at(1)).centre.y());
}

TEST(Plan, ExplainsWhatItShowsAndNothingElse) {
  const auto legend = texts(group(samplePlan(), "legend"));
  EXPECT_THAT(legend, testing::IsSupersetOf({"door", "person", "stairs, uphill", "loop closure", "2 m"}));
  EXPECT_THAT(legend, testing::Not(testing::Contains("by lift")));
}

TEST(Plan, SaysThatAMapIsEmpty) {
  const auto picture = planOf(map::MapStore::inMemory().view());
  EXPECT_THAT(texts(group(picture, "title")), testing::Contains(StartsWith("0 sub-maps")));
  EXPECT_GT(picture.height, 50.0);
}

TEST(Plan, DrawsFloorThatIsFreeIfSomebodyLeavesInTheColourOfPeople) {
  auto store = map::MapStore::inMemory();
  map::MapChange change;
  change.sessions.emplace_back().id = {1};
  change.nodes.emplace_back().id = {1};
  change.nodes[0].session = {1};
  change.entities.emplace_back().id = {1};
  change.entities[0].submap = {1};
  change.entities[0].attributes = map::Human{};
  for (const auto state : {map::PredictionState::kOpen, map::PredictionState::kConfirmed}) {
    auto& strip = change.predictions.emplace_back();
    strip.id = {static_cast<std::int64_t>(change.predictions.size())};
    strip.cause = {1};
    strip.submap = strip.node = {1};
    strip.state = state;
    strip.areas = {{.threshold = 0.5, .outline_in_node = {{0, 0}, {2, 0}, {2, 1}}}};
  }
  store.commit(change);
  const auto picture = planOf(store.view());
  const auto& areas = group(picture, "predicted-areas").shapes;
  ASSERT_EQ(areas.size(), 1U) << "of the other one, somebody has seen what is there";
  EXPECT_EQ(std::get<Line>(areas[0]).style.stroke, kHumanColor);
  EXPECT_THAT(std::get<Line>(areas[0]).tip, HasSubstr("free if the person leaves"));
  const auto& nodes = group(picture, "nodes").shapes;
  EXPECT_NE(std::get<Circle>(nodes.at(0)).style.stroke, kPredictedColor) << "somebody was there";
}

TEST(Plan, LeavesOutLabelsForWhichThereIsNoRoom) {
  auto store = map::MapStore::inMemory();
  map::MapChange change;
  change.sessions.emplace_back().id = {1};
  for (int i = 0; i < 400; ++i) {
    auto& node = change.nodes.emplace_back();
    node.id = {i};
    node.session = {1};
    const double x = i == 0 ? -80.0 : 0.1 * (i % 20);  // one far off, so that the others are small
    node.T_map_submap = geometry::toPose3({x, 0.1 * (i / 20), 0.0});
  }
  store.commit(change);
  const auto picture = planOf(store.view());
  const auto count = texts(group(picture, "labels")).size();
  EXPECT_GT(count, 0U);
  EXPECT_LT(count, 100U);
}

TEST(Svg, IsWellFormedAndHasRealText) {
  const test::SampleMap sample;
  const auto svg = test::write("svg", sample.view());
  EXPECT_THAT(svg, HasSubstr("sample &lt;&amp;&gt; &quot;map&quot;.rawlog</text>"));
  EXPECT_THAT(svg, HasSubstr("<g id=\"trajectory\">"));
  EXPECT_THAT(svg, HasSubstr("<g id=\"trails\">"));
  if (!test::runPython("", "").well) GTEST_SKIP() << "needs python3";
  const auto ran = test::runPython(
      "import sys, xml.dom.minidom\n"
      "document = xml.dom.minidom.parse(sys.argv[1])\n"
      "print(len(document.getElementsByTagName('image')))\n",
      svg);
  EXPECT_TRUE(ran.well) << ran.output;
  EXPECT_EQ(ran.output, "2\n");  // one grid a floor
}

TEST(Png, HasTheSizeOfThePicture) {
  const test::SampleMap sample;
  const auto picture = planOf(sample.view());
  const auto png = test::write("png", sample.view());
  ASSERT_THAT(png, StartsWith("\x89PNG\r\n\x1a\n"));
  const auto number = [&png](std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8U | static_cast<unsigned char>(png.at(at + i));
    return value;
  };
  EXPECT_EQ(number(16), std::lround(2 * picture.width));
  EXPECT_EQ(number(20), std::lround(2 * picture.height));
}

}  // namespace
}  // namespace prodomos::exporter

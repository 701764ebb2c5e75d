// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/door_segments.hpp"

#include "perception/door_candidates.hpp"
#include "perception/door_points.hpp"
#include "perception/door_verdict.hpp"
#include "support/door_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace prodomos::perception {
namespace {

using test::DoorScene;
using test::DrawnDoor;

constexpr double kStraight = std::numbers::pi / 2.0;
constexpr double kContrast = 8.0;
constexpr double kTilt = 0.09;

/// The wall of a scene, seen straight on from the origin's height.
RectifiedWall wallOf(const DoorScene& drawn) {
  const auto frame = drawn.see(0.0, -3.2, kStraight);
  const RgbdView view{.frame = frame, .T_submap_camera = DoorScene::cameraPose(0.0, -3.2, kStraight), .floor_z = 0.0};
  const auto surfaces = findSurfaces(view, SurfacesConfig{});
  return {view, surfaces, findWalls(view, surfaces).at(0), 8.0};
}

const UprightLine* lineAt(const std::vector<UprightLine>& lines, const RectifiedWall& wall, double x) {
  const auto line = std::ranges::find_if(
      lines, [&](const UprightLine& candidate) { return std::abs(wall.xOf(candidate.column) - x) < 0.025; });
  return line == lines.end() ? nullptr : &*line;
}

TEST(WallEdges, FrameAndLeafGiveUprightLines) {
  const auto wall = wallOf(DoorScene({DrawnDoor{.left = -0.45, .recess = 0.0}}));
  const WallEdges edges(wall, kContrast);
  const auto lines = edges.uprightLines(kTilt);
  for (const double x : {-0.45 - DoorScene::kFrame, -0.45, 0.45, 0.45 + DoorScene::kFrame}) {
    const auto* line = lineAt(lines, wall, x);
    ASSERT_NE(line, nullptr) << x;
    EXPECT_LT(std::abs(line->slope), 0.02);
    EXPECT_GT(edges.support(*line, static_cast<int>(wall.rowOf(1.9)), static_cast<int>(wall.rowOf(0.1))), 0.8);
  }
}

TEST(WallEdges, LeaningLinesAreNone) {
  DoorScene drawn({});
  // A staircase of boxes leans by 20 degrees.
  for (int i = 0; i < 60; ++i) {
    const double z = 0.3 + 0.02 * i;
    const double x = 0.36 * (z - 0.3);
    drawn.add({x, -0.01, z}, {x + 0.3, 0.0, z + 0.02}, {60, 60, 160}, "poster");
  }
  const auto wall = wallOf(drawn);
  const auto lines = WallEdges(wall, kContrast).uprightLines(kTilt);
  EXPECT_TRUE(std::ranges::none_of(lines, [](const UprightLine& line) { return line.pixels > 40; }));
}

TEST(WallEdges, PlainWallHasNone) {
  const auto wall = wallOf(DoorScene({}));
  EXPECT_TRUE(WallEdges(wall, kContrast).uprightLines(kTilt).empty());
}

TEST(WallEdges, TopOfADoorIsALevelEdge) {
  const auto wall = wallOf(DoorScene({DrawnDoor{.recess = 0.0}}));
  const WallEdges edges(wall, kContrast);
  const auto column = [&](double x) { return static_cast<int>(std::lround(wall.columnOf(x))); };
  const auto row = static_cast<int>(std::lround(wall.rowOf(DoorScene::kHeight)));
  double onDoor = 0.0;
  double onWall = 0.0;
  for (int i = -2; i <= 2; ++i) {
    onDoor = std::max(onDoor, edges.levelEdge(row + i, column(-0.4), column(0.4)));
    onWall = std::max(onWall, edges.levelEdge(row + i, column(0.8), column(1.2)));
  }
  EXPECT_GT(onDoor, 0.9);
  EXPECT_LT(onWall, 0.1);
  EXPECT_GT(edges.levelContrast(row, column(-0.4), column(0.4)), edges.levelContrast(row, column(0.8), column(1.2)));
}

TEST(DoorCandidates, OneIsTheDoor) {
  const auto wall = wallOf(DoorScene({DrawnDoor{.left = -0.45}}));
  const WallEdges edges(wall, kContrast);
  const auto candidates = pairLines(wall, edges, edges.uprightLines(kTilt));
  const auto door = std::ranges::find_if(candidates, [](const DoorCandidate& pair) {
    return std::abs(pair.left_x + 0.45) < 0.1 && std::abs(pair.right_x - 0.45) < 0.1;
  });
  ASSERT_NE(door, candidates.end());
  EXPECT_GT(evidenceOf(*door), 0.0);
  EXPECT_NEAR(door->top_z, DoorScene::kHeight, 0.05);
}

TEST(DoorCandidates, CuesTellAPanelFromADoor) {
  DoorScene drawn({});
  drawn.add({-0.45, -0.04, 0.1}, {0.45, 0.0, 2.05}, {150, 110, 80}, "board");
  const auto wall = wallOf(drawn);
  const WallEdges edges(wall, kContrast);
  for (const auto& candidate : pairLines(wall, edges, edges.uprightLines(kTilt))) {
    EXPECT_LT(evidenceOf(candidate), 0.0);
    EXPECT_GT(candidate.cue(Cue::kSkirtingAlike) + candidate.cue(Cue::kSkirting), 0.3);
    EXPECT_GT(candidate.cue(Cue::kStandsOut), 0.5);
    EXPECT_FALSE(weakestPoint(candidate).empty());
  }
}

TEST(DoorHandle, IsWhereItsCornersAre) {
  for (const bool hingeIsLeft : {true, false}) {
    const auto wall = wallOf(DoorScene({DrawnDoor{.hingeIsLeft = hingeIsLeft}}));
    const Handle handle = findHandle(wall, -0.45, 0.45, 0.05);
    EXPECT_EQ(handle.right > handle.left, hingeIsLeft);
  }
}

TEST(DoorPoints, AlignedPairsAtADoorsWidth) {
  const auto wall = wallOf(DoorScene({DrawnDoor{.recess = 0.0}}));
  const auto points = salientPoints(wall);
  const auto groups = groupsOf(wall, points);
  EXPECT_FALSE(groups.bottom.empty());
  EXPECT_FALSE(groups.top.empty());
  const auto pairs = pairPoints(wall, groups);
  ASSERT_FALSE(pairs.empty());
  EXPECT_NEAR(0.5 * (pairs[0].left_x + pairs[0].right_x), 0.0, 0.15);
  EXPECT_TRUE(pairPoints(wall, {}).empty());
}

}  // namespace
}  // namespace prodomos::perception

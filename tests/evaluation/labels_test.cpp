// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/labels.hpp"

#include "prodomos/base/error.hpp"

#include "evaluation/flat.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prodomos::evaluation {
namespace {

using test::flat::at;
using test::flat::kFloor;

constexpr int kWall = 1;
constexpr int kFloorClass = 2;
constexpr int kChair = 3;
constexpr int kTable = 4;

/// A floor of 4 x 4 m, a wall at x = 0, and a table on the floor.
Truth room() {
  auto truth = test::flat::truth();
  geometry::Pose3 wall = geometry::Pose3::Identity();
  wall.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  wall.translation() << 0.0, 0.0, kFloor;
  truth.planes = {{.id = "floor",
                   .classId = kFloorClass,
                   .T_world_plane = geometry::toPose3({0, 0, 0}, kFloor),
                   .outline_in_plane = {{0, 0}, {4, 0}, {4, 4}, {0, 4}}},
                  {.id = "wall",
                   .classId = kWall,
                   .T_world_plane = wall,
                   .outline_in_plane = {{0, 0}, {4, 0}, {4, 2.8}, {0, 2.8}}}};
  truth.objects = {{.id = "table",
                    .classId = kTable,
                    .storey = 1,
                    .size = {1.0, 0.8, 0.75},
                    .poses = {{at(0), geometry::toPose3({2, 2, 0}, kFloor + 0.375)}}}};
  return truth;
}

LabelledVoxels voxelsOf(const Truth& truth) {
  return {.classes = truth.classes, .size = 0.1, .voxels = {}};
}

TEST(Labels, ThatAreRightScorePerfectly) {
  const auto truth = room();
  auto voxels = voxelsOf(truth);
  for (double y = 0.35; y < 4.0; y += 0.1) {
    voxels.voxels.push_back({{0.35, y, kFloor + 0.01}, kFloorClass});
    voxels.voxels.push_back({{0.02, y, kFloor + 1.5}, kWall});
  }
  voxels.voxels.push_back({{2.0, 2.0, kFloor + 0.75}, kTable});
  const auto score = scoreLabels(voxels, truth);
  EXPECT_EQ(score.compared(), voxels.voxels.size());
  EXPECT_EQ(score.accuracy(), 1.0);
  EXPECT_EQ(score.meanIou(), 1.0);
  EXPECT_EQ(score.stray, 0U);
  EXPECT_EQ(score.iou(kWall), 1.0);
  EXPECT_FALSE(score.iou(kChair).has_value());
}

TEST(Labels, ThatAreConfusedAreCountedByPairs) {
  const auto truth = room();
  auto voxels = voxelsOf(truth);
  for (int i = 0; i < 6; ++i) voxels.voxels.push_back({{0.0, 1.0 + 0.1 * i, kFloor + 1.5}, kWall});
  for (int i = 0; i < 2; ++i) voxels.voxels.push_back({{0.0, 1.0 + 0.1 * i, kFloor + 1.7}, kChair});
  for (int i = 0; i < 2; ++i) voxels.voxels.push_back({{3.0, 1.0 + 0.1 * i, kFloor}, kWall});
  const auto score = scoreLabels(voxels, truth);
  const std::map<std::pair<int, int>, std::size_t> expected = {
      {{kWall, kWall}, 6}, {{kWall, kChair}, 2}, {{kFloorClass, kWall}, 2}};
  EXPECT_EQ(score.confusion, expected);
  EXPECT_DOUBLE_EQ(score.accuracy().value(), 0.6);
  EXPECT_DOUBLE_EQ(score.iou(kWall).value(), 6.0 / 10.0);
  EXPECT_DOUBLE_EQ(score.iou(kFloorClass).value(), 0.0);
  EXPECT_DOUBLE_EQ(score.meanIou().value(), 0.3);  // over wall and floor: no chair was there
}

TEST(Labels, OfVoxelsThatTwoSurfacesPassMayBeEither) {
  const auto truth = room();
  auto voxels = voxelsOf(truth);
  const Eigen::Vector3d edge(0.03, 2.0, kFloor + 0.03);
  voxels.voxels = {{edge, kWall}, {edge, kFloorClass}, {edge, kTable}};
  const auto score = scoreLabels(voxels, truth);
  EXPECT_EQ(score.compared(), 3U);
  EXPECT_NEAR(score.accuracy().value(), 2.0 / 3.0, 1e-12);
}

TEST(Labels, OfStrayAndUnlabeledVoxelsAreCountedApart) {
  const auto truth = room();
  auto voxels = voxelsOf(truth);
  voxels.voxels = {{{1.0, 1.0, kFloor + 1.5}, kWall}, {{0.0, 1.0, kFloor + 1.5}, kUnlabeled}};
  const auto score = scoreLabels(voxels, truth);
  EXPECT_EQ(score.stray, 1U);
  EXPECT_EQ(score.unlabeled, 1U);
  EXPECT_EQ(score.compared(), 0U);
  EXPECT_FALSE(score.accuracy().has_value());
  EXPECT_FALSE(score.meanIou().has_value());
}

TEST(Labels, OfWhatLiesOffByLessThanTheReachAreThoseOfTheNearestSurface) {
  const auto truth = room();
  auto voxels = voxelsOf(truth);
  voxels.voxels = {{{0.12, 2.0, kFloor + 1.5}, kChair}};
  const auto score = scoreLabels(voxels, truth);
  EXPECT_EQ(score.confusion.at({kWall, kChair}), 1U);
}

TEST(Labels, OfDoorsAndStairsAreKnownByTheNamesOfTheirClasses) {
  auto truth = room();
  truth.classes = {{1, "wall"}, {2, "floor"}, {6, "door"}, {7, "stairs"}};
  truth.doors[0].leaves = 1;
  truth.doors[0].hingeSide = map::HingeSide::kLeft;
  truth.stairs = {{.foot = {6.0, 2.0, kFloor},
                   .head = {6.9, 2.0, kFloor + 0.6},
                   .width = 1.0,
                   .stepDepth = 0.3,
                   .stepHeight = 0.2,
                   .stepCount = 3}};
  auto voxels = voxelsOf(truth);
  voxels.voxels = {{{4.1, 2.2, kFloor + 1.0}, 6}, {{6.4, 2.0, kFloor + 0.4}, 7}};
  EXPECT_EQ(scoreLabels(voxels, truth).accuracy(), 1.0);
  EXPECT_EQ(scoreLabels(voxels, truth).compared(), 2U);
}

TEST(Labels, OfAnotherClassTableAreRefused) {
  const auto truth = room();
  auto voxels = voxelsOf(truth);
  voxels.classes[kChair] = "sofa";
  try {
    scoreLabels(voxels, truth);
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("class 3"));
    EXPECT_THAT(error.what(), testing::HasSubstr("expected \"chair\""));
    EXPECT_THAT(error.what(), testing::HasSubstr("found \"sofa\""));
  }
  voxels.classes = truth.classes;
  voxels.classes.erase(kTable);
  EXPECT_THROW(scoreLabels(voxels, truth), base::Error);
  voxels.classes = truth.classes;
  voxels.classes.erase(kUnlabeled);
  EXPECT_NO_THROW(scoreLabels(voxels, truth));
}

TEST(Labels, AreComparedWithThePointsInTheirVoxels) {
  auto voxels = voxelsOf(room());
  voxels.voxels = {{{0.05, 0.05, 0.05}, kWall}, {{0.15, 0.05, 0.05}, kWall}, {{0.95, 0.05, 0.05}, kWall}};
  const std::vector<LabelledPoint> reference = {{{0.01, 0.02, 0.03}, kWall},
                                                {{0.02, 0.02, 0.03}, kWall},
                                                {{0.03, 0.02, 0.03}, kChair},
                                                {{0.11, 0.02, 0.03}, kChair},
                                                {{0.95, 0.05, 0.05}, kUnlabeled}};
  const auto score = scoreLabels(voxels, reference);
  EXPECT_EQ(score.confusion.at({kWall, kWall}), 1U);
  EXPECT_EQ(score.confusion.at({kChair, kWall}), 1U);
  EXPECT_EQ(score.stray, 1U);
}

TEST(Labels, OfAMapWithoutThemAreNone) {
  test::FlatMap map;
  EXPECT_FALSE(labelledVoxelsOf(map.view(), room()).has_value());
}

TEST(Labels, OfSeveralMapsAreAddedUpWhereTheirClassesAgree) {
  const auto truth = room();
  auto voxels = voxelsOf(truth);
  voxels.voxels = {{{0.0, 1.0, kFloor + 1.5}, kWall}};
  LabelScore sum;
  sum += scoreLabels(voxels, truth);
  sum += scoreLabels(voxels, truth);
  EXPECT_EQ(sum.confusion.at({kWall, kWall}), 2U);
  LabelScore other;
  other.classes = {{1, "floor"}};
  EXPECT_THROW(sum += other, base::Error);
}

}  // namespace
}  // namespace prodomos::evaluation

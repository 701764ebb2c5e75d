// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/objects.hpp"

#include "evaluation/flat.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace prodomos::evaluation {
namespace {

using test::FlatMap;
using test::flat::at;
using test::flat::kFloor;

constexpr int kChair = 3;
constexpr int kTable = 4;
constexpr int kPerson = 5;

geometry::Pose3 standing(double x, double y, double yaw, double height) {
  return geometry::toPose3({x, y, yaw}, kFloor + 0.5 * height);
}

TrueObject thing(const std::string& id, int classId, double x, double y, double yaw, const Eigen::Vector3d& size) {
  return {.id = id,
          .classId = classId,
          .storey = 1,
          .size = size,
          .poses = {{at(0), standing(x, y, yaw, size.z())}},
          .seen = 1.0};
}

/// A table, and a chair beside it.
Truth furnished() {
  auto truth = test::flat::truth();
  truth.objects = {thing("table", kTable, 2.0, 1.0, 0.3, {1.6, 0.8, 0.75}),
                   thing("chair", kChair, 2.0, 3.0, 1.0, {0.5, 0.5, 0.9})};
  return truth;
}

void addTruly(FlatMap& map, const Truth& truth) {
  for (const auto& object : truth.objects) {
    map.add(1, object.poses[0].T_world_object, map::Cuboid{.classId = object.classId, .size = object.size});
  }
}

ObjectScore scoreOf(FlatMap& map, const Truth& truth, const ObjectOptions& options = {}) {
  return scoreObjects(objectsOf(map.view(), truth), truth, options);
}

TEST(Objects, OfAPerfectMapScorePerfectly) {
  const auto truth = furnished();
  FlatMap map;
  addTruly(map, truth);
  const auto score = scoreOf(map, truth);
  EXPECT_EQ(score.recall(), 1.0);
  EXPECT_EQ(score.precision(), 1.0);
  EXPECT_EQ(score.goodRecall(), 1.0);
  EXPECT_EQ(score.goodPrecision(), 1.0);
  EXPECT_EQ(score.classAccuracy(), 1.0);
  ASSERT_EQ(score.overlaps.size(), 2U);
  for (const double overlap : score.overlaps) EXPECT_NEAR(overlap, 1.0, 1e-6);
  for (const double error : score.centreErrors) EXPECT_NEAR(error, 0.0, 1e-6);
  EXPECT_EQ(score.byClass.at("chair").truth, 1U);
  EXPECT_EQ(score.byClass.at("chair").mapped, 1U);
}

TEST(Objects, ScoreTheSameWhereverTheMapLiesAndHoweverItDrifts) {
  const auto truth = furnished();
  FlatMap still(geometry::Pose3::Identity());
  FlatMap moved;
  moved.driftBy(geometry::fromYawPitchRoll({0.6, 0.2, 0.0}, 0.1, 0.0, 0.0));
  for (auto* map : {&still, &moved}) {
    map->add(2, standing(2.1, 1.0, 0.3, 0.75), map::Cuboid{.classId = kTable, .size = {1.6, 0.8, 0.75}});
  }
  const auto one = scoreOf(still, truth);
  const auto other = scoreOf(moved, truth);
  ASSERT_EQ(one.overlaps.size(), 1U);
  ASSERT_EQ(other.overlaps.size(), 1U);
  EXPECT_NEAR(one.overlaps[0], other.overlaps[0], 1e-6);
  EXPECT_NEAR(one.centreErrors[0], 0.1, 1e-6);
  EXPECT_NEAR(other.centreErrors[0], 0.1, 1e-6);
}

TEST(Objects, ShiftedByHalfShareAThird) {
  auto truth = test::flat::truth();
  truth.objects = {thing("table", kTable, 2.0, 1.0, 0.0, {1.6, 0.8, 0.75})};
  FlatMap map;
  map.add(1, standing(2.8, 1.0, 0.0, 0.75), map::Cuboid{.classId = kTable, .size = {1.6, 0.8, 0.75}});
  const auto score = scoreOf(map, truth);
  EXPECT_EQ(score.recall(), 1.0);
  EXPECT_EQ(score.goodRecall(), 0.0);
  EXPECT_EQ(score.goodPrecision(), 0.0);
  ASSERT_EQ(score.overlaps.size(), 1U);
  EXPECT_NEAR(score.overlaps[0], 1.0 / 3.0, 1e-6);
  EXPECT_NEAR(score.centreErrors[0], 0.8, 1e-6);
}

TEST(Objects, OfAnEmptyMapAreMissedAndHaveNoPrecision) {
  const auto truth = furnished();
  FlatMap map;
  const auto score = scoreOf(map, truth);
  EXPECT_EQ(score.recall(), 0.0);
  EXPECT_FALSE(score.precision().has_value());
  EXPECT_FALSE(score.classAccuracy().has_value());
  EXPECT_TRUE(score.overlaps.empty());
}

TEST(Objects, WhereThereAreNoneHaveNoRecall) {
  FlatMap map;
  map.add(1, standing(2.0, 1.0, 0.0, 0.75), map::Cuboid{.classId = kTable, .size = {1.6, 0.8, 0.75}});
  const auto score = scoreOf(map, test::flat::truth());
  EXPECT_FALSE(score.recall().has_value());
  EXPECT_EQ(score.precision(), 0.0);
}

TEST(Objects, MappedTwiceCountTwiceAgainstPrecision) {
  const auto truth = furnished();
  FlatMap map;
  addTruly(map, truth);
  map.add(2, standing(2.05, 1.0, 0.3, 0.75), map::Cuboid{.classId = kTable, .size = {1.6, 0.8, 0.75}});
  const auto score = scoreOf(map, truth);
  EXPECT_EQ(score.recall(), 1.0);
  EXPECT_NEAR(score.precision().value(), 2.0 / 3.0, 1e-12);
  EXPECT_EQ(score.byClass.at("table").truth, 1U);
  EXPECT_EQ(score.byClass.at("table").mapped, 2U);
  for (const double overlap : score.overlaps) EXPECT_NEAR(overlap, 1.0, 1e-6);  // the better one of the two is the pair
}

TEST(Objects, BarelySeenCountNeitherWay) {
  auto truth = furnished();
  truth.objects[1].seen = 0.05;
  FlatMap map;
  addTruly(map, truth);
  const auto score = scoreOf(map, truth);
  EXPECT_EQ(score.all.truth, 1U);
  EXPECT_EQ(score.all.mapped, 1U);
  EXPECT_EQ(score.recall(), 1.0);
  EXPECT_EQ(score.precision(), 1.0);
  FlatMap empty;
  EXPECT_EQ(scoreOf(empty, truth).all.truth, 1U);
}

TEST(Objects, OfAWrongClassAreFoundButWronglyNamed) {
  const auto truth = furnished();
  FlatMap map;
  map.add(1, truth.objects[0].poses[0].T_world_object, map::Cuboid{.classId = kChair, .size = truth.objects[0].size});
  map.add(1, truth.objects[1].poses[0].T_world_object, map::Cuboid{.classId = 0, .size = truth.objects[1].size});
  const auto score = scoreOf(map, truth);
  EXPECT_EQ(score.recall(), 1.0);
  EXPECT_EQ(score.classesKnown, 1U);  // the other one's is not told
  EXPECT_EQ(score.classAccuracy(), 0.0);
}

TEST(Objects, ThatMoveAreJudgedWhereTheyWereWhenSeen) {
  auto truth = test::flat::truth();
  auto cart = thing("cart", kTable, 1.0, 1.0, 0.0, {0.8, 0.5, 1.0});
  cart.mobility = map::Mobility::kDynamic;
  cart.poses.push_back({at(5), standing(3.0, 1.0, 0.0, 1.0)});
  truth.objects = {cart};
  FlatMap map;
  map.add(1, standing(3.0, 1.0, 0.0, 1.0), map::ObjectBox{.classId = kTable, .size = {0.8, 0.5, 1.0}}, 6.0);
  EXPECT_EQ(scoreOf(map, truth).recall(), 1.0);
  FlatMap stale;
  stale.add(1, standing(3.0, 1.0, 0.0, 1.0), map::ObjectBox{.classId = kTable, .size = {0.8, 0.5, 1.0}}, 1.0);
  EXPECT_EQ(scoreOf(stale, truth).recall(), 0.0);
}

TEST(Objects, ThatArePersonsAreLeftToThoseWhoScorePersons) {
  const auto truth = furnished();
  FlatMap map;
  addTruly(map, truth);
  map.add(1, standing(1.0, 2.0, 0.0, 1.8), map::ObjectBox{.classId = kPerson, .size = {0.5, 0.5, 1.8}});
  EXPECT_EQ(scoreOf(map, truth).precision(), 1.0);
}

TEST(Objects, OfSeveralMapsAreAddedUp) {
  const auto truth = furnished();
  FlatMap full;
  addTruly(full, truth);
  FlatMap empty;
  auto score = scoreOf(full, truth);
  score += scoreOf(empty, truth);
  EXPECT_EQ(score.recall(), 0.5);
  EXPECT_EQ(score.precision(), 1.0);
  EXPECT_EQ(score.byClass.at("table").truth, 2U);
}

}  // namespace
}  // namespace prodomos::evaluation

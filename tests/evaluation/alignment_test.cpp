// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/alignment.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/base/random.hpp"

#include "evaluation/flat.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

namespace prodomos::evaluation {
namespace {

using test::FlatMap;
using test::flat::at;
using test::flat::elsewhere;

TEST(Alignment, OfAWayThatWasMovedAsAWholeIsThatMove) {
  const auto truth = test::flat::truth();
  std::vector<TimedPose> way;
  for (const auto& pose : truth.trajectory) way.push_back({pose.time, elsewhere() * pose.pose});
  EXPECT_TRUE(truthFromMap(way, truth).isApprox(elsewhere().inverse(), 1e-9));
}

TEST(Alignment, OfARobotThatOnlyTurnedIsThatMoveToo) {
  Truth truth;
  std::vector<TimedPose> way;
  for (int i = 0; i < 20; ++i) {
    const auto pose = geometry::fromYawPitchRoll({3.0, 4.0, 0.5}, 0.3 * i, 0.0, 0.0);
    truth.trajectory.push_back({at(0.1 * i), pose});
    way.push_back({at(0.1 * i), elsewhere() * pose});
  }
  EXPECT_TRUE(truthFromMap(way, truth).isApprox(elsewhere().inverse(), 1e-9));
}

TEST(Alignment, FindsTrueTimesBetweenTwoTrueOnes) {
  const auto truth = test::flat::truth();
  const std::vector<TimedPose> way = {{at(1.05), geometry::toPose3({0, 0, 0})}};
  EXPECT_NEAR(truthFromMap(way, truth).translation().x(), 0.5 + 0.525, 1e-9);
  EXPECT_FALSE(poseAt(truth.trajectory, at(-0.01)).has_value());
  EXPECT_FALSE(poseAt(truth.trajectory, at(14.01)).has_value());
  EXPECT_FALSE(poseAt({{at(0), {}}, {at(2), {}}}, at(1)).has_value());
  EXPECT_FALSE(poseAt({}, at(1)).has_value());
}

TEST(Alignment, TakesStampsThatWereRoundedForTheSame) {
  const std::vector<TimedPose> poses = {{at(0), geometry::toPose3({1, 0, 0})}, {at(9), geometry::toPose3({2, 0, 0})}};
  for (const double rounded : {-1e-6, 1e-6}) {
    ASSERT_TRUE(poseAt(poses, at(9 + rounded)).has_value());
    EXPECT_EQ(poseAt(poses, at(9 + rounded))->translation().x(), 2.0);
    EXPECT_EQ(poseAt(poses, at(rounded))->translation().x(), 1.0);
  }
}

TEST(Alignment, OfANoisyWayIsNearTheTrueOne) {
  base::Random random(1);
  const auto truth = test::flat::truth();
  std::vector<TimedPose> way;
  for (const auto& pose : truth.trajectory) {
    const Eigen::Translation3d noise(random.normal(0, 0.05), random.normal(0, 0.05), random.normal(0, 0.01));
    way.push_back({pose.time, elsewhere() * noise * pose.pose});
  }
  const geometry::Pose3 error = truthFromMap(way, truth) * elsewhere();
  EXPECT_LT((error * Eigen::Vector3d(4.0, 2.0, 1.5) - Eigen::Vector3d(4.0, 2.0, 1.5)).norm(), 0.03);
  EXPECT_LT(geometry::rotationAngle(error), 0.01);
}

TEST(Alignment, WithoutACommonTimeNamesBothTimes) {
  const auto truth = test::flat::truth();
  try {
    truthFromMap({{at(500), {}}}, truth);
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("expected times in common"));
    EXPECT_THAT(error.what(), testing::HasSubstr("100.0 to 114.0"));
    EXPECT_THAT(error.what(), testing::HasSubstr("600.0"));
  }
  EXPECT_THROW(truthFromMap({}, truth), base::Error);
  EXPECT_THROW(truthFromMap({{at(1), {}}}, Truth{}), base::Error);
}

TEST(Alignment, OfSubMapsDoesNotCareHowTheyDriftApart) {
  const auto truth = test::flat::truth();
  FlatMap map;
  map.driftBy(geometry::fromYawPitchRoll({0.7, -0.3, 0.2}, 0.05, 0.0, 0.0));
  const auto view = map.view();
  const auto T_world_submap = truthFromSubMaps(view, truth);
  ASSERT_EQ(T_world_submap.size(), 2U);
  for (const int id : {1, 2}) {
    EXPECT_TRUE(T_world_submap.at({id}).isApprox(map.T_submap_world(id).inverse(), 1e-6)) << id;
  }
  // Taken as a whole, the map does not fit.
  const auto T_world_map = truthFromMap(bodyPoses(view.trajectory(), Poses::kRefined), truth);
  const auto T_world_second = T_world_map * view.graph().getNode({2}).T_map_submap;
  EXPECT_GT((T_world_second.translation() - T_world_submap.at({2}).translation()).norm(), 0.1);
}

TEST(Placement, WithoutTruthIsTheMapItself) {
  auto store = map::MapStore::inMemory();
  map::MapChange change;
  change.sessions = {{.id = {1}}};
  change.floors = {{.number = 0, .height = 0.0}, {.number = -1, .height = -3.0}};
  map::Node node;
  node.id = {4};
  node.session = {1};
  node.T_map_submap = geometry::toPose3({1.0, 2.0, 0.5}, -3.0);
  change.nodes = {node};
  store.commit(change);
  const auto placement = placementOf(store.view());
  ASSERT_EQ(placement.T_world_submap.size(), 1U);
  EXPECT_TRUE(placement.T_world_submap.at({4}).isApprox(node.T_map_submap, 1e-9));
  EXPECT_EQ(placement.storeyAt(-2.0), 0);
  EXPECT_EQ(placement.modelledStoreyAt(0.9), 1);
  EXPECT_FALSE(placement.modelledStoreyAt(-1.5));
  EXPECT_FALSE(placement.modelledStoreyAt(6.0));
}

TEST(Alignment, TellsTheNearestStorey) {
  const auto truth = test::flat::truth();
  EXPECT_EQ(storeyAt(truth, 1.4), 1);
  EXPECT_EQ(storeyAt(truth, -1.2), 0);
  EXPECT_EQ(storeyAt(Truth{}, 3.0), 0);
}

}  // namespace
}  // namespace prodomos::evaluation

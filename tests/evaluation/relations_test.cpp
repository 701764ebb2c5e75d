// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/relations.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/map/map_store.hpp"

#include "evaluation/ways.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>

#include <numbers>

namespace prodomos::evaluation {

using test::at;
using testing::HasSubstr;

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// True relations of a way, each to the pose `apart` further on.
std::vector<Relation> relationsOf(const std::vector<TimedPose>& way, std::size_t apart) {
  std::vector<Relation> relations;
  for (std::size_t i = 0; i + apart < way.size(); ++i) {
    relations.push_back({way[i].time, way[i + apart].time, way[i].pose.inverse() * way[i + apart].pose});
  }
  return relations;
}

std::string faultOf(const std::filesystem::path& path) {
  try {
    readRelations(path);
  } catch (const base::FileError& fault) {
    return fault.what();
  }
  return "none";
}

}  // namespace

TEST(Relations, OfTheTruthHaveNoError) {
  const auto way = test::windingWay(50);
  const auto errors = relationErrors(way, relationsOf(way, 7));
  ASSERT_EQ(errors.size(), 43U);
  for (const auto& error : errors) {
    EXPECT_NEAR(error.translation, 0.0, 1e-12);
    EXPECT_NEAR(error.rotation, 0.0, 1e-7);
  }
}

TEST(Relations, ErrorsAreThoseByHand) {
  // Ahead by 2 m instead of 1.7 m and 0.4 m to the left; then a turn of 90° that was believed to be 80°.
  const std::vector<TimedPose> believed = {{at(0), geometry::toPose3({5.0, 5.0, 90 * kDegree})},
                                           {at(1), geometry::toPose3({5.0, 7.0, 90 * kDegree})},
                                           {at(2), geometry::toPose3({5.0, 7.0, 170 * kDegree})}};
  const std::vector<Relation> truth = {{at(0), at(1), geometry::toPose3({1.7, 0.4, 0.0})},
                                       {at(1), at(2), geometry::toPose3({0.0, 0.0, 90 * kDegree})}};
  const auto score = scoreOf(relationErrors(believed, truth));
  EXPECT_NEAR(score.translation.mean, 0.25, 1e-12);
  EXPECT_NEAR(score.translation.std, 0.25, 1e-12);
  EXPECT_NEAR(score.translation.squaredMean, 0.125, 1e-12);
  EXPECT_NEAR(score.rotation.mean, 5.0, 1e-9);
  EXPECT_NEAR(score.rotation.squaredMean, 50.0, 1e-9);
  EXPECT_NEAR(score.rotation.max, 10.0, 1e-9);
}

TEST(Relations, TurnsAreComparedTheShortWayRound) {
  const std::vector<TimedPose> believed = {{at(0), geometry::toPose3({0, 0, 0})},
                                           {at(1), geometry::toPose3({0, 0, 179 * kDegree})}};
  const auto errors = relationErrors(believed, {{at(0), at(1), geometry::toPose3({0, 0, -179 * kDegree})}});
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_NEAR(errors[0].rotation, 2 * kDegree, 1e-9);
}

TEST(Relations, AMapThatIsMovedAsAWholeHasTheSameErrors) {
  base::Random random(3);
  const auto truth = test::windingWay(60);
  auto believed = truth;
  for (auto& pose : believed) pose.pose = pose.pose * test::smallMove(random, 0.1, 0.05);
  const auto relations = relationsOf(truth, 4);
  const auto here = scoreOf(relationErrors(believed, relations));
  const auto there = scoreOf(relationErrors(test::moved(believed, test::somewhereElse()), relations));
  EXPECT_GT(here.translation.mean, 0.01);
  EXPECT_NEAR(here.translation.mean, there.translation.mean, 1e-12);
  EXPECT_NEAR(here.translation.squaredStd, there.translation.squaredStd, 1e-12);
  EXPECT_NEAR(here.rotation.mean, there.rotation.mean, 1e-9);
}

TEST(Relations, BetweenOtherTimesAreNotMatched) {
  const auto way = test::windingWay(3);
  const auto microsecond = std::chrono::microseconds(1);
  const std::vector<Relation> relations = {
      {way[0].time + microsecond, way[1].time - microsecond, way[0].pose.inverse() * way[1].pose},
      {way[0].time, way[1].time + 5 * microsecond, way[0].pose.inverse() * way[1].pose},
      {way[2].time + std::chrono::seconds(1), way[0].time, geometry::Pose3::Identity()}};
  const auto errors = relationErrors(way, relations);
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors[0].first, relations[0].first);
  EXPECT_NEAR(errors[0].translation, 0.0, 1e-12);
  EXPECT_TRUE(relationErrors({}, relations).empty());
}

TEST(Relations, TheWorstComeFirst) {
  std::vector<RelationError> errors;
  for (int i = 0; i < 20; ++i) errors.push_back({at(i), at(i + 1), (7 * i) % 20 * 0.1, (3 * i) % 20 * 0.01});
  const auto score = scoreOf(errors, 3);
  ASSERT_EQ(score.worstShifted.size(), 3U);
  EXPECT_DOUBLE_EQ(score.worstShifted[0].translation, 1.9);
  EXPECT_DOUBLE_EQ(score.worstShifted[2].translation, 1.7);
  ASSERT_EQ(score.worstTurned.size(), 3U);
  EXPECT_DOUBLE_EQ(score.worstTurned[0].rotation, 0.19);
}

TEST(Relations, RefinedAndTravelledPosesOfAMapAreTwoAnswers) {
  const auto way = test::windingWay(10);
  auto store = map::MapStore::inMemory();
  map::MapChange change;
  change.sessions.push_back({.id = {0}});
  change.nodes.push_back({.id = {0}, .session = {0}, .floor = {}, .place = {}});
  change.nodes.push_back({.id = {1}, .session = {0}, .floor = {}, .place = {}});
  change.nodes[1].T_map_submap = geometry::toPose3({0.5, 0.0, 0.0});  // refinement moves the second half by 0.5 m
  for (std::size_t i = 0; i < way.size(); ++i) {
    change.trajectory.push_back(
        {.session = {0}, .time = way[i].time, .submap = {i < 5 ? 0 : 1}, .T_travel_body = way[i].pose});
  }
  store.commit(change);
  const auto trajectory = store.view().trajectory();
  const auto relations = relationsOf(way, 1);
  EXPECT_NEAR(scoreOf(relationErrors(bodyPoses(trajectory, Poses::kTravelled), relations)).translation.max, 0.0, 1e-9);
  const auto refined = relationErrors(bodyPoses(trajectory, Poses::kRefined), relations);
  ASSERT_EQ(refined.size(), 9U);
  for (std::size_t i = 0; i < refined.size(); ++i) EXPECT_NEAR(refined[i].translation, i == 4 ? 0.5 : 0.0, 1e-9);
}

TEST(RelationsFile, IsReadWithItsCommentsAndExactStamps) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("a.relations",
                                 "# t1 t2 x y z roll pitch yaw\n\n"
                                 "976052905.167303 976052911.885496 1 -2 +0.5 0 0 1.5707963267948966\r\n"
                                 "  1.0\t2.0  0 0 0 0.1 0.2 0.3\n");
  const auto relations = readRelations(path);
  ASSERT_EQ(relations.size(), 2U);
  EXPECT_EQ(base::toNanoseconds(relations[0].first), 976052905167303000);
  EXPECT_EQ(base::toNanoseconds(relations[0].second), 976052911885496000);
  const Eigen::Vector3d ahead_in_first = relations[0].T_first_second * Eigen::Vector3d(1.0, 0.0, 0.0);
  EXPECT_TRUE(ahead_in_first.isApprox(Eigen::Vector3d(1.0, -1.0, 0.5)));
  EXPECT_TRUE(relations[1].T_first_second.isApprox(geometry::fromYawPitchRoll({0, 0, 0}, 0.3, 0.2, 0.1)));
}

TEST(RelationsFile, AMalformedLineIsNamed) {
  const test::TemporaryFolder folder;
  const std::string good = "1.0 2.0 0 0 0 0 0 0\n";
  for (const std::string bad :
       {"1.0 2.0 0 0 0 0 0", "1.0 2.0 0 0 0 0 0 0 0", "1.0 x 0 0 0 0 0 0", "1.0 2.0 0,5 0 0 0 0 0",
        "1.0 2.0 nan 0 0 0 0 0", "1.0 2.0 0 0 0 0 0 inf", "1.0 2.0 0 0 0 0 0 1e999", "one two"}) {
    const auto path = folder.write("bad.relations", good + bad + "\n" + good);
    EXPECT_THAT(faultOf(path), HasSubstr("bad.relations:2: expected")) << bad;
    EXPECT_THAT(faultOf(path), HasSubstr(bad));
  }
}

TEST(RelationsFile, ThatIsMissingOrEmptyIsAnError) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(faultOf(folder.path() / "none.relations"), HasSubstr("none.relations: expected"));
  EXPECT_THAT(faultOf(folder.path()), HasSubstr("expected"));
  EXPECT_THAT(faultOf(folder.write("empty.relations", "# nothing\n\n")), HasSubstr("found none"));
}

}  // namespace prodomos::evaluation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/humans.hpp"

#include "evaluation/flat.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>

namespace prodomos::evaluation {
namespace {

using test::FlatMap;
using test::flat::at;
using test::flat::kFloor;

constexpr int kFrames = 20;  // ten a second

using Way = std::function<Eigen::Vector2d(double seconds)>;

TruePerson person(const std::string& id, const Way& way, double heading = 0.0) {
  TruePerson person{.id = id};
  for (int i = 0; i < kFrames; ++i) {
    const Eigen::Vector2d spot = way(0.1 * i);
    TruePersonState state{
        .time = at(0.1 * i), .position = {spot.x(), spot.y(), kFloor}, .heading = heading, .pixels = 5000};
    for (int j = 0; j < kJointCount; ++j) {
      state.joints[static_cast<std::size_t>(j)] = state.position + Eigen::Vector3d(0.0, 0.05 * j, 0.1 * j);
    }
    person.states.push_back(state);
  }
  return person;
}

/// Two who meet, pass one another 0.4 m apart, and part.
Truth walkers() {
  auto truth = test::flat::truth();
  truth.people = {person("ada", [](double s) { return Eigen::Vector2d(1.0 + s, 2.2); }),
                  person(
                      "ben", [](double s) { return Eigen::Vector2d(3.0 - s, 1.8); }, std::numbers::pi)};
  return truth;
}

std::string jointsIn(const geometry::Pose3& T_submap_world, const TruePersonState& state) {
  std::string list;
  for (const auto& joint : state.joints) {
    const Eigen::Vector3d p = T_submap_world * joint;
    list += (list.empty() ? "[" : ",[") + std::to_string(p.x()) + "," + std::to_string(p.y()) + "," +
            std::to_string(p.z()) + "]";
  }
  return "{\"joints\":[" + list + "]}";
}

/// What a perfect detector would write of that person.
map::Track trackOf(int id, const FlatMap& map, const TruePerson& person, int first = 0, int last = kFrames - 1) {
  map::Track track{.id = {id}, .session = {1}, .className = "human"};
  for (int i = first; i <= last; ++i) {
    const auto& state = person.states[static_cast<std::size_t>(i)];
    const auto T_world_person = geometry::fromYawPitchRoll(state.position, state.heading, 0.0, 0.0);
    track.states.push_back({state.time,
                            {1},
                            map.T_submap_world(1) * T_world_person,
                            std::nullopt,
                            jointsIn(map.T_submap_world(1), state)});
  }
  return track;
}

HumanScore scoreOf(FlatMap& map, const Truth& truth, const HumanOptions& options = {}) {
  return scoreHumans(peopleOf(map.view(), truth), truth, options);
}

TEST(Humans, FollowedPerfectlyScorePerfectly) {
  const auto truth = walkers();
  FlatMap map;
  map.add(trackOf(1, map, truth.people[0]));
  map.add(trackOf(2, map, truth.people[1]));
  const auto score = scoreOf(map, truth);
  EXPECT_EQ(score.frames, 20U);
  EXPECT_EQ(score.seen, 40U);
  EXPECT_EQ(score.matches, 40U);
  EXPECT_EQ(score.falseNegatives(), 0U);
  EXPECT_EQ(score.falsePositives, 0U);
  EXPECT_EQ(score.identitySwitches, 0U);
  EXPECT_EQ(score.mota(), 1.0);
  EXPECT_NEAR(score.motp().value(), 0.0, 1e-6);
  ASSERT_EQ(score.headingErrors.size(), 40U);
  for (const double error : score.headingErrors) EXPECT_NEAR(error, 0.0, 1e-6);
  ASSERT_EQ(score.jointErrors.size(), 40U * kJointCount);
  for (const double error : score.jointErrors) EXPECT_NEAR(error, 0.0, 1e-5);
}

TEST(Humans, NotFollowedAtAllAreMissed) {
  const auto truth = walkers();
  FlatMap map;
  const auto score = scoreOf(map, truth);
  EXPECT_EQ(score.falseNegatives(), 40U);
  EXPECT_EQ(score.recall(), 0.0);
  EXPECT_FALSE(score.precision().has_value());
  EXPECT_EQ(score.mota(), 0.0);
  EXPECT_FALSE(score.motp().has_value());
  EXPECT_TRUE(score.headingErrors.empty());
}

TEST(Humans, WhereThereAreNoneHaveNoMeasuresButFalseOnes) {
  FlatMap map;
  map.add(trackOf(1, map, walkers().people[0]));
  const auto score = scoreOf(map, test::flat::truth());
  EXPECT_EQ(score.seen, 0U);
  EXPECT_EQ(score.falsePositives, 20U);
  EXPECT_FALSE(score.recall().has_value());
  EXPECT_FALSE(score.mota().has_value());
  EXPECT_EQ(score.precision(), 0.0);
}

TEST(Humans, WhoseIdentitiesAreSwappedWhenTheyMeetCountAsTwoSwitches) {
  const auto truth = walkers();
  FlatMap map;
  auto first = trackOf(1, map, truth.people[0], 0, 9);
  auto second = trackOf(2, map, truth.people[1], 0, 9);
  const auto endOfFirst = trackOf(1, map, truth.people[1], 10);
  const auto endOfSecond = trackOf(2, map, truth.people[0], 10);
  first.states.insert(first.states.end(), endOfFirst.states.begin(), endOfFirst.states.end());
  second.states.insert(second.states.end(), endOfSecond.states.begin(), endOfSecond.states.end());
  map.add(first);
  map.add(second);
  // Within a reach of 0.3 m those who pass each other 0.4 m apart cannot be taken for one another.
  const auto score = scoreOf(map, truth, {.reach = 0.3});
  EXPECT_EQ(score.identitySwitches, 2U);
  EXPECT_EQ(score.matches, 40U);
  EXPECT_NEAR(score.mota().value(), 1.0 - 2.0 / 40.0, 1e-12);
}

TEST(Humans, WhoAreLostAndFoundAnewAsAnotherCountAsASwitch) {
  const auto truth = walkers();
  FlatMap map;
  map.add(trackOf(1, map, truth.people[0], 0, 7));
  map.add(trackOf(3, map, truth.people[0], 12));
  map.add(trackOf(2, map, truth.people[1]));
  const auto score = scoreOf(map, truth);
  EXPECT_EQ(score.identitySwitches, 1U);
  EXPECT_EQ(score.falseNegatives(), 4U);
  EXPECT_NEAR(score.mota().value(), 1.0 - 5.0 / 40.0, 1e-12);
}

TEST(Humans, KeepTheirPartnerWhileHeIsWithinReachThoughAnotherIsNearer) {
  auto truth = test::flat::truth();
  truth.people = {person("ada", [](double) { return Eigen::Vector2d(2.0, 2.0); })};
  FlatMap map;
  auto drifting = trackOf(1, map, truth.people[0]);
  for (std::size_t i = 0; i < drifting.states.size(); ++i) {
    drifting.states[i].T_submap_thing.pretranslate(Eigen::Vector3d(0.02 * static_cast<double>(i), 0.0, 0.0));
  }
  map.add(drifting);
  map.add(trackOf(2, map, truth.people[0], 10));
  const auto score = scoreOf(map, truth);
  EXPECT_EQ(score.identitySwitches, 0U);
  EXPECT_EQ(score.matches, 20U);
  EXPECT_EQ(score.falsePositives, 10U);
  EXPECT_NEAR(score.positionErrors.back(), 0.38, 1e-6);
}

TEST(Humans, ErrorsAreThoseThatWerePutIn) {
  const auto truth = walkers();
  FlatMap map;
  auto track = trackOf(1, map, truth.people[1]);
  for (auto& state : track.states) {
    state.T_submap_thing = Eigen::Translation3d(0.03, 0.04, 0.0) * state.T_submap_thing *
                           Eigen::AngleAxisd(-0.2, Eigen::Vector3d::UnitZ());
    state.attributes = R"({"joints":[[0,0,0],null,null,null,null,null,null,null,null,null,null,null,null,null]})";
  }
  map.add(track);
  const auto score = scoreOf(map, truth);
  EXPECT_EQ(score.falseNegatives(), 20U);
  ASSERT_EQ(score.positionErrors.size(), 20U);
  for (const double error : score.positionErrors) EXPECT_NEAR(error, 0.05, 1e-6);
  for (const double error : score.headingErrors) EXPECT_NEAR(error, 0.2, 1e-6);
  ASSERT_EQ(score.jointErrors.size(), 20U);  // of the one joint that is told
  const Eigen::Vector3d origin = map.T_submap_world(1).inverse().translation();
  EXPECT_NEAR(score.jointErrors[0], (origin - truth.people[1].states[0].joints[0]).norm(), 1e-6);
}

TEST(Humans, FarAwayOrBarelySeenCountNeitherWay) {
  auto truth = walkers();
  for (auto& state : truth.people[1].states) state.pixels = 200;
  FlatMap map;
  map.add(trackOf(1, map, truth.people[0]));
  map.add(trackOf(2, map, truth.people[1]));
  auto score = scoreOf(map, truth);
  EXPECT_EQ(score.seen, 20U);
  EXPECT_EQ(score.falsePositives, 0U);
  EXPECT_EQ(score.mota(), 1.0);

  auto far = test::flat::truth();
  far.people = {person("far", [](double) { return Eigen::Vector2d(7.5, 2.0); })};
  FlatMap other;
  other.add(trackOf(1, other, far.people[0]));
  score = scoreOf(other, far);
  EXPECT_EQ(score.seen, 0U);
  EXPECT_EQ(score.falsePositives, 0U);
}

TEST(Humans, OfTracksAreThereBetweenTheirStates) {
  const auto truth = walkers();
  FlatMap map;
  auto track = trackOf(1, map, truth.people[0]);
  std::erase_if(track.states, [](const auto& state) { return (state.time - at(0)).count() % 200'000'000 != 0; });
  ASSERT_EQ(track.states.size(), 10U);
  map.add(track);
  const auto score = scoreOf(map, truth);
  EXPECT_EQ(score.matches, 19U);  // none is known after the last
  for (const double error : score.positionErrors) EXPECT_NEAR(error, 0.0, 1e-6);
}

TEST(Humans, AreThoseOfEntitiesWhereThereAreNoTracks) {
  const auto truth = walkers();
  FlatMap map;
  const auto& state = truth.people[0].states[5];
  map.add(1, geometry::fromYawPitchRoll(state.position, state.heading, 0.0, 0.0), map::Human{}, 0.5);
  const auto score = scoreOf(map, truth);
  EXPECT_EQ(score.matches, 1U);
  EXPECT_EQ(score.falsePositives, 0U);
  EXPECT_TRUE(score.jointErrors.empty());
}

TEST(Humans, ScoreTheSameWhereverTheMapLies) {
  const auto truth = walkers();
  FlatMap still(geometry::Pose3::Identity());
  FlatMap moved;
  for (auto* map : {&still, &moved}) {
    auto track = trackOf(1, *map, truth.people[0]);
    for (auto& state : track.states) state.T_submap_thing.pretranslate(Eigen::Vector3d(0.1, 0.0, 0.0));
    map->add(track);
  }
  const auto one = scoreOf(still, truth);
  const auto other = scoreOf(moved, truth);
  EXPECT_EQ(one.matches, other.matches);
  EXPECT_NEAR(one.motp().value(), other.motp().value(), 1e-6);
  EXPECT_NEAR(one.headingErrors[3], other.headingErrors[3], 1e-6);
}

TEST(Humans, OfSeveralMapsAreAddedUp) {
  const auto truth = walkers();
  FlatMap followed;
  followed.add(trackOf(1, followed, truth.people[0]));
  followed.add(trackOf(2, followed, truth.people[1]));
  FlatMap empty;
  auto score = scoreOf(followed, truth);
  score += scoreOf(empty, truth);
  EXPECT_EQ(score.seen, 80U);
  EXPECT_EQ(score.recall(), 0.5);
  EXPECT_EQ(score.mota(), 0.5);
}

}  // namespace
}  // namespace prodomos::evaluation

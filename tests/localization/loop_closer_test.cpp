// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/loop_closer.hpp"

#include "localization/two_door_room.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

namespace prodomos::localization {
namespace {

using geometry::Pose2;
using test::kDegree;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

/// Sub-maps with a closer that knows them, and a record of which it had a closer look at.
class LoopCloserTest : public testing::Test {
 protected:
  LoopCloserConfig config;

  /// A sub-map that lies at this place, as far as is known; a way of its own of 100 m between any two.
  LoopPlace& add(int id, const MatchedLayers& layers, const Pose2& T_map_submap) {
    layers_[id] = layers;
    places_.push_back({.id = {id}, .session = {1}, .way = 100.0 * id, .T_map_submap = T_map_submap});
    return places_.back();
  }

  /// A room with furniture of its own, entered by either door.
  static MatchedLayers room(std::uint64_t furniture, bool isByTheEast = false) {
    base::Random random(1000 * furniture + (isByTheEast ? 1 : 0));
    const auto building = test::twoDoorRoom(furniture);
    return isByTheEast ? test::layersOf(building, test::wayEast(), test::kEastDoor, &random)
                       : test::layersOf(building, test::waySouth(), test::kSouthDoor, &random);
  }

  /// The same by the southern door, on another day and in another frame.
  static MatchedLayers roomAgain(std::uint64_t furniture, const Pose2& T_building_submap) {
    base::Random random(1000 * furniture + 2);
    return test::layersOf(test::twoDoorRoom(furniture), test::waySouth(), T_building_submap, &random);
  }

  /// Between the one added last and all others, where each pose is known so well relative to each other.
  std::vector<Loop> find(double sigma, const std::vector<base::SubMapId>& linked = {}) {
    asked_.clear();
    LoopCloser closer(config, [this](base::SubMapId id) {
      asked_.insert(id.value);
      return layers_.at(static_cast<int>(id.value));
    });
    for (const auto& [id, layers] : layers_) closer.add({id}, layers);
    const auto newest = places_.back();
    const auto loops = closer.find(newest, places_, linked, [&](base::SubMapId, base::SubMapId to) {
      EXPECT_EQ(to, newest.id);
      return Eigen::Matrix3d(Eigen::Vector3d(sigma * sigma, sigma * sigma, 0.01).asDiagonal());
    });
    asked_.erase(newest.id.value);
    return loops;
  }

  std::set<std::int64_t> asked_;

 private:
  std::map<int, MatchedLayers> layers_;
  std::vector<LoopPlace> places_;
};

TEST_F(LoopCloserTest, JoinsTwoVisitsOfARoom) {
  const auto truth = geometry::inverse(test::kSouthDoor) * test::kEastDoor;
  add(3, room(1), {5.0, 5.0, 0.7});
  add(8, room(1, true), Pose2{5.0, 5.0, 0.7} * truth * Pose2{0.6, -0.7, 0.1});
  const auto loops = find(0.5);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(loops[0].from, base::SubMapId{3});
  EXPECT_EQ(loops[0].to, base::SubMapId{8});
  const auto error = test::errorOf(loops[0].match.T_from_to, truth);
  EXPECT_LT(error.metres, 0.03);
  EXPECT_LT(error.radians, 0.5 * kDegree);
}

TEST_F(LoopCloserTest, TriesThoseThatMayBeNearAsFarAsPosesAreKnown) {
  config.alike = 0;
  config.near = 10;
  for (int i = 0; i < 6; ++i) add(i, room(static_cast<std::uint64_t>(i) + 1), {5.0 * i, 0.0, 0.0});
  add(6, room(9), {0.0, 0.0, 0.0});
  find(0.01);
  const auto certain = asked_;
  find(2.0);
  const auto doubtful = asked_;
  EXPECT_TRUE(certain.contains(0));
  EXPECT_FALSE(certain.contains(3)) << "fifteen metres away";
  EXPECT_GT(doubtful.size(), certain.size());
  EXPECT_FALSE(doubtful.contains(5)) << "farther than all that is not known";
}

TEST_F(LoopCloserTest, TriesTheNearestOnesOnlySoMany) {
  config.alike = 0;
  config.near = 2;
  for (int i = 0; i < 6; ++i) add(i, room(static_cast<std::uint64_t>(i) + 1), {0.5 * (6 - i), 0.0, 0.0});
  add(6, room(9), {0.0, 0.0, 0.0});
  find(1.0);
  EXPECT_THAT(asked_, UnorderedElementsAre(4, 5));
}

TEST_F(LoopCloserTest, FindsWhatLooksAlikeWhereverItIsBelievedToBe) {
  config.near = 0;
  config.alike = 2;
  for (int i = 0; i < 8; ++i) add(i, room(static_cast<std::uint64_t>(i) + 1), {30.0 * i, 0.0, 0.5});
  const Pose2 T_building_submap{1.0, 1.0, 2.5};
  add(8, roomAgain(5, T_building_submap), {-100.0, 20.0, 2.0});
  const auto loops = find(30.0);
  EXPECT_EQ(asked_.size(), 2U);
  const auto found = std::ranges::find(loops, base::SubMapId{4}, &Loop::from);
  ASSERT_NE(found, loops.end());
  const auto truth = geometry::inverse(test::kSouthDoor) * T_building_submap;
  EXPECT_LT(test::errorOf(found->match.T_from_to, truth).metres, 0.03);
}

TEST_F(LoopCloserTest, FindsByItsLooksWhatIsNearButFartherOffThanIsSearched) {
  // So near that it is a candidate for that, yet it lies fifteen metres from where it is believed to be.
  const Pose2 T_building_submap{-2.0, -2.0, -0.5};
  const auto truth = geometry::inverse(test::kSouthDoor) * T_building_submap;
  add(0, room(2), {});
  add(1, roomAgain(2, T_building_submap), Pose2{11.0, 11.0, 0.0} * truth);
  const auto loops = find(5.0);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_LT(test::errorOf(loops[0].match.T_from_to, truth).metres, 0.03);
}

TEST_F(LoopCloserTest, NeverTriesOtherFloors) {
  add(0, room(1), {}).floor = 1;
  add(1, room(1), {});
  add(2, room(1), {}).floor = 0;
  add(3, room(1), {}).floor = 0;
  EXPECT_EQ(find(1.0).size(), 1U);
  EXPECT_THAT(asked_, ElementsAre(2));
}

TEST_F(LoopCloserTest, NeverTriesNeighboursAlongTheWay) {
  add(0, room(1), {}).way = 10.0;
  add(1, room(1), {}).way = 14.0;
  add(2, room(1), {}).way = 20.0;
  find(1.0);
  EXPECT_THAT(asked_, ElementsAre(0)) << "ten metres before; six are too few";
}

TEST_F(LoopCloserTest, KnowsNoNeighboursInOtherSessions) {
  add(0, room(1), {}).way = 20.0;
  auto& other = add(1, room(1), {});
  other.way = 20.0;
  other.session = {2};
  find(1.0);
  EXPECT_THAT(asked_, ElementsAre(0));
}

TEST_F(LoopCloserTest, NeverTriesWhatIsLinkedAlready) {
  for (int i = 0; i < 4; ++i) add(i, room(1), {});
  const auto loops = find(1.0, {{0}, {2}});
  EXPECT_THAT(asked_, ElementsAre(1));
  EXPECT_EQ(loops.size(), 1U);
}

TEST_F(LoopCloserTest, TriesOtherComponentsByTheirLooksAlone) {
  const auto setUp = [&](int alike) {
    config.alike = alike;
    find(0.1);
  };
  for (int i = 0; i < 3; ++i) add(i, room(static_cast<std::uint64_t>(i) + 1), {}).component = 1;
  add(3, room(7), {});
  add(4, room(2, true), {});
  setUp(0);
  EXPECT_THAT(asked_, ElementsAre(3)) << "poses of other components say nothing";
  setUp(3);
  EXPECT_THAT(asked_, ElementsAre(0, 1, 2, 3)) << "whatever of its own component looks alike";
}

TEST_F(LoopCloserTest, HasNoCandidatesForWhatHasSeenNothing) {
  const MatchedLayers empty{std::make_shared<map::SurfaceLayer>(), std::make_shared<map::OccupancyGrid>()};
  config.near = 0;
  add(0, empty, {});
  add(1, room(1), {});
  EXPECT_THAT(find(1.0), IsEmpty());
  EXPECT_THAT(asked_, IsEmpty());
  add(2, empty, {});
  EXPECT_THAT(find(1.0), IsEmpty());
}

TEST(LoopCloser, KnowsWhatWasAdded) {
  LoopCloser closer({}, [](base::SubMapId) { return MatchedLayers{}; });
  const MatchedLayers layers{std::make_shared<map::SurfaceLayer>(), std::make_shared<map::OccupancyGrid>()};
  for (const int id : {7, 2, 5}) closer.add({id}, layers);
  for (const int id : {2, 5, 7}) EXPECT_TRUE(closer.knows({id}));
  for (const int id : {0, 3, 9}) EXPECT_FALSE(closer.knows({id}));
  const LoopPlace stranger{.id = {3}, .session = {1}, .T_map_submap = {}};
  EXPECT_THROW(closer.find(stranger, {}, {}, [](auto, auto) { return Eigen::Matrix3d(Eigen::Matrix3d::Zero()); }),
               base::Error);
}

}  // namespace
}  // namespace prodomos::localization

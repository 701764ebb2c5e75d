// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/submap_matcher.hpp"

#include "localization/two_door_room.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prodomos::localization {
namespace {

using geometry::Pose2;
using test::FlatBuilding;
using test::kDegree;

/// All around, a few metres: what is searched for looks alike.
SearchWindow wideAround(const Pose2& centre) {
  return {centre, 3.0, std::numbers::pi};
}

TEST(MatchSubMaps, FindsARoomThatWasEnteredByAnotherDoor) {
  int found = 0;
  for (std::uint64_t furniture = 1; furniture <= 8; ++furniture) {
    base::Random random(100 + furniture);
    const auto room = test::twoDoorRoom(furniture);
    const auto from = test::layersOf(room, test::waySouth(), test::kSouthDoor, &random);
    const auto to = test::layersOf(room, test::wayEast(), test::kEastDoor, &random);
    const auto truth = geometry::inverse(test::kSouthDoor) * test::kEastDoor;
    const auto match = matchSubMaps(from, to, wideAround(truth * Pose2{1.0, -0.8, 2.0}));
    if (!match) continue;
    ++found;
    const auto error = test::errorOf(match->T_from_to, truth);
    EXPECT_LT(error.metres, 0.03) << "furniture " << furniture;
    EXPECT_LT(error.radians, 0.4 * kDegree) << "furniture " << furniture;
    EXPECT_GT(match->overlap, 0.25);
    EXPECT_LE(match->overlap, 1.0);
    EXPECT_LT(match->conflict, 0.15);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(match->information);
    EXPECT_GT(axes.eigenvalues().minCoeff(), 1.0 / (0.1 * 0.1)) << "a room holds all three";
  }
  EXPECT_GE(found, 7);
}

TEST(MatchSubMaps, IsTheSameSeenFromTheOtherSide) {
  base::Random random(1);
  const auto room = test::twoDoorRoom(3);
  const auto from = test::layersOf(room, test::waySouth(), test::kSouthDoor, &random);
  const auto to = test::layersOf(room, test::wayEast(), test::kEastDoor, &random);
  const auto truth = geometry::inverse(test::kSouthDoor) * test::kEastDoor;
  const auto there = matchSubMaps(from, to, wideAround(truth));
  const auto back = matchSubMaps(to, from, wideAround(geometry::inverse(truth)));
  ASSERT_TRUE(there && back);
  const auto error = test::errorOf(there->T_from_to, geometry::inverse(back->T_from_to));
  EXPECT_LT(error.metres, 0.03);
  EXPECT_LT(error.radians, 0.4 * kDegree);
}

TEST(MatchSubMaps, RefusesAnotherRoomOfTheSameSize) {
  for (std::uint64_t furniture = 1; furniture <= 8; ++furniture) {
    base::Random random(200 + furniture);
    const auto from = test::layersOf(test::twoDoorRoom(furniture), test::waySouth(), test::kSouthDoor, &random);
    const auto to = test::layersOf(test::twoDoorRoom(furniture + 50), test::wayEast(), test::kEastDoor, &random);
    const auto truth = geometry::inverse(test::kSouthDoor) * test::kEastDoor;
    EXPECT_FALSE(matchSubMaps(from, to, wideAround(truth))) << "furniture " << furniture;
  }
}

TEST(MatchSubMaps, RefusesACorridorWhereThePlaceAlongItCannotBeTold) {
  FlatBuilding corridor;
  corridor.addWall({-100.0, -1.1}, {100.0, -1.1});
  corridor.addWall({-100.0, 1.1}, {100.0, 1.1});
  base::Random random(3);
  const Pose2 T_building_from{0.0, 0.0, 0.0};
  const Pose2 T_building_to{3.0, 0.2, 0.1};
  const auto from = test::layersOf(corridor, test::placesAlong({0.0, 0.0}, {6.0, 0.0}), T_building_from, &random);
  const auto to = test::layersOf(corridor, test::placesAlong({3.0, 0.2}, {9.0, 0.0}), T_building_to, &random);
  const auto truth = geometry::inverse(T_building_from) * T_building_to;
  for (const double reach : {1.5, 3.0, 4.0}) EXPECT_FALSE(matchSubMaps(from, to, {truth, reach, 0.5})) << reach;
}

TEST(MatchSubMaps, TellsOfACorridorThatItIsHeldAcrossAlone) {
  FlatBuilding corridor;
  corridor.addWall({-100.0, -1.1}, {100.0, -1.1});
  corridor.addWall({-100.0, 1.1}, {100.0, 1.1});
  base::Random random(4);
  // The frame of `to` is turned by a right angle: along the corridor is its y.
  const Pose2 T_building_to{3.0, 0.2, 0.5 * std::numbers::pi};
  const auto from = test::layersOf(corridor, test::placesAlong({0.0, 0.0}, {6.0, 0.0}), {}, &random);
  const auto to = test::layersOf(corridor, test::placesAlong({3.0, 0.2}, {9.0, 0.0}), T_building_to, &random);
  const auto match = matchSubMaps(from, to, {T_building_to, 0.3, 0.2});
  ASSERT_TRUE(match) << "within so small a window there is no other place";
  EXPECT_LT(match->information(1, 1), 0.05 * match->information(0, 0));
  EXPECT_NEAR(match->T_from_to.y, T_building_to.y, 0.03);
}

TEST(MatchSubMaps, RefusesWhereFreeFloorContradicts) {
  // One long wall is common to both; beyond, one has seen free floor where the other has a wall.
  FlatBuilding wide;
  wide.addBox({0.0, 0.0, 0.0}, 8.0, 6.0);
  FlatBuilding narrow;
  narrow.addBox({-2.0, 0.0, 0.0}, 4.0, 6.0);
  base::Random random(5);
  const auto places = test::placesAlong({-2.5, -1.0}, {-1.0, 1.0});
  const auto from = test::layersOf(wide, places, {}, &random);
  const auto to = test::layersOf(narrow, places, {}, &random);
  const SearchWindow window{{}, 0.3, 0.1};
  SubMapMatcherConfig config;
  EXPECT_FALSE(matchSubMaps(from, to, window, config));
  EXPECT_FALSE(matchSubMaps(to, from, window, config));
  config.mostConflict = 1.0;
  EXPECT_TRUE(matchSubMaps(from, to, window, config)) << "it is the free floor that tells";
}

TEST(MatchSubMaps, RefusesWhereTooLittleIsSeenByBoth) {
  FlatBuilding building;
  building.addBox({0.0, 0.0, 0.0}, 1.2, 1.0);
  const std::vector<Pose2> places = {{0.0, 0.0, 0.0}};
  const auto lift = test::layersOf(building, places, {});
  SubMapMatcherConfig config;
  config.leastWall = 10.0;
  EXPECT_FALSE(matchSubMaps(lift, lift, {{}, 0.3, 0.1}, config));
  config.leastWall = 2.0;
  EXPECT_TRUE(matchSubMaps(lift, lift, {{}, 0.3, 0.1}, config));
}

TEST(MatchSubMaps, RefusesWhatIsEmpty) {
  const auto room = test::twoDoorRoom(1);
  const auto full = test::layersOf(room, test::waySouth(), test::kSouthDoor);
  const auto empty = test::layersOf(room, {}, {});
  const SearchWindow window{{}, 1.0, 0.5};
  EXPECT_FALSE(matchSubMaps(full, empty, window));
  EXPECT_FALSE(matchSubMaps(empty, full, window));
  EXPECT_FALSE(matchSubMaps(empty, empty, window));
}

}  // namespace
}  // namespace prodomos::localization

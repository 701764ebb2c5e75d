// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/observed_places.hpp"

#include "evaluation/seen_floor.hpp"
#include "evaluation/small_building.hpp"

#include <gtest/gtest.h>

namespace prodomos::evaluation {
namespace {

using test::at;
using test::kQuarter;
using test::rectangle;

/// The corridor and office A of the small building, with a doorway between them.
struct ObservedFloor : testing::Test {
  std::vector<Polygon> floors = {rectangle(0, 0, 10, 2), rectangle(0, 2.2, 4, 6.2), rectangle(1.55, 2, 2.45, 2.2)};
  std::vector<Polygon> unseen;
  std::vector<ClaimedDoor> openings = {test::claimedDoor(1, {2, 2.1, kQuarter}, false)};

  ObservedPlaces places() const {
    return ObservedPlaces(KnownSpace({{0, at(0), {}, test::seenFloor(floors, unseen)}}), openings);
  }
};

TEST_F(ObservedFloor, IsPartedByTheOpeningsThatAreKnown) {
  const auto found = places();
  EXPECT_EQ(found.count(), 2U);
  const auto corridor = found.at(0, {8, 1});
  const auto office = found.at(0, {3, 5});
  ASSERT_TRUE(corridor);
  ASSERT_TRUE(office);
  EXPECT_NE(corridor, office);
  EXPECT_EQ(found.before(openings[0]), corridor);
  EXPECT_EQ(found.behind(openings[0]), office);
  EXPECT_NEAR(found.area(*corridor), 20.0, 0.2);
  EXPECT_NEAR(found.area(*office), 16.0, 0.2);
}

TEST_F(ObservedFloor, IsOneWithoutThem) {
  const auto opening = openings[0];
  openings.clear();
  EXPECT_EQ(places().count(), 1U);
  EXPECT_EQ(places().behind(opening), places().before(opening));
}

TEST_F(ObservedFloor, HasNoPlaceInWallsAndWhereNobodyLooked) {
  EXPECT_FALSE(places().at(0, {5, 2.1}));
  EXPECT_FALSE(places().at(0, {5, 5}));
  EXPECT_FALSE(places().at(0, {500, 5}));
  EXPECT_FALSE(places().at(1, {3, 5}));
  EXPECT_FALSE(places().behind(test::claimedDoor(2, {7, 2.1, kQuarter})));
}

TEST_F(ObservedFloor, IsNotJoinedByAHoleThatNobodyCanWalkThrough) {
  floors.push_back(rectangle(3.4, 2, 3.6, 2.2));
  EXPECT_EQ(places().count(), 2U);
  floors.push_back(rectangle(3.1, 2, 3.9, 2.2));
  EXPECT_EQ(places().count(), 1U);
}

TEST_F(ObservedFloor, ARoomIsItsFloorAndWhatStandsThere) {
  floors.push_back(rectangle(1, 4, 3, 5));  // taken away by the next: a table
  floors[1] = {{0, 2.2}, {4, 2.2}, {4, 6.2}, {0, 6.2}, {0, 5}, {3, 5}, {3, 4}, {1, 4}, {1, 5}, {0, 5}};
  floors.pop_back();
  const auto found = places();
  const auto office = found.behind(openings[0]);
  ASSERT_TRUE(office);
  EXPECT_NEAR(found.area(*office), 14.0, 0.2);
  const auto room = found.room(*office);
  EXPECT_NE(room.cells.at(geometry::cellAt(2, 4.5, kCell)), 0);
  EXPECT_NE(room.cells.at(geometry::cellAt(3.5, 4.5, kCell)), 0);
  EXPECT_EQ(room.cells.at(geometry::cellAt(2, 1, kCell)), 0);
  EXPECT_EQ(room.cells.at(geometry::cellAt(100, 1, kCell)), 0);
  EXPECT_EQ(room.enclosed, 1.0);
}

TEST_F(ObservedFloor, ARoomThatGoesOnUnseenIsNotEnclosed) {
  unseen = {rectangle(-1, 4.2, 5, 7)};  // its farther half, walls and all
  const auto found = places();
  const auto office = found.behind(openings[0]);
  ASSERT_TRUE(office);
  EXPECT_NEAR(found.area(*office), 8.0, 0.2);
  EXPECT_NEAR(found.room(*office).enclosed, 8.0 / 12.0, 0.02);
}

TEST_F(ObservedFloor, OfNothingHasNoPlaces) {
  const ObservedPlaces none(KnownSpace(), openings);
  EXPECT_EQ(none.count(), 0U);
  EXPECT_FALSE(none.behind(openings[0]));
}

}  // namespace
}  // namespace prodomos::evaluation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/ground_plan.hpp"

#include "evaluation/small_building.hpp"

#include <gtest/gtest.h>

namespace prodomos::evaluation {
namespace {

using test::at;

geometry::CellIndex cellOf(double x, double y) {
  return geometry::cellAt(x, y, kCell);
}

TEST(GroundPlan, KnowsRoomsAndWalls) {
  const GroundPlan plan(test::smallBuilding(), 0);
  EXPECT_EQ(plan.roomAt(cellOf(5, 1)), 0U);
  EXPECT_EQ(plan.roomAt(cellOf(2, 4)), 1U);
  EXPECT_EQ(plan.roomAt(cellOf(4.5, 4)), std::nullopt);  // between A and B
  EXPECT_FALSE(plan.isFloor(cellOf(4.5, 4), at(0)));
  EXPECT_FALSE(plan.isFloor(cellOf(5, 2.1), at(0)));
  EXPECT_FALSE(plan.isFloor(cellOf(50, 2.1), at(0)));
  EXPECT_FALSE(plan.isFloor(cellOf(-4, 1), at(0)));  // on the other storey
  EXPECT_TRUE(GroundPlan(test::smallBuilding(), 1).isFloor(cellOf(-4, 1), at(0)));
}

TEST(GroundPlan, LetsOneThroughOpenings) {
  const GroundPlan plan(test::smallBuilding(), 0);
  EXPECT_TRUE(plan.isFloor(cellOf(7.2, 2.08), at(0)));
  EXPECT_FALSE(plan.isFloor(cellOf(7.5, 2.08), at(0)));  // beside the doorway
}

TEST(GroundPlan, HasALeafInAClosedDoorAlone) {
  auto truth = test::smallBuilding();
  truth.doors[0].states.push_back({at(10), 1.2, map::DoorState::kOpen});
  const GroundPlan plan(truth, 0);
  EXPECT_FALSE(plan.isFloor(cellOf(2, 2.09), at(9)));
  EXPECT_TRUE(plan.isFloor(cellOf(2, 2.19), at(9)));  // behind the leaf, between the jambs
  EXPECT_TRUE(plan.isFloor(cellOf(2, 2.09), at(10)));
}

TEST(GroundPlan, OpensDoorsThatLeadOutside) {
  auto truth = test::smallBuilding();
  truth.doors.push_back(test::trueDoor("out", {10.1, 1, 0}, "corridor", "", 0));
  const GroundPlan plan(truth, 0);
  EXPECT_TRUE(plan.isFloor(cellOf(10.15, 1), at(0)));
  EXPECT_FALSE(plan.isFloor(cellOf(10.25, 1), at(0)));
}

TEST(GroundPlan, IsFurnishedBelowWhatStandsOnTheFloor) {
  auto truth = test::smallBuilding();
  const auto box = [](double z, map::Mobility mobility) {
    return TrueObject{
        .mobility = mobility, .size = {1, 2, 1}, .poses = {{at(0), geometry::toPose3({2, 4, test::kQuarter}, z)}}};
  };
  const auto isFurnished = [&truth](const TrueObject& object) {
    truth.objects = {object};
    return GroundPlan(truth, 0).isFurnished(cellOf(2.9, 4));  // within its length, which lies along x
  };
  EXPECT_TRUE(isFurnished(box(0.5, map::Mobility::kStatic)));
  EXPECT_TRUE(isFurnished(box(0.5, map::Mobility::kQuasiStatic)));
  EXPECT_FALSE(isFurnished(box(1.5, map::Mobility::kStatic)));  // hangs on the wall
  EXPECT_FALSE(isFurnished(box(0.5, map::Mobility::kDynamic)));
  EXPECT_FALSE(GroundPlan(truth, 1).isFurnished(cellOf(2, 4)));
}

TEST(GroundPlan, OfNothingHasNoFloor) {
  EXPECT_FALSE(GroundPlan({}, 0).isFloor({0, 0}, at(0)));
  EXPECT_TRUE(groundPlansOf({}).empty());
}

}  // namespace
}  // namespace prodomos::evaluation

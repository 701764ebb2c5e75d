// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/floor_plan.hpp"

#include "prodomos/base/error.hpp"

#include "simulation/drawn_plan.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace prodomos::simulation {
namespace {

using test::DrawnPlan;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kRounding = 1e-5;  // Of insets, metres.

class FloorPlan : public ::testing::Test {
 protected:
  Building read(const std::string& xml, const FloorPlanOptions& options = {.seed = 1}) const {
    return readFloorPlan(folder_.write("plan.xml", xml), options);
  }

  /// What the error says, without an error "".
  template <typename Error = base::FileError>
  std::string errorOf(const std::string& xml, const FloorPlanOptions& options = {}) const {
    try {
      read(xml, options);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  test::TemporaryFolder folder_;
};

const Room& roomLabelled(const Building& building, const std::string& label, int storey = 0) {
  return *std::ranges::find_if(building.rooms,
                               [&](const Room& room) { return room.label == label && room.storey == storey; });
}

int indexOf(const Building& building, const Room& room) {
  return static_cast<int>(&room - building.rooms.data());
}

/// The door into the room of that label, of the lowest storey.
const Door& doorInto(const Building& building, const std::string& label) {
  const int room = indexOf(building, roomLabelled(building, label));
  return *std::ranges::find_if(building.doors,
                               [&](const Door& door) { return door.rooms[0] == room || door.rooms[1] == room; });
}

Eigen::Vector2d beside(const Door& door, int side) {
  const double x = (side == 0 ? -1.0 : 1.0) * (door.wallThickness / 2.0 + 0.3);
  return door.pose * Eigen::Vector2d(x, 0.0);
}

TEST_F(FloorPlan, RoomsAreInsetByHalfAWall) {
  const auto building = read(test::smallSchool().xml());
  ASSERT_EQ(building.rooms.size(), 6U);
  EXPECT_TRUE(building.remarks.empty()) << building.remarks.front();
  const double wall = doorInto(building, "CLOSET").wallThickness;
  EXPECT_GE(wall, 0.15);
  EXPECT_LE(wall, 0.25);
  EXPECT_NEAR(signedArea(roomLabelled(building, "CLOSET").outline), (3.0 - wall) * (3.0 - wall), kRounding);
  EXPECT_NEAR(signedArea(roomLabelled(building, "CORRIDOR").outline), (12.0 - wall) * (2.0 - wall), kRounding);
}

TEST_F(FloorPlan, WhatIsAboveInTheImageLiesNorth) {
  const auto building = read(test::smallSchool().xml());
  // The classrooms stand above the corridor, the stairwell below it and to the left.
  EXPECT_EQ(building.rooms[static_cast<std::size_t>(roomAt(building, 0, {3.0, 11.0}))].label, "CLASSROOM");
  EXPECT_EQ(building.rooms[static_cast<std::size_t>(roomAt(building, 0, {1.5, 3.0}))].label, "STAIRS");
}

TEST_F(FloorPlan, DoorsStandWherePortalsAreDrawn) {
  const auto building = read(test::smallSchool().xml());
  ASSERT_EQ(building.doors.size(), 5U);
  EXPECT_NEAR(doorInto(building, "CLOSET").pose.x, 4.5, kRounding);
  EXPECT_NEAR(doorInto(building, "CLOSET").pose.y, 6.0, kRounding);
  for (const auto& door : building.doors) {
    for (const int side : {0, 1}) {
      EXPECT_EQ(roomAt(building, 0, beside(door, side)), door.rooms[static_cast<std::size_t>(side)]) << door.id;
    }
  }
}

TEST_F(FloorPlan, TheTwoPointsOfAPortalAreTheJambsOfItsDoor) {
  DrawnPlan plan;
  plan.room("a", "OFFICE", {0, 0, 60, 60}).room("b", "OFFICE", {60, 0, 120, 60});
  plan.portal({.from = "a", .to = "b", .point = {60, 30}, .shift = {0, 9}});
  const auto building = read(plan.xml());
  ASSERT_EQ(building.doors.size(), 1U);
  EXPECT_NEAR(building.doors[0].pose.x, 6.0, kRounding);
  EXPECT_NEAR(building.doors[0].pose.y, 6.0 - 3.45, kRounding);
}

TEST_F(FloorPlan, ThePlanSaysWhichDoorsAreDoubleAndWhichAreNone) {
  const auto building = read(test::smallSchool().xml());
  EXPECT_EQ(building.doors[1].leaves, 2);
  EXPECT_GE(building.doors[1].width, 1.4);
  EXPECT_LE(building.doors[1].width, 1.8);
  const Door& passage = doorInto(building, "STAIRS");
  EXPECT_EQ(passage.leaves, 0);
  // As wide as the two share a wall, less its corners.
  EXPECT_GT(passage.width, 2.3);
  EXPECT_LT(passage.width, 3.0);
  EXPECT_GT(passage.height, 2.1);
}

TEST_F(FloorPlan, SeveralPortalsOfOneOpenBoundaryAreOnePassage) {
  auto plan = test::smallSchool();
  plan.portal({"corridor", "stairs", {20, 80}, "IMPLICIT"});
  EXPECT_EQ(read(plan.xml()).doors.size(), 5U);
}

TEST_F(FloorPlan, ADoorInACornerMovesAlongTheWall) {
  DrawnPlan plan;
  plan.room("a", "OFFICE", {0, 0, 60, 60}).room("b", "OFFICE", {60, 0, 120, 60});
  plan.portal({"a", "b", {60, 0}});
  const auto building = read(plan.xml());
  ASSERT_EQ(building.doors.size(), 1U);
  const Door& door = building.doors[0];
  const double corner = 6.0 - door.wallThickness / 2.0;
  EXPECT_NEAR(corner - (door.pose.y + door.width / 2.0), 0.12, 1e-6);
}

TEST_F(FloorPlan, DoorsOfOneWallKeepApart) {
  DrawnPlan plan;
  plan.room("a", "OFFICE", {0, 0, 60, 60}).room("b", "OFFICE", {60, 0, 120, 60});
  plan.portal({"a", "b", {60, 30}}).portal({"a", "b", {60, 33}}).portal({"a", "b", {60, 27}});
  const auto building = read(plan.xml());
  ASSERT_EQ(building.doors.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto& a = building.doors[i];
      const auto& b = building.doors[j];
      EXPECT_GT(std::abs(a.pose.y - b.pose.y), (a.width + b.width) / 2.0 + 0.2);
    }
  }
}

TEST_F(FloorPlan, ANarrowSharedWallNarrowsTheDoor) {
  DrawnPlan plan;
  plan.room("a", "GYM", {0, 0, 60, 60}).space("b", "HALL", {{60, 48}, {120, 48}, {120, 110}, {60, 110}});
  plan.portal({"a", "b", {60, 55}, "EXPLICIT", "DOUBLE"});
  const auto building = read(plan.xml());
  ASSERT_EQ(building.doors.size(), 1U);
  EXPECT_EQ(building.doors[0].leaves, 1);
  EXPECT_LT(building.doors[0].width, 0.85);
}

TEST_F(FloorPlan, OpenLeavesStayInTheirRoom) {
  const auto xml = test::smallSchool().xml();
  int open = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto building = read(xml, {.seed = seed});
    for (const auto& door : building.doors) {
      const double angle = openingAngle(door, 0.0);
      EXPECT_LE(angle, 95.0 * std::numbers::pi / 180.0);
      if (angle == 0.0) continue;
      ++open;
      EXPECT_EQ(door.swings.size(), 1U);
      EXPECT_FALSE(isLiftDoor(building, door));
      EXPECT_GT(door.leaves, 0);
    }
  }
  EXPECT_GT(open, 10);
  EXPECT_LT(open, 40);
}

TEST_F(FloorPlan, TheSameSeedGivesTheSameBuildingAndAnotherAnother) {
  const auto xml = test::smallSchool().xml();
  const auto one = read(xml, {.seed = 5});
  const auto same = read(xml, {.seed = 5});
  const auto other = read(xml, {.seed = 6});
  ASSERT_EQ(one.doors.size(), same.doors.size());
  for (std::size_t i = 0; i < one.doors.size(); ++i) {
    EXPECT_EQ(one.doors[i].pose, same.doors[i].pose);
    EXPECT_EQ(one.doors[i].width, same.doors[i].width);
    EXPECT_EQ(openingAngle(one.doors[i], 0.0), openingAngle(same.doors[i], 0.0));
  }
  EXPECT_NE(one.doors[0].width, other.doors[0].width);
  EXPECT_NE(one.storeys[0].ceilingHeight, other.storeys[0].ceilingHeight);
}

TEST_F(FloorPlan, StoreysAreStackedAndJoinedByStairsAndLift) {
  const auto building = read(test::smallSchool().xml(), {.seed = 2, .storeys = 3});
  ASSERT_EQ(building.storeys.size(), 3U);
  ASSERT_EQ(building.rooms.size(), 18U);
  ASSERT_EQ(building.doors.size(), 15U);
  for (const auto& door : building.doors) {
    for (const int room : door.rooms) EXPECT_EQ(building.rooms[static_cast<std::size_t>(room)].storey, door.storey);
  }
  ASSERT_EQ(building.lifts.size(), 1U);
  EXPECT_EQ(building.lifts[0].rooms.size(), 3U);
  ASSERT_FALSE(building.stairs.empty());
  for (int storey = 0; storey < 2; ++storey) {
    double climbed = 0.0;
    for (const auto& stairs : building.stairs) {
      if (stairs.lowerStorey != storey) continue;
      EXPECT_EQ(stairs.upperStorey, storey + 1);
      EXPECT_EQ(building.rooms[static_cast<std::size_t>(stairs.rooms[0])].storey, storey);
      EXPECT_EQ(building.rooms[static_cast<std::size_t>(stairs.rooms[1])].storey, storey + 1);
      EXPECT_GE(stairs.stepHeight, 0.15);
      EXPECT_LE(stairs.stepHeight, 0.19);
      EXPECT_GE(stairs.stepDepth, 0.26);
      EXPECT_LE(stairs.stepDepth, 0.31);
      EXPECT_GE(stairs.width, 0.9);
      climbed += headOf(stairs).z() - stairs.foot.z();
    }
    const auto& floors = building.storeys;
    const auto s = static_cast<std::size_t>(storey);
    EXPECT_NEAR(climbed, floors[s + 1].floor_z - floors[s].floor_z, 1e-9);
  }
}

TEST_F(FloorPlan, ASingleStoreyHasStairsToOneThatIsNotThere) {
  const auto building = read(test::smallSchool().xml());
  ASSERT_FALSE(building.stairs.empty());
  for (const auto& stairs : building.stairs) {
    EXPECT_EQ(stairs.upperStorey, 1);
    EXPECT_EQ(stairs.rooms[1], kOutside);
  }
}

TEST_F(FloorPlan, ALongStairwellHasOneFlightAndAShortOneTwoThatMeetOnALanding) {
  DrawnPlan plan;
  plan.room("corridor", "CORRIDOR", {0, 0, 200, 30})
      .room("long", "STAIRS", {0, 30, 35, 130})
      .room("short", "STAIRS", {100, 30, 130, 80})
      .portal({"corridor", "long", {20, 30}})
      .portal({"corridor", "short", {115, 30}});
  const auto building = read(plan.xml());
  ASSERT_EQ(building.stairs.size(), 3U);
  ASSERT_EQ(building.landings.size(), 1U);
  const auto& lower = building.stairs[1];
  const auto& upper = building.stairs[2];
  EXPECT_NEAR(headOf(lower).z(), building.landings[0].z, 1e-9);
  EXPECT_NEAR(upper.foot.z(), building.landings[0].z, 1e-9);
  EXPECT_NEAR(std::abs(geometry::normalizeAngle(lower.direction - upper.direction)), std::numbers::pi, 1e-9);
  EXPECT_NEAR(headOf(building.stairs[0]).z(), headOf(upper).z(), 1e-9);
}

TEST_F(FloorPlan, AStairwellThatIsTooSmallStaysEmptyWithARemark) {
  DrawnPlan plan;
  plan.room("corridor", "CORRIDOR", {0, 0, 100, 20}).room("well", "STAIRS", {0, 20, 20, 40});
  plan.portal({"corridor", "well", {10, 20}});
  const auto building = read(plan.xml());
  EXPECT_TRUE(building.stairs.empty());
  EXPECT_THAT(building.remarks, ::testing::ElementsAre(HasSubstr("too small")));
}

TEST_F(FloorPlan, RoomsDrawnOverEachOtherAreParted) {
  DrawnPlan plan;
  plan.room("hall", "HALL", {0, 0, 100, 100}).room("closet", "CLOSET", {80, 80, 120, 120});
  plan.portal({"hall", "closet", {80, 90}});
  const auto building = read(plan.xml());
  ASSERT_EQ(building.rooms.size(), 2U);
  ASSERT_EQ(building.doors.size(), 1U);
  EXPECT_THAT(building.remarks, ::testing::ElementsAre(HasSubstr("HALL) is drawn over a CLOSET")));
  EXPECT_GT(building.doors[0].wallThickness, 0.1);
  for (const auto& corner : roomLabelled(building, "CLOSET").outline) {
    EXPECT_FALSE(contains(roomLabelled(building, "HALL").outline, corner));
  }
}

TEST_F(FloorPlan, ARoomWithinAnotherIsLeftOutWithItsDoor) {
  auto plan = test::smallSchool();
  plan.room("box", "OFFICE", {10, 10, 40, 40}).portal({"left", "box", {10, 20}});
  const auto building = read(plan.xml());
  EXPECT_EQ(building.rooms.size(), 6U);
  EXPECT_EQ(building.doors.size(), 5U);
  EXPECT_THAT(building.remarks, ::testing::ElementsAre(HasSubstr("stands free within CLASSROOM"),
                                                       HasSubstr("is left out: so was its room")));
}

TEST_F(FloorPlan, ARoomTooThinForItsWallsIsLeftOut) {
  auto plan = test::smallSchool();
  plan.room("slit", "CLOSET", {120, 0, 121, 60});
  const auto building = read(plan.xml());
  EXPECT_EQ(building.rooms.size(), 6U);
  EXPECT_THAT(building.remarks, ::testing::ElementsAre(AllOf(HasSubstr("space slit"), HasSubstr("too thin"))));
}

TEST_F(FloorPlan, APortalFarFromAnySharedWallIsLeftOut) {
  auto plan = test::smallSchool();
  plan.portal({"left", "closet", {30, 70}});
  const auto building = read(plan.xml());
  EXPECT_EQ(building.doors.size(), 5U);
  EXPECT_THAT(building.remarks, ::testing::ElementsAre(HasSubstr("no wall between its rooms")));
}

TEST_F(FloorPlan, SpacesWithoutAnOutlineArePartsOfOthers) {
  auto plan = test::smallSchool();
  plan.space("part", "OFFICE", {});
  const auto building = read(plan.xml());
  EXPECT_EQ(building.rooms.size(), 6U);
  EXPECT_TRUE(building.remarks.empty());
}

TEST_F(FloorPlan, APortalThatJoinsNoRoomIsNamed) {
  auto plan = test::smallSchool();
  plan.portal({"left", "attic", {0, 10}});
  EXPECT_THAT(errorOf(plan.xml()),
              AllOf(HasSubstr("plan.xml"), HasSubstr("portal p5"), HasSubstr("expected"), HasSubstr("\"attic\"")));
}

TEST_F(FloorPlan, APortalFromARoomIntoItselfIsNamed) {
  auto plan = test::smallSchool();
  plan.portal({"left", "left", {0, 10}});
  EXPECT_THAT(errorOf(plan.xml()), AllOf(HasSubstr("portal p5"), HasSubstr("one other")));
}

TEST_F(FloorPlan, AnOutlineThatCrossesItselfIsNamed) {
  auto plan = test::smallSchool();
  plan.space("bow", "OFFICE", {{200, 0}, {260, 60}, {260, 0}, {200, 60}});
  EXPECT_THAT(errorOf(plan.xml()), AllOf(HasSubstr("space bow (OFFICE)"), HasSubstr("edges 1 and 3 that cross")));
}

TEST_F(FloorPlan, ScalesThatSayNothingAreNamed) {
  auto plan = test::smallSchool();
  const std::string scale = plan.scale;
  plan.scale = "";
  EXPECT_THAT(errorOf(plan.xml()), HasSubstr("expected <scale>, found none"));
  const auto with = [&](const std::string& from, const std::string& to) {
    plan.scale = scale;
    plan.scale.replace(plan.scale.find(from), from.size(), to);
    return errorOf(plan.xml());
  };
  EXPECT_THAT(with("<value>9<", "<value>0<"),
              HasSubstr("scale/represented_distance/value: expected a positive number, found \"0\""));
  EXPECT_THAT(with("<value>90<", "<value>wide<"), HasSubstr("found \"wide\""));
  EXPECT_THAT(with("<value>90<", "<value><"), HasSubstr("found nothing"));
  EXPECT_THAT(with("<um>cm<", "<um>inch<"), HasSubstr("scale/real_distance/um: expected \"cm\", found \"inch\""));
}

TEST_F(FloorPlan, WhatIsNoPlanIsNamed) {
  EXPECT_THAT(errorOf("rooms: 3\n"), HasSubstr("expected XML"));
  EXPECT_THAT(errorOf("<house/>"), HasSubstr("expected <building>, found <house>"));
  EXPECT_THAT(errorOf(test::smallSchool().xml().substr(0, 700)), HasSubstr("expected XML"));
  EXPECT_THROW(readFloorPlan(folder_.path() / "none.xml", {}), base::FileError);
}

TEST_F(FloorPlan, APlanWithoutRoomsOrDoorsIsNamed) {
  EXPECT_THAT(errorOf(DrawnPlan().xml()), HasSubstr("expected spaces with a bounding_polygon, found none"));
  DrawnPlan slits;
  slits.room("slit", "CLOSET", {0, 0, 1, 60});
  EXPECT_THAT(errorOf(slits.xml()), HasSubstr("rooms that hold more than their walls"));
  DrawnPlan shut;
  shut.room("a", "OFFICE", {0, 0, 60, 60});
  EXPECT_THAT(errorOf(shut.xml()), HasSubstr("expected a portal between two rooms"));
}

TEST_F(FloorPlan, PointsThatAreNoNumbersAreNamed) {
  auto xml = test::smallSchool().xml();
  xml.replace(xml.find("x=\"120\""), 7, "x=\"far\"");
  EXPECT_THAT(errorOf(xml), AllOf(HasSubstr("space corridor: bounding_polygon"), HasSubstr("x=\"far\"")));
}

TEST_F(FloorPlan, ABuildingHasAStorey) {
  EXPECT_THAT(errorOf<base::UsageError>(test::smallSchool().xml(), {.storeys = 0}), HasSubstr("at least 1"));
}

}  // namespace
}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/worlds/stand_ins.hpp"

#include "prodomos/simulation/furniture.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <set>

namespace prodomos::simulation {
namespace {

/// A room 6 x 4 m on one storey.
Building emptyRoom() {
  Building building;
  building.storeys = {{0.0, 2.8}};
  building.rooms = {{.id = "r0.0", .outline = cornersOf({Eigen::Vector2d(0, 0), Eigen::Vector2d(6, 4)})}};
  return building;
}

std::vector<Segment> wallsOf(const Building& building) {
  std::vector<Segment> walls;
  const auto& outline = building.rooms[0].outline;
  for (std::size_t i = 0; i < outline.size(); ++i) walls.push_back({outline[i], outline[(i + 1) % outline.size()]});
  return walls;
}

Thing placed(std::string_view model, const geometry::Pose2& pose, double z = 0.0) {
  Building building = emptyRoom();
  addStandIn(*findStandIn(model), 0, geometry::toPose3(pose, z), wallsOf(building), building);
  return building.things.at(0);
}

Eigen::Vector3d frontOf(const Thing& thing) {
  return thing.T_world_thing.linear().col(0);
}

TEST(StandIns, EachIsOfAKnownKindOrAPerson) {
  std::set<std::string_view> models;
  for (const auto& standIn : standIns()) {
    EXPECT_TRUE(models.insert(standIn.model).second) << standIn.model << " twice";
    if (standIn.kind.empty()) {
      EXPECT_NE(standIn.person, Posture::kNone) << standIn.model;
    } else {
      EXPECT_NE(findThingKind(standIn.kind), nullptr) << standIn.kind;
      EXPECT_GT(standIn.size.minCoeff(), 0.0) << standIn.model;
    }
  }
  EXPECT_EQ(findStandIn("Rocket"), nullptr);
}

TEST(StandIns, FurnitureStandsOnTheFloor) {
  const auto chair = placed("Chair", {3.0, 2.0, 0.0}, 0.02);
  EXPECT_NEAR(chair.T_world_thing.translation().z() - chair.size.z() / 2.0, 0.0, 1e-9);
  EXPECT_TRUE(frontOf(chair).isApprox(-Eigen::Vector3d::UnitY(), 1e-9));
}

TEST(StandIns, ACabinetTurnsItsBackToTheWallAndDoesNotStickInIt) {
  const auto cabinet = placed("MetalCabinet", {3.0, 3.9, std::numbers::pi});
  EXPECT_TRUE(frontOf(cabinet).isApprox(-Eigen::Vector3d::UnitY(), 1e-9));
  EXPECT_NEAR(cabinet.T_world_thing.translation().y(), 4.0 - cabinet.size.x() / 2.0, 1e-9);
  const auto bed = placed("CGMClassic", {4.8, 2.0, std::numbers::pi});
  EXPECT_TRUE(frontOf(bed).isApprox(-Eigen::Vector3d::UnitX(), 1e-9));
}

TEST(StandIns, APictureHangsOnTheWallAtItsHeight) {
  const auto picture = placed("aws_robomaker_residential_PortraitD_02", {0.06, 2.0, std::numbers::pi / 2.0}, 1.5);
  EXPECT_NEAR(picture.T_world_thing.translation().x(), picture.size.x() / 2.0, 1e-9);
  EXPECT_NEAR(picture.T_world_thing.translation().z(), 1.5, 1e-9);
  EXPECT_TRUE(frontOf(picture).isApprox(Eigen::Vector3d::UnitX(), 1e-9));
}

TEST(StandIns, PeopleStandOrSitWhereTheirModelsDo) {
  Building building = emptyRoom();
  addStandIn(*findStandIn("FemaleVisitor"), 0, geometry::toPose3({2.0, 1.0, 0.0}), {}, building);
  addStandIn(*findStandIn("MaleVisitorSit"), 0, geometry::toPose3({3.0, 1.0, 0.0}), {}, building);
  ASSERT_EQ(building.people.size(), 2U);
  EXPECT_FALSE(building.people[0].sits);
  EXPECT_TRUE(building.people[1].sits);
  EXPECT_EQ(building.people[0].way.at(0).position, Eigen::Vector2d(2.0, 1.0));
  EXPECT_NEAR(building.people[0].heading, -std::numbers::pi / 2.0, 1e-9);
  EXPECT_TRUE(building.things.empty());
}

TEST(StandIns, ThingsNameTheirRoom) {
  Building building = emptyRoom();
  EXPECT_EQ(labelByThings(building, 0), "ROOM");
  building.things.push_back({.kind = "toilet", .T_world_thing = geometry::toPose3({9.0, 1.0, 0.0})});
  EXPECT_EQ(labelByThings(building, 0), "ROOM");
  building.things.push_back({.kind = "hospital_bed", .T_world_thing = geometry::toPose3({3.0, 1.0, 0.0})});
  EXPECT_EQ(labelByThings(building, 0), "WARD");
}

}  // namespace
}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/shell.hpp"

#include "prodomos/base/random.hpp"
#include "prodomos/simulation/floor_plan.hpp"

#include "simulation/brute_force_rays.hpp"
#include "simulation/drawn_plan.hpp"
#include "support/datasets.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace prodomos::simulation {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kRightAngle = 90.0 * kDegree;
constexpr std::uint64_t kSeed = 7;

using test::BruteHit;
using test::castBruteForce;

/// Two rooms of 4 x 4 m side by side, a wall of 0.2 m between them, and one door in it that faces east.
Building twoRooms() {
  Building building{.name = "two rooms", .storeys = {Storey{}}};
  building.rooms = {
      {.id = "west", .label = "CORRIDOR", .use = RoomUse::kCorridor, .outline = {{0, 0}, {4, 0}, {4, 4}, {0, 4}}},
      {.id = "east", .label = "OFFICE", .outline = {{4.2, 0}, {8.2, 0}, {8.2, 4}, {4.2, 4}}}};
  building.doors = {{.id = "door", .rooms = {0, 1}, .pose = {4.1, 2.0, 0.0}}};
  return building;
}

std::vector<Surface> allSurfaces(const Building& building, double time = 0.0) {
  auto surfaces = shellOf(building, kSeed);
  for (std::size_t i = 0; i < building.doors.size(); ++i) {
    for (auto& leaf : leavesAt(building, i, time, kSeed)) surfaces.push_back(std::move(leaf));
  }
  return surfaces;
}

Building schoolOf(const FloorPlanOptions& options) {
  const test::TemporaryFolder folder;
  return readFloorPlan(folder.write("school.xml", test::smallSchool().xml()), options);
}

void closeDoors(Building& building) {
  for (auto& door : building.doors) door.swings.clear();
}

bool isA(const Surface& surface, const char* name) {
  return surface.classId == classId(name);
}

std::vector<Surface> only(const std::vector<Surface>& surfaces, const char* name) {
  std::vector<Surface> some;
  std::ranges::copy_if(surfaces, std::back_inserter(some), [&](const Surface& surface) { return isA(surface, name); });
  return some;
}

Eigen::Vector3d middleOf(const Building& building, std::size_t room) {
  const auto& outline = building.rooms[room].outline;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const auto& corner : outline) sum += corner;
  const Eigen::Vector2d middle = sum / static_cast<double>(outline.size());
  return {middle.x(), middle.y(), building.storeys[static_cast<std::size_t>(building.rooms[room].storey)].floor_z};
}

/// Whether the point lies in a room or in the opening of a door of that storey, give or take 2 cm.
bool isIndoors(const Building& building, int storey, const Eigen::Vector2d& point) {
  constexpr double kTolerance = 0.02;
  for (const double x : {-kTolerance, 0.0, kTolerance}) {
    for (const double y : {-kTolerance, 0.0, kTolerance}) {
      if (roomAt(building, storey, point + Eigen::Vector2d(x, y)) != kOutside) return true;
    }
  }
  return std::ranges::any_of(building.doors, [&](const Door& door) {
    const Eigen::Vector2d point_in_door = geometry::inverse(door.pose) * point;
    return door.storey == storey && std::abs(point_in_door.x()) < door.wallThickness / 2.0 + 0.1 &&
           std::abs(point_in_door.y()) < door.width / 2.0 + kTolerance;
  });
}

/// Rays all around at 1 m above the floor of each room of the lowest storey; all must end on something, indoors.
void expectTight(const Building& building, int rays) {
  const auto surfaces = allSurfaces(building);
  for (std::size_t i = 0; i < building.rooms.size(); ++i) {
    const auto& room = building.rooms[i];
    const Eigen::Vector3d origin = middleOf(building, i) + Eigen::Vector3d::UnitZ();
    if (room.storey != 0 || !contains(room.outline, origin.head<2>())) continue;
    for (int k = 0; k < rays; ++k) {
      const double angle = 2.0 * std::numbers::pi * (k + 0.37) / rays;
      const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), 0.0);
      const auto hit = castBruteForce(surfaces, origin, direction);
      ASSERT_TRUE(hit) << building.name << " " << room.id << " leaks at " << angle;
      const Eigen::Vector3d end = origin + hit->distance * direction;
      ASSERT_TRUE(isIndoors(building, 0, end.head<2>())) << building.name << " " << room.id << " " << end.transpose();
    }
  }
}

TEST(Shell, NoRayLeavesARoomWhoseDoorIsClosed) {
  const auto building = twoRooms();
  const auto surfaces = allSurfaces(building);
  base::Random random(1, "rays");
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3d origin(random.uniform(0.3, 3.7), random.uniform(0.3, 3.7), random.uniform(0.3, 2.5));
    const Eigen::Vector3d direction(random.normal(0.0, 1.0), random.normal(0.0, 1.0), random.normal(0.0, 1.0));
    const auto hit = castBruteForce(surfaces, origin, direction);
    ASSERT_TRUE(hit) << "from " << origin.transpose() << " along " << direction.transpose();
    ASSERT_LT((origin + hit->distance * direction).x(), 4.2) << "seen through the closed door";
  }
}

TEST(Shell, AllFacesShowTheirFrontToTheRoom) {
  const auto building = twoRooms();
  auto surfaces = shellOf(building, kSeed);
  base::Random random(2, "rays");
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d direction(random.normal(0.0, 1.0), random.normal(0.0, 1.0), random.normal(0.0, 1.0));
    const auto hit = castBruteForce(surfaces, {2.0, 2.0, 1.3}, direction);
    ASSERT_TRUE(hit);
    ASSERT_LT(hit->normal.dot(direction), 0.0) << "class " << surfaces[hit->surface].classId;
  }
}

TEST(Shell, AClosedLeafFillsItsOpening) {
  for (const bool alongNormal : {true, false}) {
    for (const int leaves : {1, 2}) {
      auto building = twoRooms();
      Door& door = building.doors[0];
      door.leaves = leaves;
      door.opensAlongNormal = alongNormal;
      const auto surfaces = allSurfaces(building);
      for (double y = -0.449; y < 0.45; y += 0.0311) {
        for (double z = 0.001; z < door.height; z += 0.0533) {
          const auto hit = castBruteForce(surfaces, {3.0, 2.0 + y, z}, Eigen::Vector3d::UnitX());
          ASSERT_TRUE(hit);
          ASSERT_TRUE(isA(surfaces[hit->surface], "door")) << y << " " << z;
          ASSERT_EQ(surfaces[hit->surface].instance, doorInstance(0));
        }
      }
    }
  }
}

TEST(Shell, ARayPassesAnOpenDoor) {
  auto building = twoRooms();
  building.doors[0].swings = {{0.0, kRightAngle}};
  const auto surfaces = allSurfaces(building);
  const auto hit = castBruteForce(surfaces, {2.0, 2.0, 1.0}, Eigen::Vector3d::UnitX());
  ASSERT_TRUE(hit);
  EXPECT_TRUE(isA(surfaces[hit->surface], "wall"));
  EXPECT_NEAR(hit->distance, 6.2, 1e-4);
}

TEST(Shell, ALeafKeepsItsShapeWhileItTurns) {
  for (const auto hinge : {map::HingeSide::kLeft, map::HingeSide::kRight}) {
    auto building = twoRooms();
    Door& door = building.doors[0];
    door.hingeSide = hinge;
    door.swings = {{0.0, 0.0}, {10.0, kRightAngle}};
    const auto closed = leavesAt(building, 0, 0.0, kSeed);
    for (const double time : {1.0, 5.0, 10.0}) {
      const auto turned = leavesAt(building, 0, time, kSeed);
      ASSERT_EQ(turned.size(), closed.size());
      for (std::size_t i = 0; i < closed.size(); ++i) {
        EXPECT_EQ(turned[i].triangles, closed[i].triangles);
        const auto& a = closed[i].vertices;
        const auto& b = turned[i].vertices;
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t k = 1; k < a.size(); ++k) {
          EXPECT_NEAR((a[k] - a[0]).norm(), (b[k] - b[0]).norm(), 1e-4);
          EXPECT_NEAR(a[k].z(), b[k].z(), 1e-5);
        }
      }
    }
  }
}

/// Where the corner of the leaf that is farthest from a hinge has gone.
Eigen::Vector3d farthestFrom(const std::vector<Surface>& leaf, const Eigen::Vector2d& hinge) {
  Eigen::Vector3f farthest = leaf[0].vertices[0];
  const auto distance = [&](const Eigen::Vector3f& vertex) { return (vertex.head<2>().cast<double>() - hinge).norm(); };
  for (const auto& vertex : leaf[0].vertices) {
    if (distance(vertex) > distance(farthest)) farthest = vertex;
  }
  return farthest.cast<double>();
}

TEST(Shell, ALeafTurnsAboutItsHingeIntoTheRoomItOpensTo) {
  for (const bool alongNormal : {true, false}) {
    for (const auto side : {map::HingeSide::kLeft, map::HingeSide::kRight}) {
      auto building = twoRooms();
      Door& door = building.doors[0];
      door.opensAlongNormal = alongNormal;
      door.hingeSide = side;
      door.swings = {{0.0, kRightAngle}};
      // Left, seen along the normal to the east, is north.
      const double hinge_y = side == map::HingeSide::kLeft ? 2.45 : 1.55;
      const auto tip = farthestFrom(leavesAt(building, 0, 0.0, kSeed), {4.1, hinge_y});
      EXPECT_NEAR(tip.y(), hinge_y, 0.05);
      EXPECT_GT(alongNormal ? tip.x() - 4.1 : 4.1 - tip.x(), 0.75);
    }
  }
}

TEST(Shell, AnOpenLeafDoesNotCutIntoTheWall) {
  for (const double angle : {30.0, 75.0, 90.0, 95.0}) {
    for (const int leaves : {1, 2}) {
      auto building = twoRooms();
      Door& door = building.doors[0];
      door.leaves = leaves;
      door.swings = {{0.0, angle * kDegree}};
      for (const auto& part : leavesAt(building, 0, 0.0, kSeed)) {
        for (const auto& vertex : part.vertices) {
          // Within the opening, or out of the wall.
          const bool isInOpening = std::abs(vertex.y() - 2.0F) <= 0.45F + 0.002F;
          EXPECT_TRUE(isInOpening || vertex.x() < 4.0F + 1e-4F || vertex.x() > 4.2F - 1e-4F) << vertex.transpose();
        }
      }
    }
  }
}

TEST(Shell, HandlesStandOutOnBothSidesAwayFromTheHinge) {
  auto building = twoRooms();
  building.doors[0].hingeSide = map::HingeSide::kLeft;
  const auto leaf = leavesAt(building, 0, 0.0, kSeed);
  const auto& slab = leaf[0];
  float least = 1e9F;
  float most = -1e9F;
  for (const auto& vertex : slab.vertices) {
    least = std::min(least, vertex.x());
    most = std::max(most, vertex.x());
  }
  bool before = false;
  bool behind = false;
  for (std::size_t i = 1; i < leaf.size(); ++i) {
    for (const auto& vertex : leaf[i].vertices) {
      if (std::abs(vertex.z() - 1.05F) > 0.02F || (vertex.x() > least - 0.03F && vertex.x() < most + 0.03F)) continue;
      EXPECT_LT(vertex.y(), 1.55F + 0.25F);
      before |= vertex.x() < least;
      behind |= vertex.x() > most;
    }
  }
  EXPECT_TRUE(before);
  EXPECT_TRUE(behind);
}

TEST(Shell, AFrameSurroundsTheOpeningAndStandsOut) {
  const auto building = twoRooms();
  const auto frames = only(shellOf(building, kSeed), "door_frame");
  ASSERT_FALSE(frames.empty());
  Eigen::AlignedBox3f box;
  for (const auto& frame : frames) {
    EXPECT_EQ(frame.instance, doorInstance(0));
    for (const auto& vertex : frame.vertices) box.extend(vertex);
  }
  const auto within = [](float value, float least, float most) { return value >= least && value <= most; };
  EXPECT_TRUE(within(4.0F - box.min().x(), 0.01F, 0.02F));
  EXPECT_TRUE(within(box.max().x() - 4.2F, 0.01F, 0.02F));
  EXPECT_TRUE(within(1.55F - box.min().y(), 0.05F, 0.08F));
  EXPECT_TRUE(within(box.max().y() - 2.45F, 0.05F, 0.08F));
  EXPECT_TRUE(within(box.max().z() - 2.05F, 0.05F, 0.08F));
}

TEST(Shell, SkirtingStopsAtDoors) {
  const auto building = twoRooms();
  for (const auto& skirting : only(shellOf(building, kSeed), "skirting")) {
    for (const auto& vertex : skirting.vertices) {
      EXPECT_LE(vertex.z(), 0.1F);
      const bool isAtDoorsWall = std::abs(vertex.x() - 4.1F) < 0.15F;
      EXPECT_FALSE(isAtDoorsWall && std::abs(vertex.y() - 2.0F) < 0.45F) << vertex.transpose();
    }
  }
}

TEST(Shell, APassageHasNeitherLeafNorFrame) {
  auto building = twoRooms();
  Door& door = building.doors[0];
  door.leaves = 0;
  door.width = 3.0;
  door.height = building.storeys[0].ceilingHeight;
  EXPECT_TRUE(leavesAt(building, 0, 0.0, kSeed).empty());
  const auto surfaces = shellOf(building, kSeed);
  EXPECT_TRUE(only(surfaces, "door_frame").empty());
  const auto hit = castBruteForce(surfaces, {1.0, 1.0, 2.7}, Eigen::Vector3d::UnitX());
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance, 7.2, 1e-4);
}

TEST(Shell, ANarrowDoorwayHasAFrameButNoLeaf) {
  auto building = twoRooms();
  building.doors[0].leaves = 0;
  EXPECT_TRUE(leavesAt(building, 0, 0.0, kSeed).empty());
  EXPECT_FALSE(only(shellOf(building, kSeed), "door_frame").empty());
}

TEST(Shell, ALiftHasLiftDoorsWhichStayShut) {
  auto building = twoRooms();
  building.rooms[1].use = RoomUse::kLift;
  building.doors[0].leaves = 2;
  building.doors[0].swings = {{0.0, kRightAngle}};
  const auto surfaces = allSurfaces(building);
  EXPECT_TRUE(only(surfaces, "door").empty());
  const auto hit = castBruteForce(surfaces, {2.0, 2.1, 1.0}, Eigen::Vector3d::UnitX());
  ASSERT_TRUE(hit);
  EXPECT_TRUE(isA(surfaces[hit->surface], "lift_door"));
}

TEST(Shell, WhatAnImportBringsIsNotMadeAgain) {
  auto building = twoRooms();
  building.imported = {Surface{.classId = classId("wall")}};
  for (const auto& surface : shellOf(building, kSeed)) EXPECT_TRUE(isA(surface, "door_frame"));
  EXPECT_FALSE(shellOf(building, kSeed).empty());
  building.imported.push_back(Surface{.classId = classId("door_frame")});
  EXPECT_TRUE(shellOf(building, kSeed).empty());
  EXPECT_FALSE(leavesAt(building, 0, 0.0, kSeed).empty());
}

TEST(Shell, TheSeedChoosesTheColours) {
  const auto building = twoRooms();
  const auto colorsOf = [&](std::uint64_t seed) {
    std::vector<sensors::Rgb> colors;
    for (const auto& surface : shellOf(building, seed)) colors.push_back(surface.material.color);
    return colors;
  };
  EXPECT_EQ(colorsOf(1), colorsOf(1));
  EXPECT_NE(colorsOf(1), colorsOf(2));
}

TEST(Shell, StepsLieWhereTheFlightSaysAndLeadThroughAHoleInTheFloor) {
  const auto building = schoolOf({.seed = 3, .storeys = 2});
  ASSERT_FALSE(building.stairs.empty());
  const auto surfaces = shellOf(building, kSeed);
  for (std::size_t i = 0; i < building.stairs.size(); ++i) {
    const auto& stairs = building.stairs[i];
    const Eigen::Vector3d ahead(std::cos(stairs.direction), std::sin(stairs.direction), 0.0);
    // From just above the upper floor down onto each tread.
    const double above = building.storeys[1].floor_z + 0.1;
    for (int step = 0; step + 1 < stairs.stepCount; ++step) {
      Eigen::Vector3d origin = stairs.foot + (step + 0.5) * stairs.stepDepth * ahead;
      origin.z() = above;
      const auto hit = castBruteForce(surfaces, origin, -Eigen::Vector3d::UnitZ());
      ASSERT_TRUE(hit);
      EXPECT_TRUE(isA(surfaces[hit->surface], "stairs"));
      EXPECT_EQ(surfaces[hit->surface].instance, stairsInstance(building, i));
      EXPECT_NEAR(above - hit->distance, stairs.foot.z() + (step + 1) * stairs.stepHeight, 1e-4);
    }
  }
}

TEST(Shell, ARailingKeepsPeopleFromTheHoleInTheUpperFloor) {
  const auto building = schoolOf({.seed = 3, .storeys = 2});
  const auto rails = only(shellOf(building, kSeed), "handrail");
  ASSERT_FALSE(rails.empty());
  const float floor_z = static_cast<float>(building.storeys[1].floor_z);
  float highest = 0.0F;
  for (const auto& rail : rails) {
    for (const auto& vertex : rail.vertices) highest = std::max(highest, vertex.z() - floor_z);
  }
  EXPECT_NEAR(highest, 0.95F, 0.05F);
}

TEST(Shell, AStairwellOfASingleStoreyIsClosedAbove) {
  auto building = schoolOf({.seed = 3, .storeys = 1});
  closeDoors(building);
  ASSERT_FALSE(building.stairs.empty());
  const auto surfaces = allSurfaces(building);
  const auto& stairs = building.stairs.front();
  const Eigen::Vector3d origin = (stairs.foot + headOf(stairs)) / 2.0 + Eigen::Vector3d(0.0, 0.0, 1.2);
  base::Random random(4, "rays");
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d direction(random.normal(0.0, 1.0), random.normal(0.0, 1.0), random.normal(0.0, 1.0));
    ASSERT_TRUE(castBruteForce(surfaces, origin, direction)) << direction.transpose();
  }
}

TEST(Shell, ASchoolIsTight) {
  auto building = schoolOf({.seed = 9, .storeys = 2});
  closeDoors(building);
  expectTight(building, 180);
}

TEST(Shell, PlansOfTheDataSetAreTight) {
  for (const char* name : {"school/Lamuniere1_updated.xml", "school/Borchen4_updated.xml"}) {
    const auto plan = test::dataset(std::string("buildings/plans/") + name);
    if (!plan) GTEST_SKIP() << "needs buildings/plans";
    auto building = readFloorPlan(*plan, {.seed = 4});
    closeDoors(building);
    expectTight(building, 120);
  }
}

}  // namespace
}  // namespace prodomos::simulation

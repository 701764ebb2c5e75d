// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/world_file.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/simulation/shell.hpp"

#include "simulation/surface_tools.hpp"
#include "support/datasets.hpp"
#include "tiny_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace prodomos::simulation {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

std::string faultOf(const std::filesystem::path& world, const WorldOptions& options = {}) {
  try {
    readWorld(world, options);
  } catch (const base::Error& error) {
    return error.what();
  }
  return "none";
}

Eigen::Vector2d beside(const Door& door, double offset) {
  const auto pose = door.pose * geometry::Pose2{offset, 0.0, 0.0};
  return {pose.x, pose.y};
}

/// What every building must be like, whatever it was read from.
void expectSound(const Building& building) {
  for (const auto& room : building.rooms) {
    EXPECT_GT(signedArea(room.outline), 0.0) << room.id;
    EXPECT_FALSE(findSelfCrossing(room.outline)) << room.id;
    EXPECT_EQ(room.use, useOfLabel(room.label)) << room.id << " " << room.label;
  }
  for (const auto& door : building.doors) {
    EXPECT_NE(door.rooms[0], door.rooms[1]) << door.id;
    EXPECT_EQ(roomAt(building, door.storey, beside(door, -0.3)), door.rooms[0]) << door.id;
    EXPECT_EQ(roomAt(building, door.storey, beside(door, 0.3)), door.rooms[1]) << door.id;
  }
  for (const auto& surface : building.imported) {
    for (const auto& triangle : surface.triangles) {
      for (const auto index : triangle) ASSERT_LT(index, surface.vertices.size());
    }
    EXPECT_TRUE(surface.textureCoordinates.empty() || surface.textureCoordinates.size() == surface.vertices.size());
    EXPECT_LT(surface.material.texture, static_cast<int>(building.textures.size()));
  }
}

/// Points of one storey that lie in more than one room, of a grid of 0.25 m.
int countShared(const Building& building, int storey, const Eigen::AlignedBox2d& area) {
  int shared = 0;
  for (double x = area.min().x(); x < area.max().x(); x += 0.25) {
    for (double y = area.min().y(); y < area.max().y(); y += 0.25) {
      shared += std::ranges::count_if(building.rooms, [&](const Room& room) {
                  return room.storey == storey && contains(room.outline, {x, y});
                }) > 1;
    }
  }
  return shared;
}

bool isCovered(const Building& building, std::string_view className, const Eigen::Vector3d& point) {
  for (const auto& surface : building.imported) {
    if (surface.classId != classId(className)) continue;
    for (const auto& triangle : surface.triangles) {
      Polygon corners;
      bool isThere = true;
      for (const auto index : triangle) {
        corners.emplace_back(surface.vertices[index].head<2>().cast<double>());
        isThere = isThere && std::abs(static_cast<double>(surface.vertices[index].z()) - point.z()) < 0.05;
      }
      if (isThere && contains(corners, point.head<2>())) return true;
    }
  }
  return false;
}

TEST(WorldFile, ATinyHouseHasTheRoomsAndTheDoorOfItsMeshes) {
  const test::TemporaryFolder folder;
  const auto building = readWorld(test::writeTinyWorld(folder, test::tinyStorey(0.0)));
  expectSound(building);
  EXPECT_EQ(building.name, "tiny");
  ASSERT_EQ(building.storeys.size(), 1U);
  EXPECT_NEAR(building.storeys[0].ceilingHeight, 2.98, 1e-3);
  ASSERT_EQ(building.rooms.size(), 2U);
  EXPECT_NEAR(signedArea(building.rooms[0].outline), 12.0, 0.01);
  EXPECT_NEAR(signedArea(building.rooms[1].outline), 5.88 * 3.0, 0.01);
  EXPECT_EQ(building.rooms[1].use, RoomUse::kStairs);
  ASSERT_EQ(building.doors.size(), 1U);
  const auto& door = building.doors[0];
  EXPECT_NEAR(door.pose.x, 4.06, 0.005);
  EXPECT_NEAR(door.pose.y, 1.5, 0.005);
  EXPECT_NEAR(door.width, 0.93, 1e-3);
  EXPECT_NEAR(door.height, 2.065, 1e-3);
  EXPECT_NEAR(door.wallThickness, 0.12, 0.01);
  EXPECT_EQ(door.leaves, 1);
  EXPECT_FALSE(building.rooms[0].furnished);
}

TEST(WorldFile, StairsLeadThroughTheCeilingToTheNextStorey) {
  const test::TemporaryFolder folder;
  // The lowest floor need not lie at 0 in the file.
  const auto building = readWorld(test::writeTinyWorld(folder, test::tinyStorey(7.0) + test::tinyStorey(10.0)));
  expectSound(building);
  ASSERT_EQ(building.storeys.size(), 2U);
  EXPECT_NEAR(building.storeys[0].floor_z, 0.0, 1e-9);
  EXPECT_NEAR(building.storeys[1].floor_z, 3.0, 1e-9);
  ASSERT_EQ(building.stairs.size(), 2U);
  const auto& stairs = building.stairs[0];
  EXPECT_EQ(stairs.id, "s0.0");
  EXPECT_EQ(stairs.upperStorey, 1);
  EXPECT_EQ(building.rooms[static_cast<std::size_t>(stairs.rooms[0])].storey, 0);
  EXPECT_EQ(building.rooms[static_cast<std::size_t>(stairs.rooms[1])].storey, 1);
  EXPECT_NEAR(headOf(stairs).z(), building.storeys[1].floor_z, 1e-3);
  // Above the flight neither ceiling nor floor, beside it both; the highest ceiling opens into a well.
  EXPECT_FALSE(isCovered(building, "ceiling", {7.0, 2.4, 2.98}));
  EXPECT_FALSE(isCovered(building, "floor", {7.0, 2.4, 3.0}));
  EXPECT_TRUE(isCovered(building, "ceiling", {7.0, 1.0, 2.98}));
  EXPECT_TRUE(isCovered(building, "floor", {7.0, 1.0, 3.0}));
  EXPECT_EQ(building.stairs[1].upperStorey, 2);
  EXPECT_EQ(building.stairs[1].rooms[1], kOutside);
  EXPECT_FALSE(isCovered(building, "ceiling", {7.0, 2.4, 5.98}));
}

TEST(WorldFile, AFlightDownFromTheLowestStoreyEndsInAWell) {
  const test::TemporaryFolder folder;
  const auto world = test::writeTinyWorld(folder, test::tinyStorey(0.0) + test::tinyStorey(3.0));
  auto parts = test::tinyWalls();
  parts.back().second = test::moved({5.5, 2.4, -3.0}, test::flight(15, 0.25, 0.2, 1.0));
  folder.write("house_walls_visual.dae", test::collada(parts));
  folder.write("house_floor_visual.dae",
               test::collada({{"house_floor_visual", cutAway(test::level(0.0), {Eigen::Vector3d(5.5, 1.9, -1),
                                                                                Eigen::Vector3d(9.25, 2.9, 1)})}}));
  const auto building = readWorld(world);
  ASSERT_EQ(building.stairs.size(), 1U);
  EXPECT_EQ(building.stairs[0].lowerStorey, -1);
  EXPECT_EQ(building.stairs[0].upperStorey, 0);
  EXPECT_NEAR(building.stairs[0].foot.z(), -3.0, 1e-6);
  EXPECT_TRUE(isCovered(building, "floor", {7.0, 2.4, -3.0}));
  EXPECT_FALSE(isCovered(building, "floor", {7.0, 2.4, 0.0}));
  EXPECT_TRUE(isCovered(building, "floor", {7.0, 2.4, 3.0}));
  EXPECT_THAT(building.remarks, Contains(HasSubstr("a flight down from storey 1 is left out")));
}

TEST(WorldFile, ModelsWithoutMeshesAreStoodInFor) {
  const test::TemporaryFolder folder;
  const auto building = readWorld(test::writeTinyWorld(
      folder, test::tinyStorey(0.0) + test::included("Chair", "1 1 0 0 0 0") + test::included("Rocket", "2 1 0 0 0 0") +
                  test::included("TrolleyBed", "2 2 -7.6e8 0 0 0") + test::included("sun", "0 0 0 0 0 0")));
  ASSERT_EQ(building.things.size(), 2U);
  EXPECT_EQ(building.things[0].kind, "chair");
  EXPECT_NEAR(building.things[1].T_world_thing.translation().z(), building.things[1].size.z() / 2.0, 1e-9);
  EXPECT_THAT(building.remarks, Contains(HasSubstr("Rocket has neither a mesh nor a stand-in")));
  EXPECT_THAT(building.remarks, Contains(HasSubstr("TrolleyBed_1 lies at z = -760000000 m: put on the floor")));
  EXPECT_TRUE(building.rooms[0].furnished);
  EXPECT_EQ(building.rooms[0].label, "WARD");
}

TEST(WorldFile, StoreysMayBeLimited) {
  const test::TemporaryFolder folder;
  const auto world = test::writeTinyWorld(folder, test::tinyStorey(0.0) + test::included("Chair", "1 1 0 0 0 0") +
                                                      test::tinyStorey(3.0) + test::included("Chair", "1 1 3 0 0 0") +
                                                      test::included("TrolleyBed", "2 2 -7.6e8 0 0 0"));
  EXPECT_EQ(readWorld(world).things.size(), 3U);
  const auto lowest = readWorld(world, {.storeys = 1});
  EXPECT_EQ(lowest.storeys.size(), 1U);
  EXPECT_EQ(lowest.things.size(), 1U);
  EXPECT_THAT(faultOf(world, {.storeys = 3}), HasSubstr("storeys: expected at most 2"));
  EXPECT_THAT(faultOf(world, {.storeys = -1}), HasSubstr("storeys: expected 0 (all) or more, found -1"));
}

TEST(WorldFile, OfAFolderTheWorldThatFitsIsRead) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(isWorld(folder.path()));
  EXPECT_THAT(faultOf(folder.path()), HasSubstr("expected a Gazebo world (*.world) in the folder, found none"));
  test::writeTinyWorld(folder, test::tinyStorey(0.0) + test::tinyStorey(3.0), "a.world");
  test::writeTinyWorld(folder, test::tinyStorey(0.0), "b.world");
  EXPECT_TRUE(isWorld(folder.path()));
  EXPECT_EQ(readWorld(folder.path()).name, "b");
  EXPECT_EQ(readWorld(folder.path(), {.storeys = 2}).name, "a");
}

TEST(WorldFile, BadInputIsNamed) {
  const test::TemporaryFolder folder;
  const auto world = test::writeTinyWorld(folder, test::tinyStorey(0.0));
  EXPECT_THAT(faultOf(folder.write("empty.world", test::worldText(""))),
              HasSubstr("empty.world: expected a model NAME_floor"));
  const auto floorOnly = folder.write("f.world", test::worldText(test::included("house_floor", "0 0 0 0 0 0")));
  EXPECT_THAT(faultOf(floorOnly), HasSubstr("f.world: expected walls on every storey, found none"));
  EXPECT_THAT(faultOf(folder.write("n.world", "not XML")), HasSubstr("n.world: expected a Gazebo world (XML)"));
  std::filesystem::remove(folder.path() / "house_walls_visual.dae");
  EXPECT_THAT(faultOf(world), HasSubstr("house_walls_visual.dae: expected a COLLADA mesh, found no such file"));
  folder.write("house_walls_visual.dae", test::collada(test::tinyWalls(), ""));
  EXPECT_THAT(faultOf(world), HasSubstr("expected the mesh's unit"));
  folder.write("house_walls_visual.dae", test::collada(test::tinyWalls()).substr(0, 5000));
  EXPECT_THAT(faultOf(world), HasSubstr("house_walls_visual.dae: expected a COLLADA mesh, found"));
}

TEST(WorldFile, TheSameSeedGivesTheSameDoors) {
  const test::TemporaryFolder folder;
  const auto world = test::writeTinyWorld(folder, test::tinyStorey(0.0));
  std::set<double> angles;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const auto one = readWorld(world, {.seed = seed});
    const auto two = readWorld(world, {.seed = seed});
    EXPECT_EQ(openingAngle(one.doors[0], 0.0), openingAngle(two.doors[0], 0.0));
    EXPECT_EQ(one.doors[0].hingeSide, two.doors[0].hingeSide);
    angles.insert(openingAngle(one.doors[0], 0.0));
  }
  EXPECT_GT(angles.size(), 1U);
}

class Hospital : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    const auto folder = test::dataset("buildings/hospital");
    if (!folder) GTEST_SKIP() << "needs buildings/hospital";
    building_ = read(*folder, GetParam());
  }

  /// Once for all tests.
  static const Building& read(const std::filesystem::path& folder, int storeys) {
    static std::map<int, Building> known;
    const auto entry = known.find(storeys);
    if (entry != known.end()) return entry->second;
    return known[storeys] = readWorld(folder, {.seed = 1, .storeys = storeys});
  }

  Building building_;
};

TEST_P(Hospital, IsSoundAndOfItsKnownSize) {
  expectSound(building_);
  ASSERT_EQ(building_.storeys.size(), static_cast<std::size_t>(GetParam()));
  Eigen::AlignedBox3f floor;
  for (const auto& surface : building_.imported) {
    if (surface.classId == classId("floor") && surface.vertices.size() > 20) floor.extend(boundsOf(surface));
  }
  EXPECT_NEAR(floor.sizes().x(), 25.0F, 0.1F);
  EXPECT_NEAR(floor.sizes().y(), 56.0F, 0.1F);
  for (std::size_t k = 0; k < building_.storeys.size(); ++k) {
    EXPECT_NEAR(building_.storeys[k].floor_z, 3.0 * static_cast<double>(k), 1e-6);
    EXPECT_NEAR(building_.storeys[k].ceilingHeight, 2.98, 1e-3);
    EXPECT_EQ(countShared(building_, static_cast<int>(k), {Eigen::Vector2d(-12.6, -35.1), Eigen::Vector2d(12.6, 21.1)}),
              0);
  }
}

TEST_P(Hospital, EveryStoreyHasItsDoorsRoomsAndLifts) {
  for (int k = 0; k < GetParam(); ++k) {
    const auto count = [&](double least, double most) {
      return std::ranges::count_if(building_.doors, [&](const Door& door) {
        return door.storey == k && !isLiftDoor(building_, door) && door.width > least && door.width < most;
      });
    };
    EXPECT_EQ(count(0.9, 1.0), 18);
    EXPECT_EQ(count(1.4, 1.6), 8);
    double area = 0.0;
    int rooms = 0;
    for (const auto& room : building_.rooms) {
      if (room.storey != k) continue;
      ++rooms;
      area += signedArea(room.outline);
      EXPECT_TRUE(std::ranges::any_of(building_.doors,
                                      [&](const Door& door) {
                                        return &building_.rooms[static_cast<std::size_t>(door.rooms[0])] == &room ||
                                               &building_.rooms[static_cast<std::size_t>(door.rooms[1])] == &room;
                                      }))
          << room.id << " has no door";
    }
    EXPECT_EQ(rooms, 27);
    EXPECT_GT(area, 0.9 * 56.0 * 25.0);
    EXPECT_LT(area, 56.0 * 25.0);
  }
  ASSERT_EQ(building_.lifts.size(), 2U);
  for (const auto& lift : building_.lifts) EXPECT_EQ(lift.rooms.size(), building_.storeys.size());
  for (const auto& door : building_.doors) EXPECT_NE(door.rooms[1], kOutside) << door.id;
}

TEST_P(Hospital, BothStairwellsJoinItsStoreys) {
  for (const auto& stairs : building_.stairs) {
    EXPECT_NEAR(stairs.stepHeight, 0.20, 0.005) << stairs.id;
    EXPECT_NEAR(stairs.stepDepth, 0.267, 0.005) << stairs.id;
    EXPECT_EQ(stairs.stepCount, 15) << stairs.id;
    EXPECT_NEAR(headOf(stairs).z(), 3.0 * stairs.upperStorey, 0.005) << stairs.id;
    EXPECT_NEAR(stairs.foot.z(), 3.0 * stairs.lowerStorey, 0.005) << stairs.id;
    for (const int end : {0, 1}) {
      const int storey = end == 0 ? stairs.lowerStorey : stairs.upperStorey;
      const bool isModelled = storey >= 0 && storey < GetParam();
      const int room = stairs.rooms[static_cast<std::size_t>(end)];
      ASSERT_EQ(room != kOutside, isModelled) << stairs.id;
      if (!isModelled) continue;
      EXPECT_EQ(building_.rooms[static_cast<std::size_t>(room)].use, RoomUse::kStairs) << stairs.id;
    }
    if (stairs.upperStorey == 0 || stairs.upperStorey == GetParam()) continue;
    // One who comes up finds the ceiling and the floor open, a landing, and a way round to the flight's side.
    const Eigen::Vector3d middle = (stairs.foot + headOf(stairs)) / 2.0;
    EXPECT_FALSE(isCovered(building_, "floor", {middle.x(), middle.y(), headOf(stairs).z()})) << stairs.id;
    EXPECT_FALSE(isCovered(building_, "ceiling", {middle.x(), middle.y(), headOf(stairs).z() - 0.02})) << stairs.id;
    EXPECT_TRUE(isCovered(building_, "floor", {middle.x(), 18.0, headOf(stairs).z()})) << stairs.id;
    const double landing_x = headOf(stairs).x() + 1.5 * std::cos(stairs.direction);
    EXPECT_EQ(roomAt(building_, stairs.upperStorey, {landing_x, 19.0}), stairs.rooms[1]) << stairs.id;
  }
  EXPECT_EQ(building_.stairs.size(), 2U + 2U * static_cast<std::size_t>(GetParam()));
}

TEST_P(Hospital, AClosedLeafFillsItsFrame) {
  for (auto& door : building_.doors) door.swings.clear();
  for (std::size_t i = 0; i < building_.doors.size(); ++i) {
    const auto& door = building_.doors[i];
    if (isLiftDoor(building_, door)) continue;
    Eigen::AlignedBox3f leaf;
    for (const auto& surface : leavesAt(building_, i, 0.0, 1)) {
      if (surface.vertices.size() < 4) continue;
      const auto T_door_world =
          geometry::toPose3(door.pose, building_.storeys[static_cast<std::size_t>(door.storey)].floor_z).inverse();
      leaf.extend(boundsOf(transformed(T_door_world, surface)));
    }
    EXPECT_NEAR(leaf.sizes().y(), door.width, 0.02) << door.id;
    EXPECT_NEAR(leaf.max().z(), door.height, 0.02) << door.id;
    EXPECT_NEAR(leaf.min().z(), 0.0, 0.02) << door.id;
  }
}

TEST_P(Hospital, FurnitureAndPeopleAreInItsRooms) {
  EXPECT_GT(building_.things.size(), 140U * static_cast<std::size_t>(GetParam()));
  EXPECT_EQ(building_.people.size(), 15U * static_cast<std::size_t>(GetParam()));
  for (const auto& thing : building_.things) {
    const Eigen::Vector2d position = thing.T_world_thing.translation().head<2>();
    EXPECT_NE(roomAt(building_, thing.storey, position), kOutside) << thing.id << " " << thing.kind;
  }
  for (const auto& person : building_.people) {
    EXPECT_NE(roomAt(building_, person.storey, person.way[0].position), kOutside) << person.id;
  }
}

INSTANTIATE_TEST_SUITE_P(Storeys, Hospital, ::testing::Values(1, 2, 3));

}  // namespace
}  // namespace prodomos::simulation

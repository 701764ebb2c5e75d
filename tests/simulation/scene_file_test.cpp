// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/scene_file.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/simulation/furniture.hpp"

#include "simulation/scenes/scene_geometry.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

namespace prodomos::simulation {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

constexpr double kDegree = std::numbers::pi / 180.0;

Building read(const std::string& text, std::uint64_t seed = 1) {
  const test::TemporaryFolder folder;
  return readSceneFile(folder.write("test.scene.yaml", text), seed);
}

std::vector<std::string> faultsOf(const std::string& text) {
  try {
    read(text);
  } catch (const base::UsageError& error) {
    return error.faults();
  }
  return {};
}

std::filesystem::path sample(const std::string& name) {
  return std::filesystem::path(__FILE__).parent_path() / "../../configs" / (name + ".scene.yaml");
}

/// Two rooms side by side; what is added stands in their storey.
std::string twoRooms(const std::string& more) {
  return R"(scene: two rooms
wall_thickness: 0.2
storeys:
  - height: 2.8
    rooms:
      - {id: hall, label: HALL, rectangle: [0, 0, 4, 5]}
      - {id: office, label: OFFICE, rectangle: [4, 0, 8, 5]}
)" + more;
}

/// A hall of one floor and of the next.
std::string twoStoreys(const std::string& stairs) {
  return R"(scene: two storeys
floor_thickness: 0.3
storeys:
  - rooms: [{id: hall, label: HALL, rectangle: [0, 0, 9, 3]}]
    stairs: [)" +
         stairs + R"(]
  - rooms: [{id: landing, label: HALL, rectangle: [0, 0, 9, 3]}]
)";
}

const Door& onlyDoor(const Building& building) {
  EXPECT_THAT(building.doors, SizeIs(1));
  return building.doors.at(0);
}

TEST(SceneFile, IsKnownByItsFirstKey) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(isSceneFile(folder.write("a", "# a comment\n\n---\nscene: x\n")));
  EXPECT_TRUE(isSceneFile(folder.write("b", "scene: x")));
  EXPECT_FALSE(isSceneFile(folder.write("c", "grid:\n  scene: x\n")));
  EXPECT_FALSE(isSceneFile(folder.write("d", "")));
  EXPECT_FALSE(isSceneFile(folder.write("e", std::string("\x1f\x8b\0\0", 4))));
  EXPECT_FALSE(isSceneFile(folder.path()));
  EXPECT_FALSE(isSceneFile(folder.path() / "none"));
}

TEST(SceneFile, WhatCannotBeReadIsAFileError) {
  EXPECT_THROW(readSceneFile("/nowhere/x.scene.yaml", 1), base::FileError);
  try {
    read("scene: x\nstoreys: [\n");
    FAIL() << "read";
  } catch (const base::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("test.scene.yaml:"));
  }
}

TEST(SceneFile, RoomsEndAtTheFacesOfTheirWalls) {
  const auto building = read(R"(scene: rooms
wall_thickness: 0.2
storeys:
  - rooms:
      - {id: a, label: OFFICE, rectangle: [0, 0, 4, 3]}
      - {id: b, label: CORRIDOR, polygon: [[4, 0], [4, 3], [2, 3], [2, 5], [7, 5], [7, 2.5], [7, 0]]}
)");
  ASSERT_THAT(building.rooms, SizeIs(2));
  EXPECT_NEAR(signedArea(building.rooms[0].outline), 3.8 * 2.8, 1e-9);
  EXPECT_TRUE(building.rooms[0].outline[0].isApprox(Eigen::Vector2d(0.1, 0.1)));
  EXPECT_EQ(building.rooms[0].use, RoomUse::kRoom);
  EXPECT_EQ(building.rooms[1].use, RoomUse::kCorridor);
  // Given clockwise, with a corner that is none, and with one that turns inwards.
  EXPECT_THAT(building.rooms[1].outline, SizeIs(6));
  EXPECT_NEAR(signedArea(building.rooms[1].outline), 4.8 * 4.8 - 2.0 * 3.0, 1e-9);
}

TEST(SceneFile, StoreysStandOnEachOther) {
  const auto building = read(R"(scene: storeys
floor_thickness: 0.4
storeys:
  - {height: 3, rooms: [{id: a, label: OFFICE, rectangle: [0, 0, 4, 3]}]}
  - {rooms: [{id: b, label: OFFICE, rectangle: [0, 0, 4, 3]}]}
)");
  ASSERT_THAT(building.storeys, SizeIs(2));
  EXPECT_DOUBLE_EQ(building.storeys[0].floor_z, 0.0);
  EXPECT_DOUBLE_EQ(building.storeys[1].floor_z, 3.4);
  EXPECT_DOUBLE_EQ(building.storeys[1].ceilingHeight, 2.8);
  EXPECT_EQ(building.rooms[1].storey, 1);
}

TEST(SceneFile, ADoorsAxisPointsFromItsFirstRoomIntoItsSecond) {
  const auto forth = read(twoRooms("    doors: [{id: d, rooms: [hall, office], at: [4.05, 2], hinge: left}]\n"));
  EXPECT_NEAR(onlyDoor(forth).pose.x, 4.0, 1e-9);
  EXPECT_NEAR(onlyDoor(forth).pose.y, 2.0, 1e-9);
  EXPECT_NEAR(onlyDoor(forth).pose.theta, 0.0, 1e-9);
  EXPECT_THAT(onlyDoor(forth).rooms, ElementsAre(0, 1));
  EXPECT_DOUBLE_EQ(onlyDoor(forth).wallThickness, 0.2);
  EXPECT_EQ(onlyDoor(forth).hingeSide, map::HingeSide::kLeft);
  EXPECT_TRUE(onlyDoor(forth).opensAlongNormal) << "out of the hall";

  const auto back =
      read(twoRooms("    doors: [{id: d, rooms: [office, hall], at: [4, 2], opens_into: hall, hinge: right, width: "
                    "1.1, height: 2}]\n"));
  EXPECT_NEAR(std::abs(onlyDoor(back).pose.theta), std::numbers::pi, 1e-9);
  EXPECT_TRUE(onlyDoor(back).opensAlongNormal);
  EXPECT_DOUBLE_EQ(onlyDoor(back).width, 1.1);
  EXPECT_DOUBLE_EQ(onlyDoor(back).height, 2.0);
  EXPECT_EQ(onlyDoor(back).hingeSide, map::HingeSide::kRight);
}

TEST(SceneFile, ADoorMayLeadOutside) {
  const auto out = read(twoRooms("    doors: [{id: d, rooms: [hall, outside], at: [0, 2], opens_into: hall}]\n"));
  EXPECT_THAT(onlyDoor(out).rooms, ElementsAre(0, kOutside));
  EXPECT_NEAR(std::abs(onlyDoor(out).pose.theta), std::numbers::pi, 1e-9);
  EXPECT_FALSE(onlyDoor(out).opensAlongNormal);
  const auto in = read(twoRooms("    doors: [{id: d, rooms: [outside, hall], at: [0, 2], leaves: 2}]\n"));
  EXPECT_NEAR(onlyDoor(in).pose.theta, 0.0, 1e-9);
  EXPECT_EQ(onlyDoor(in).leaves, 2);
  EXPECT_DOUBLE_EQ(onlyDoor(in).width, 1.6);
}

TEST(SceneFile, ALeafTurnsAtTheTimesGiven) {
  const auto stateAt = [](const Building& building, double time) {
    return stateOf(openingAngle(onlyDoor(building), time));
  };
  const std::string door = "    doors: [{id: d, rooms: [hall, office], at: [4, 2], state: ";
  EXPECT_EQ(stateAt(read(twoRooms(door + "closed}]\n")), 0.0), map::DoorState::kClosed);
  EXPECT_EQ(stateAt(read(twoRooms(door + "ajar}]\n")), 50.0), map::DoorState::kAjar);
  EXPECT_EQ(stateAt(read(twoRooms(door + "open}]\n")), 50.0), map::DoorState::kOpen);
  const auto later = read(twoRooms(door + "{20: open, 40: ajar, 60: closed}}]\n"));
  EXPECT_EQ(stateAt(later, 0.0), map::DoorState::kClosed);
  EXPECT_EQ(stateAt(later, 20.0), map::DoorState::kClosed);
  EXPECT_NEAR(openingAngle(onlyDoor(later), 21.0), 45.0 * kDegree, 1e-9);
  EXPECT_EQ(stateAt(later, 22.0), map::DoorState::kOpen);
  EXPECT_EQ(stateAt(later, 40.0), map::DoorState::kOpen);
  EXPECT_EQ(stateAt(later, 42.1), map::DoorState::kAjar);
  EXPECT_EQ(stateAt(later, 62.0), map::DoorState::kClosed);
  const auto open = read(twoRooms(door + "{0: open, 10: closed}}]\n"));
  EXPECT_EQ(stateAt(open, 0.0), map::DoorState::kOpen);
  EXPECT_EQ(stateAt(open, 12.0), map::DoorState::kClosed);
}

TEST(SceneFile, WhatADoorDoesNotSayIsDrawnBySeed) {
  std::set<map::DoorState> states;
  std::set<map::HingeSide> sides;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const auto building = read(twoRooms("    doors: [{id: d, rooms: [hall, office], at: [4, 2]}]\n"), seed);
    states.insert(stateOf(openingAngle(onlyDoor(building), 0.0)));
    sides.insert(onlyDoor(building).hingeSide);
  }
  EXPECT_THAT(states, SizeIs(3));
  EXPECT_THAT(sides, SizeIs(2));
}

TEST(SceneFile, StairsUpEndOnTheNextStorey) {
  const auto building =
      read(twoStoreys("{id: s, goes: up, at: [2, 1], heading: 0, width: 1, steps: 17, step_depth: 0.28}"));
  ASSERT_THAT(building.stairs, SizeIs(1));
  const auto& stairs = building.stairs[0];
  EXPECT_TRUE(stairs.foot.isApprox(Eigen::Vector3d(2.0, 1.0, 0.0)));
  EXPECT_NEAR(headOf(stairs).z(), 3.1, 1e-9);
  EXPECT_NEAR(headOf(stairs).x(), 2.0 + 16 * 0.28, 1e-9);
  EXPECT_THAT(stairs.rooms, ElementsAre(0, 1));
  EXPECT_EQ(stairs.lowerStorey, 0);
  EXPECT_EQ(stairs.upperStorey, 1);
}

TEST(SceneFile, StairsDownToAStoreyThatIsNotDrawnBeginAtTheFloor) {
  const auto building = read(R"(scene: cellar
storeys:
  - rooms: [{id: hall, label: HALL, rectangle: [0, 0, 9, 3]}]
    stairs: [{id: s, goes: down, at: [2, 1.5], heading: 0, steps: 10, step_height: 0.2, step_depth: 0.25}]
)");
  ASSERT_THAT(building.stairs, SizeIs(1));
  const auto& stairs = building.stairs[0];
  EXPECT_NEAR((headOf(stairs) - Eigen::Vector3d(2.0, 1.5, 0.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(stairs.foot.z(), -2.0, 1e-9);
  EXPECT_NEAR(stairs.foot.x(), 2.0 + 9 * 0.25, 1e-9) << "one walks eastwards, downhill";
  EXPECT_NEAR(std::abs(stairs.direction), std::numbers::pi, 1e-9) << "uphill is west";
  EXPECT_EQ(stairs.lowerStorey, -1);
  EXPECT_EQ(stairs.upperStorey, 0);
  EXPECT_THAT(stairs.rooms, ElementsAre(kOutside, 0));
}

TEST(SceneFile, ALiftJoinsRoomsOneAboveTheOther) {
  const auto building = read(R"(scene: lift
storeys:
  - rooms: [{id: low, label: ELEVATOR, rectangle: [0, 0, 2, 2]}]
  - rooms: [{id: high, label: ELEVATOR, rectangle: [0, 0, 2, 2]}]
lifts: [{id: lift, rooms: [low, high]}]
)");
  ASSERT_THAT(building.lifts, SizeIs(1));
  EXPECT_THAT(building.lifts[0].rooms, ElementsAre(0, 1));
  EXPECT_NEAR(signedArea(building.lifts[0].outline), 1.8 * 1.8, 1e-9);
}

TEST(SceneFile, FurnitureStandsWhereItIsPutAndWhatHangsIsDrawnToTheWall) {
  const auto building = read(twoRooms(R"(    furniture:
      - {kind: desk, at: [2, 2], yaw: 90, size: [0.8, 1.6, 0.75]}
      - {kind: noticeboard, at: [3.7, 4], z: 0.5, size: [0.04, 1, 1.2]}
)"));
  ASSERT_THAT(building.things, SizeIs(2));
  const auto& desk = building.things[0];
  EXPECT_TRUE(desk.T_world_thing.translation().isApprox(Eigen::Vector3d(2.0, 2.0, 0.375)));
  EXPECT_NEAR(geometry::yaw(desk.T_world_thing), 90.0 * kDegree, 1e-9);
  const auto& board = building.things[1];
  EXPECT_TRUE(board.T_world_thing.translation().isApprox(Eigen::Vector3d(3.88, 4.0, 1.1)));
  EXPECT_NEAR(std::abs(geometry::yaw(board.T_world_thing)), std::numbers::pi, 1e-9) << "it looks into the hall";
  EXPECT_TRUE(building.rooms[0].furnished);
  EXPECT_FALSE(building.rooms[1].furnished);
}

TEST(SceneFile, PeopleWalkAtTheirSpeedThroughOpenDoors) {
  const auto building = read(twoRooms(R"(    doors: [{id: d, rooms: [hall, office], at: [4, 2]}]
    people:
      - {id: a, path: [[2, 2], [6, 2], [6, 3, 20]], speed: 0.5, start: 3}
      - {id: b, at: [1, 4], yaw: 90, sits: true, height: 1.6}
)"));
  ASSERT_THAT(building.people, SizeIs(2));
  const auto& walker = building.people[0];
  ASSERT_THAT(walker.way, SizeIs(3));
  EXPECT_DOUBLE_EQ(walker.way[0].time, 3.0);
  EXPECT_DOUBLE_EQ(walker.way[1].time, 11.0);
  EXPECT_DOUBLE_EQ(walker.way[2].time, 20.0);
  EXPECT_EQ(stateOf(openingAngle(onlyDoor(building), 0.0)), map::DoorState::kOpen) << "someone passes it";
  const auto& sitter = building.people[1];
  EXPECT_TRUE(sitter.sits);
  EXPECT_NEAR(sitter.heading, 90.0 * kDegree, 1e-9);
  ASSERT_THAT(building.things, SizeIs(1)) << "a chair to sit on";
  EXPECT_EQ(building.things[0].kind, "chair");
}

TEST(SceneFile, PeopleMayWalkToAndFro) {
  const auto building =
      read(twoRooms("    people: [{id: a, path: [[1, 1], [2, 1], [2, 2, 8]], speed: 1, to_and_fro_until: 20}]\n"));
  const auto& way = building.people[0].way;
  ASSERT_GE(way.back().time, 20.0);
  EXPECT_DOUBLE_EQ(way[3].time, 15.0) << "back as fast as forth";
  EXPECT_TRUE(way[4].position.isApprox(Eigen::Vector2d(1, 1)));
  EXPECT_DOUBLE_EQ(way[4].time, 16.0);
  for (std::size_t i = 1; i < way.size(); ++i) EXPECT_GE(way[i].time, way[i - 1].time);
}

TEST(SceneFile, LightIsAsGiven) {
  const auto building = read(R"(scene: light
lighting: {brightness: 0.5, ambient: 0.2, tint: [1, 0.9, 0.8]}
storeys:
  - lamps: [[1, 1], [3, 1]]
    rooms: [{id: hall, label: HALL, rectangle: [0, 0, 4, 5]}]
)");
  EXPECT_DOUBLE_EQ(building.lighting.brightness, 0.5);
  EXPECT_FLOAT_EQ(building.lighting.tint.z(), 0.8F);
  ASSERT_THAT(building.lighting.lamps, SizeIs(2));
  EXPECT_TRUE(building.lighting.lamps[0].isApprox(Eigen::Vector3d(1, 1, 2.65)));
}

// Faults.

/// All lines of the text below that are marked with "#!".
std::set<int> markedLines(const std::string& text) {
  std::set<int> marked;
  int line = 1;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') ++line;
    if (text.compare(i, 2, "#!") == 0) marked.insert(line);
  }
  return marked;
}

std::set<int> faultyLines(const std::vector<std::string>& faults) {
  std::set<int> lines;
  for (const auto& fault : faults) {
    const auto at = fault.find(".yaml:");
    EXPECT_NE(at, std::string::npos) << fault;
    EXPECT_THAT(fault, AllOf(HasSubstr("expected "), HasSubstr("found ")));
    lines.insert(std::stoi(fault.substr(at + 6)));
  }
  return lines;
}

TEST(SceneFile, AllFaultsAreNamedAtOnceEachWithItsLine) {
  const std::string text = R"(scene: faulty
wall_thickness: thick         #! not a number
colour: red                   #! no such key
storeys:
  - height: 1                 #! too low
    rooms:
      - {id: hall, label: HALL, rectangle: [0, 0, 4, 5]}
      - {id: hall, label: OFFICE, rectangle: [10, 0, 12, 5]}        #! twice
      - {id: bow, label: OFFICE, polygon: [[20, 0], [24, 4], [24, 0], [20, 4]]}  #! crosses itself
      - {id: over, label: OFFICE, rectangle: [3, 3, 6, 6]}          #! overlaps the hall
      - {id: none, label: OFFICE}                                   #! no outline
      - {id: flat, label: OFFICE, rectangle: [30, 0, 30.15, 5]}     #! nothing between the walls
      - {id: office, label: OFFICE, rectangle: [4, 0, 8, 3]}
      - {id: far, label: OFFICE, rectangle: [40, 0, 44, 3], size: 3}  #! no such key
    doors:
      - {id: d1, rooms: [hall, far], at: [4, 1]}                    #! no common wall
      - {id: d2, rooms: [hall, office], at: [4, 0.2]}               #! too near to the corner
      - {id: d3, rooms: [hall, nowhere], at: [0, 1]}                #! no such room
      - {id: d4, rooms: [hall, outside], at: [4, 1.5]}              #! not an outer wall
      - {id: d5, rooms: [hall, office], at: [4, 1.5], state: {20: open, 21: closed}}  #! too fast
      - {id: d6, rooms: [hall, office], at: [4, 1.5], width: wide}  #! not a number
      - {id: d7, rooms: [hall, office], at: [4, 1.5], opens_into: far}  #! another room
      - {id: d8, rooms: [hall, office], at: [4, 1.5], leaves: 0, state: open}  #! no leaf
      - {id: d9, rooms: [hall, office], at: [4, 1.5], state: closed}
    stairs:
      - {id: s1, goes: up, at: [1, 1], heading: 90, steps: 12, step_height: 0.1}
      - {id: s2, goes: sideways, at: [1, 1], heading: 90}           #! neither up nor down
      - {id: s3, goes: up, at: [1, 1], heading: 0, steps: 20}       #! through the wall
    furniture:
      - {kind: throne, at: [1, 1]}                                  #! no such kind
      - {kind: table, at: [0.2, 1]}                                 #! in the wall
      - {kind: poster, at: [2, 2]}                                  #! far from any wall
      - {kind: cupboard, at: [1, 1], z: 2.5}                        #! through the ceiling
    people:
      - {id: a, path: [[1, 1], [6, 1]]}                             #! through the wall
      - {id: b, path: [[1, 1.5], [6, 1.5]]}                         #! through a closed door
      - {id: c, at: [50, 50]}                                       #! in no room
      - {id: e, path: [[1, 1], [3, 1, 0.1]]}                        #! too fast
lifts:
  - {id: l, rooms: [hall, office]}                                  #! no lifts
)";
  const auto faults = faultsOf(text);
  EXPECT_EQ(faultyLines(faults), markedLines(text)) << testing::PrintToString(faults);
  EXPECT_THAT(faults, Contains(AllOf(HasSubstr("test.scene.yaml:3: scene"), HasSubstr("'colour'"))));
  EXPECT_THAT(faults, Contains(AllOf(HasSubstr("door 'd6', key 'width'"), HasSubstr("found 'wide'"))));
  EXPECT_THAT(faults, Contains(AllOf(HasSubstr("person 'a', key 'path'"), HasSubstr("a wall at [3.9, 1]"))));
}

TEST(SceneFile, StairsThatDoNotReachTheStoreyAreNamed) {
  EXPECT_THAT(faultsOf(twoStoreys("{id: s, goes: up, at: [2, 1], heading: 0, width: 1, steps: 15, step_height: 0.18}")),
              ElementsAre(AllOf(HasSubstr("stairs 's', key 'step_height'"), HasSubstr("3.1 m from floor to floor"),
                                HasSubstr("found 15 of 0.18 m"))));
  EXPECT_THAT(faultsOf(twoStoreys("{id: s, goes: up, at: [2, 1], heading: 0, width: 1, steps: 9}")),
              ElementsAre(AllOf(HasSubstr("key 'steps'"), HasSubstr("found 9"))));
}

TEST(SceneFile, WhatIsMissingIsNamed) {
  EXPECT_THAT(faultsOf("scene: x\n"), ElementsAre(HasSubstr("key 'storeys'")));
  EXPECT_THAT(faultsOf("scene: x\nstoreys: []\n"), ElementsAre(HasSubstr("one storey or more")));
  EXPECT_THAT(faultsOf("scene: x\nstoreys: [{height: 3}]\n"), ElementsAre(HasSubstr("key 'rooms'")));
  EXPECT_THAT(faultsOf("just text"), Contains(HasSubstr("keys with values")));
  EXPECT_THAT(faultsOf(twoRooms("    doors: [{}]\n")),
              ElementsAre(HasSubstr("'id'"), HasSubstr("'rooms'"), HasSubstr("'at'")));
}

TEST(SceneFile, AKeyGivenTwiceIsAFault) {
  EXPECT_THAT(faultsOf(twoRooms("    furniture: [{kind: bin, at: [1, 1], at: [2, 2]}]\n")),
              ElementsAre(HasSubstr("key 'at': expected each key once")));
}

// The samples.

class Samples : public testing::TestWithParam<const char*> {};

/// Every room hangs together with the first one by doors and stairs.
bool allRoomsCanBeReached(const Building& building) {
  std::set<int> reached{0};
  for (bool grew = true; grew;) {
    grew = false;
    const auto join = [&](const std::array<int, 2>& rooms) {
      if (rooms[0] == kOutside || rooms[1] == kOutside || reached.contains(rooms[0]) == reached.contains(rooms[1])) {
        return;
      }
      reached.insert(rooms.begin(), rooms.end());
      grew = true;
    };
    for (const auto& door : building.doors) join(door.rooms);
    for (const auto& stairs : building.stairs) join(stairs.rooms);
  }
  return reached.size() == building.rooms.size();
}

TEST_P(Samples, LoadAndAllTheirRoomsCanBeReached) {
  EXPECT_TRUE(isSceneFile(sample(GetParam())));
  const auto building = readSceneFile(sample(GetParam()), 1);
  EXPECT_TRUE(allRoomsCanBeReached(building));
  EXPECT_GE(building.people.size(), 2U);
  const auto leads = [&](int storey) {
    return [storey](const Staircase& stairs) { return stairs.upperStorey == storey; };
  };
  EXPECT_TRUE(std::ranges::any_of(building.stairs, leads(0))) << "down";
  EXPECT_TRUE(std::ranges::any_of(building.stairs, leads(1))) << "up";
}

TEST_P(Samples, AreTheSameForTheSameSeed) {
  const auto once = readSceneFile(sample(GetParam()), 7);
  const auto again = readSceneFile(sample(GetParam()), 7);
  ASSERT_EQ(once.doors.size(), again.doors.size());
  for (std::size_t i = 0; i < once.doors.size(); ++i) {
    EXPECT_EQ(openingAngle(once.doors[i], 0.0), openingAngle(again.doors[i], 0.0));
    EXPECT_EQ(once.doors[i].hingeSide, again.doors[i].hingeSide);
  }
}

/// As it stands in docs/scene-files.md.
TEST(SceneFile, TheDocumentedExampleLoads) {
  const auto page = test::readFile(std::filesystem::path(__FILE__).parent_path() / "../../docs/scene-files.md");
  const auto begin = page.find("```yaml\n") + 8;
  const auto building = read(page.substr(begin, page.find("```", begin) - begin));
  EXPECT_EQ(building.name, "two offices");
  EXPECT_THAT(building.rooms, SizeIs(3));
  EXPECT_THAT(building.doors, SizeIs(3));
  EXPECT_THAT(building.stairs, SizeIs(1));
  EXPECT_NEAR(building.stairs[0].foot.z(), -6 * 0.18, 1e-9);
}

TEST(SceneFile, TheDocumentationNamesAllKindsOfThings) {
  const auto page = test::readFile(std::filesystem::path(__FILE__).parent_path() / "../../docs/scene-files.md");
  for (const auto& kind : thingKinds()) EXPECT_THAT(page, HasSubstr(std::string(kind.name)));
}

INSTANTIATE_TEST_SUITE_P(SceneFile, Samples, testing::Values("sample_home", "sample_office"));

}  // namespace
}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/furniture.hpp"

#include "prodomos/simulation/floor_plan.hpp"
#include "prodomos/simulation/scene_file.hpp"

#include "simulation/buildings.hpp"
#include "simulation/scenes/scene_geometry.hpp"
#include "support/datasets.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <set>

namespace prodomos::simulation {
namespace {

using testing::Each;
using testing::IsEmpty;
using testing::Lt;
using testing::Not;

Building sample(const std::string& name, std::uint64_t seed) {
  const auto folder = std::filesystem::path(__FILE__).parent_path() / "../../configs";
  auto building = readSceneFile(folder / (name + ".scene.yaml"), seed);
  furnish(building, seed);
  return building;
}

/// A corridor with rooms of all uses along it, each with a door to it.
Building street(double corridorWidth, std::uint64_t seed) {
  const std::vector<std::string> labels{
      "CLASSROOM",    "OFFICE",  "SHARED OFFICE",   "CONFERENCE ROOM",   "WASHROOM",  "KITCHEN",     "LAB",
      "LIBRARY",      "GYM",     "RECEPTION",       "MEDIUM SERVICE",    "OPENSPACE", "LIVING ROOM", "BEDROOM",
      "PATIENT ROOM", "CANTEEN", "CONFERENCE HALL", "CONVENIENCE STORE", "MEDIUM",    "LOBBY"};
  Building building{.name = "street", .storeys = {{}}};
  const double length = 6.2 * static_cast<double>(labels.size());
  test::addRoom(building, "CORRIDOR", {0.0, 0.0}, {length, corridorWidth});
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const double from = 6.2 * static_cast<double>(i);
    const double depth = 4.0 + 1.5 * static_cast<double>(i % 4);
    const int room = test::addRoom(building, labels[i], {from, corridorWidth + test::kWall},
                                   {from + 6.0, corridorWidth + test::kWall + depth});
    auto& door = test::addDoor(building, 0, room, from + 1.0 + 0.8 * static_cast<double>(i % 6),
                               corridorWidth + test::kWall / 2.0, std::numbers::pi / 2.0);
    door.opensAlongNormal = i % 3 != 0;
  }
  furnish(building, seed);
  return building;
}

std::vector<Building> manyBuildings() {
  std::vector<Building> buildings{sample("sample_home", 1), sample("sample_office", 1)};
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    buildings.push_back(street(2.4, seed));
    buildings.push_back(sample("sample_home", 10 + seed));
  }
  return buildings;
}

double bottomOf(const Thing& thing) {
  return thing.T_world_thing.translation().z() - thing.size.z() / 2.0;
}

double floorOf(const Building& building, const Thing& thing) {
  return building.storeys[static_cast<std::size_t>(thing.storey)].floor_z;
}

/// Furniture, as against what hangs on walls and below ceilings.
bool stands(const Building& building, const Thing& thing) {
  return bottomOf(thing) < floorOf(building, thing) + 0.05;
}

/// Oracle: two boxes share a point of a fine raster of the one.
bool share(const Thing& a, const Thing& b) {
  constexpr int kSteps = 12;
  const geometry::Pose3 T_b_a = b.T_world_thing.inverse() * a.T_world_thing;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      for (int k = 0; k <= kSteps; ++k) {
        const Eigen::Vector3d share = Eigen::Vector3d(i, j, k) / kSteps - Eigen::Vector3d::Constant(0.5);
        const Eigen::Vector3d point_in_b = T_b_a * share.cwiseProduct(a.size);
        if ((point_in_b.cwiseAbs() - b.size / 2.0).maxCoeff() < -1e-6) return true;
      }
    }
  }
  return false;
}

TEST(Furniture, EachKindHasAClassASizeAndAShape) {
  for (const auto& kind : thingKinds()) {
    SCOPED_TRACE(kind.name);
    EXPECT_NO_THROW(classId(kind.className));
    EXPECT_TRUE((kind.least.array() <= kind.most.array()).all());
    EXPECT_EQ(findThingKind(kind.name), &kind);
  }
  EXPECT_EQ(findThingKind("throne"), nullptr);
}

TEST(Furniture, NothingOverlaps) {
  for (const auto& building : manyBuildings()) {
    SCOPED_TRACE(building.name);
    for (std::size_t i = 0; i < building.things.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto& a = building.things[i];
        const auto& b = building.things[j];
        const double reach = (a.size.norm() + b.size.norm()) / 2.0;
        if ((a.T_world_thing.translation() - b.T_world_thing.translation()).norm() > reach) continue;
        EXPECT_FALSE(share(a, b) || share(b, a)) << a.id << " and " << b.id;
      }
    }
  }
}

TEST(Furniture, NothingPassesThroughWallsOrCeilings) {
  for (const auto& building : manyBuildings()) {
    SCOPED_TRACE(building.name);
    for (const auto& thing : building.things) {
      const auto footprint = placeOf(thing);
      const int room = roomAt(building, thing.storey, footprint.middle);
      ASSERT_NE(room, kOutside) << thing.id;
      // Oracle: no point of its rim is outside.
      const auto corners = footprint.corners();
      for (std::size_t i = 0; i < corners.size(); ++i) {
        for (double t = 0.0; t < 1.0; t += 0.05) {
          const Eigen::Vector2d point = corners[i] + t * (corners[(i + 1) % corners.size()] - corners[i]);
          const Eigen::Vector2d inwards = point + 1e-4 * (footprint.middle - point).normalized();
          EXPECT_EQ(roomAt(building, thing.storey, inwards), room) << thing.id;
        }
      }
      const auto& storey = building.storeys[static_cast<std::size_t>(thing.storey)];
      EXPECT_GE(bottomOf(thing), storey.floor_z - 1e-9) << thing.id;
      EXPECT_LE(bottomOf(thing) + thing.size.z(), storey.floor_z + storey.ceilingHeight + 1e-9) << thing.id;
    }
  }
}

TEST(Furniture, DoorsStairsAndPeopleHaveTheirSpace) {
  for (const auto& building : manyBuildings()) {
    SCOPED_TRACE(building.name);
    for (const auto& thing : building.things) {
      const bool isSeeded = thing.id.find('/') != std::string::npos;
      if (!isSeeded || bottomOf(thing) > floorOf(building, thing) + 1.9) continue;
      const auto footprint = placeOf(thing);
      for (const auto& door : building.doors) {
        if (door.storey != thing.storey) continue;
        const double ahead = stands(building, thing) ? 0.99 : 0.0;
        const Eigen::Vector2d middle(door.pose.x, door.pose.y);
        const Footprint space{middle, door.pose.theta, {door.wallThickness + 2.0 * ahead + 0.01, door.width}};
        EXPECT_FALSE(overlap(space, footprint)) << thing.id << " stands before " << door.id;
      }
      for (const auto& stairs : building.stairs) {
        if (stairs.lowerStorey != thing.storey && (stairs.upperStorey != thing.storey || !stands(building, thing))) {
          continue;
        }
        EXPECT_FALSE(overlap(placeOf(stairs), footprint)) << thing.id << " stands on " << stairs.id;
      }
      for (const auto& person : building.people) {
        if (person.storey != thing.storey || !stands(building, thing)) continue;
        for (std::size_t i = 0; i + 1 < person.way.size(); ++i) {
          for (double t = 0.0; t <= 1.0; t += 0.05) {
            const Eigen::Vector2d at =
                person.way[i].position + t * (person.way[i + 1].position - person.way[i].position);
            EXPECT_GT(footprint.distanceTo(at), 0.3) << thing.id << " is in the way of " << person.id;
          }
        }
      }
    }
  }
}

constexpr double kCell = 0.08;  // metres

std::pair<int, int> cellOf(const Eigen::Vector2d& point) {
  return {static_cast<int>(std::floor(point.x() / kCell)), static_cast<int>(std::floor(point.y() / kCell))};
}

/// Oracle: from the door, a disc of that radius moves over a fine raster between walls and standing things. Returns the
/// points in reach, as cells.
std::set<std::pair<int, int>> reachFrom(const Building& building, int room, const Eigen::Vector2d& start,
                                        double radius) {
  const auto& here = building.rooms[static_cast<std::size_t>(room)];
  std::vector<Footprint> obstacles;
  for (const auto& thing : building.things) {
    if (thing.storey == here.storey && stands(building, thing)) obstacles.push_back(placeOf(thing));
  }
  for (const auto& wall : wallsOf(here.outline)) {
    const Eigen::Vector2d middle = (wall.from + wall.to) / 2.0;
    obstacles.push_back({middle, std::atan2(wall.along().y(), wall.along().x()), {wall.length(), 0.0}});
  }
  const auto isFree = [&](const Eigen::Vector2d& point) {
    return contains(here.outline, point) &&
           std::ranges::all_of(obstacles, [&](const Footprint& each) { return each.distanceTo(point) >= radius; });
  };
  std::set<std::pair<int, int>> reached;
  std::set<std::pair<int, int>> tried;
  std::vector<std::pair<int, int>> open{cellOf(start)};
  while (!open.empty()) {
    const auto [x, y] = open.back();
    open.pop_back();
    if (!tried.insert({x, y}).second || !isFree(kCell * Eigen::Vector2d(x + 0.5, y + 0.5))) continue;
    reached.insert({x, y});
    for (const auto& next : {std::pair{x + 1, y}, std::pair{x - 1, y}, std::pair{x, y + 1}, std::pair{x, y - 1}}) {
      open.push_back(next);
    }
  }
  return reached;
}

Eigen::Vector2d before(const Door& door, std::size_t side, double distance) {
  const double sign = side == 0 ? -1.0 : 1.0;
  const double ahead = sign * (door.wallThickness / 2.0 + distance);
  return Eigen::Vector2d(door.pose.x, door.pose.y) +
         ahead * Eigen::Vector2d(std::cos(door.pose.theta), std::sin(door.pose.theta));
}

TEST(Furniture, FromEachDoorAWayLeadsIntoTheRoomAndToItsOtherDoors) {
  // A little narrower than promised: the raster of furnish() is coarse.
  constexpr double kHalfWay = 0.3;
  for (const auto& building : {sample("sample_office", 3), sample("sample_home", 4), street(2.4, 5)}) {
    SCOPED_TRACE(building.name);
    for (int room = 0; room < static_cast<int>(building.rooms.size()); ++room) {
      std::vector<Eigen::Vector2d> doors;
      for (const auto& door : building.doors) {
        for (const std::size_t side : {0U, 1U}) {
          if (door.rooms[side] == room) doors.push_back(before(door, side, 0.45));
        }
      }
      if (doors.empty()) continue;
      const auto reached = reachFrom(building, room, doors.front(), kHalfWay);
      for (const auto& door : doors) {
        EXPECT_TRUE(reached.contains(cellOf(door))) << building.rooms[static_cast<std::size_t>(room)].id;
      }
      EXPECT_GT(static_cast<double>(reached.size()) * kCell * kCell,
                0.08 * signedArea(building.rooms[static_cast<std::size_t>(room)].outline))
          << building.rooms[static_cast<std::size_t>(room)].id;
    }
  }
}

TEST(Furniture, CorridorsStayPassable) {
  constexpr double kHalfWay = 0.55;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const auto building = street(2.2, seed);
    const auto reached = reachFrom(building, 0, before(building.doors.front(), 0, 0.7), kHalfWay);
    const auto last = before(building.doors.back(), 0, 0.7);
    EXPECT_TRUE(reached.contains(cellOf(last)));
  }
}

TEST(Furniture, NothingStandsInACorridorThatIsTooNarrow) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const auto building = street(1.15, seed);
    for (const auto& thing : building.things) {
      const bool inCorridor = contains(building.rooms[0].outline, placeOf(thing).middle);
      EXPECT_FALSE(inCorridor && stands(building, thing)) << thing.id;
    }
  }
}

TEST(Furniture, WindowsAreInOuterWallsAlone) {
  for (const auto& building : manyBuildings()) {
    for (const auto& thing : building.things) {
      if (thing.kind != "window" && thing.kind != "tall_window") continue;
      const auto footprint = placeOf(thing);
      const Eigen::Vector2d outwards(-std::cos(footprint.heading), -std::sin(footprint.heading));
      EXPECT_EQ(roomAt(building, thing.storey, footprint.middle + 0.4 * outwards), kOutside) << thing.id;
    }
  }
}

TEST(Furniture, RoomsHaveWhatTheirLabelSays) {
  const auto building = street(2.4, 1);
  std::map<std::string, std::set<std::string>> kinds;
  for (const auto& thing : building.things) {
    const int room = roomAt(building, 0, placeOf(thing).middle);
    kinds[building.rooms[static_cast<std::size_t>(room)].label].insert(thing.kind);
  }
  EXPECT_THAT(kinds["CLASSROOM"], testing::IsSupersetOf({"school_desk", "chair"}));
  EXPECT_THAT(kinds["OFFICE"], testing::IsSupersetOf({"desk", "office_chair"}));
  EXPECT_THAT(kinds["WASHROOM"], testing::IsSupersetOf({"toilet", "sink"}));
  EXPECT_THAT(kinds["BEDROOM"], testing::Contains("bed"));
  EXPECT_THAT(kinds["PATIENT ROOM"], testing::Contains("hospital_bed"));
  EXPECT_THAT(kinds["LIVING ROOM"], testing::Contains("sofa"));
  EXPECT_THAT(kinds["CONFERENCE ROOM"], testing::IsSupersetOf({"meeting_table", "office_chair"}));
  EXPECT_THAT(kinds["LIBRARY"], testing::Contains("shelf"));
  EXPECT_THAT(kinds["CONFERENCE HALL"], testing::Contains("chair"));
  EXPECT_THAT(kinds["CORRIDOR"], testing::Contains("noticeboard"));
}

TEST(Furniture, TrapsForDoorAndStairDetectorsAreAbout) {
  std::set<std::string> kinds;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    for (const auto& thing : street(2.4, seed).things) kinds.insert(thing.kind);
  }
  EXPECT_THAT(kinds, testing::IsSupersetOf({"wall_panel", "tall_poster", "cupboard", "noticeboard", "poster", "ramp",
                                            "box_pile", "tall_window"}));
}

bool alike(const Building& a, const Building& b) {
  const auto same = [](const Thing& one, const Thing& other) {
    return one.id == other.id && one.size == other.size && one.T_world_thing.matrix() == other.T_world_thing.matrix();
  };
  return std::ranges::equal(a.things, b.things, same) && a.lighting.lamps == b.lighting.lamps &&
         a.lighting.brightness == b.lighting.brightness;
}

TEST(Furniture, TheSameSeedGivesTheSameThingsAndAnotherOneOthers) {
  EXPECT_TRUE(alike(street(2.4, 7), street(2.4, 7)));
  EXPECT_FALSE(alike(street(2.4, 7), street(2.4, 8)));
}

TEST(Furniture, IdsAreUnique) {
  for (const auto& building : manyBuildings()) {
    std::set<std::string> ids;
    for (const auto& thing : building.things) EXPECT_TRUE(ids.insert(thing.id).second) << thing.id;
  }
}

TEST(Furniture, WhatTheSourceGivesStaysAlone) {
  auto building = test::corridorWithTwoRooms();
  building.rooms[1].furnished = true;
  test::addThing(building, "table", {9.0, 4.0}, {1.0, 2.0, 0.75});
  building.lighting.lamps = {{1.0, 1.0, 2.5}};
  building.lighting.brightness = 0.123;
  furnish(building, 1);
  EXPECT_EQ(building.things.front().id, "t1");
  EXPECT_EQ(building.lighting.brightness, 0.123);
  EXPECT_EQ(building.lighting.lamps.size(), 1U);
  for (const auto& thing : building.things) {
    EXPECT_FALSE(contains(building.rooms[1].outline, placeOf(thing).middle)) << thing.id;
  }
}

TEST(Furniture, EachRoomHasLightBelowItsCeiling) {
  const auto building = sample("sample_home", 1);
  for (const auto& room : building.rooms) {
    const auto& storey = building.storeys[static_cast<std::size_t>(room.storey)];
    const auto isHere = [&](const Eigen::Vector3d& lamp) {
      return contains(room.outline, lamp.head<2>()) && lamp.z() > storey.floor_z + 2.0 &&
             lamp.z() < storey.floor_z + storey.ceilingHeight;
    };
    EXPECT_TRUE(std::ranges::any_of(building.lighting.lamps, isHere)) << room.id;
  }
}

// Shapes.

TEST(Furniture, SurfacesLieWithinTheirBoxAndFillIt) {
  Building building{.storeys = {{}}};
  for (const auto& kind : thingKinds()) {
    for (const auto& size : {kind.least, kind.most}) {
      Thing thing{.id = std::string(kind.name), .kind = std::string(kind.name)};
      thing.size = size;
      thing.T_world_thing = geometry::toPose3({3.0, -2.0, 0.7}, 1.5);
      building.things.push_back(thing);
    }
  }
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    for (std::size_t i = 0; i < building.things.size(); ++i) {
      const auto& thing = building.things[i];
      SCOPED_TRACE(thing.kind);
      const geometry::Pose3 T_thing_world = thing.T_world_thing.inverse();
      Eigen::Vector3d least = Eigen::Vector3d::Constant(1e9);
      Eigen::Vector3d most = -least;
      for (const auto& surface : surfacesOf(building, i, seed)) {
        EXPECT_EQ(surface.instance, thingInstance(building, i));
        EXPECT_EQ(surface.classId, classId(findThingKind(thing.kind)->className));
        EXPECT_EQ(surface.textureCoordinates.size(), surface.vertices.size());
        EXPECT_TRUE(surface.normals.empty() || surface.normals.size() == surface.vertices.size());
        for (const auto& vertex : surface.vertices) {
          const Eigen::Vector3d vertex_in_thing = T_thing_world * vertex.cast<double>();
          least = least.cwiseMin(vertex_in_thing);
          most = most.cwiseMax(vertex_in_thing);
        }
        for (const auto& triangle : surface.triangles) EXPECT_THAT(triangle, Each(Lt(surface.vertices.size())));
      }
      EXPECT_LE((most - thing.size / 2.0).maxCoeff(), 1e-4);
      EXPECT_LE((-thing.size / 2.0 - least).maxCoeff(), 1e-4);
      EXPECT_GE(((most - least).array() / thing.size.array()).minCoeff(), 0.65) << "the box is not much too large";
    }
  }
}

/// A flat surface's normals agree with the turn of its triangles; a smooth one's are on the same side.
TEST(Furniture, TrianglesLookOutwards) {
  Building building{.storeys = {{}}};
  for (const auto& kind : thingKinds()) {
    Thing thing{.id = std::string(kind.name), .kind = std::string(kind.name)};
    thing.size = (kind.least + kind.most) / 2.0;
    building.things.push_back(thing);
  }
  for (std::size_t i = 0; i < building.things.size(); ++i) {
    for (const auto& surface : surfacesOf(building, i, 1)) {
      for (const auto& [a, b, c] : surface.triangles) {
        const Eigen::Vector3f turn =
            (surface.vertices[b] - surface.vertices[a]).cross(surface.vertices[c] - surface.vertices[a]);
        if (turn.norm() < 1e-7F || surface.normals.empty()) continue;
        const Eigen::Vector3f normal = surface.normals[a] + surface.normals[b] + surface.normals[c];
        EXPECT_GT(turn.dot(normal), 0.0F) << building.things[i].kind;
      }
    }
  }
}

TEST(Furniture, ColoursAreThoseOfTheSeed) {
  const auto building = street(2.4, 1);
  const auto colours = [&](std::uint64_t seed) {
    std::vector<int> parts;
    for (std::size_t i = 0; i < building.things.size(); ++i) {
      for (const auto& surface : surfacesOf(building, i, seed)) parts.push_back(surface.material.color.r);
    }
    return parts;
  };
  EXPECT_EQ(colours(1), colours(1));
  EXPECT_NE(colours(1), colours(2));
}

TEST(Furniture, SomeOfItIsHardToSeeForADepthSensor) {
  const auto building = street(2.4, 1);
  int dark = 0;
  int glossy = 0;
  int glass = 0;
  for (std::size_t i = 0; i < building.things.size(); ++i) {
    for (const auto& surface : surfacesOf(building, i, 1)) {
      dark += surface.material.infrared < 0.25F ? 1 : 0;
      glossy += surface.material.gloss > 0.5F ? 1 : 0;
      glass += surface.material.infrared == 0.0F ? 1 : 0;
    }
  }
  EXPECT_GT(dark, 10);
  EXPECT_GT(glossy, 10);
  EXPECT_GT(glass, 3);
}

TEST(Furniture, TheLargestPlanIsFurnishedInTwoSeconds) {
  const auto plan = test::dataset("buildings/plans/school/stjosephscatholichighschool_updated.xml");
  if (!plan) GTEST_SKIP() << "needs buildings/plans";
  auto building = readFloorPlan(*plan, {.seed = 1});
  const auto begin = std::clock();
  furnish(building, 1);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 2.0);
  EXPECT_THAT(building.things, Not(IsEmpty()));
  EXPECT_LT(building.things.size(), 6500U);
}

}  // namespace
}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/floor_plan.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/base/random.hpp"

#include "simulation/plans/plan_doors.hpp"
#include "simulation/plans/plan_drawing.hpp"
#include "simulation/plans/plan_rooms.hpp"
#include "simulation/plans/plan_stairs.hpp"
#include "simulation/shell/door_swings.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace prodomos::simulation {

namespace {

constexpr double kSlab = 0.25;  // Metres, between a ceiling and the next floor.

std::string numbered(const char* kind, int storey, std::size_t number) {
  return kind + std::to_string(storey) + "." + std::to_string(number);
}

std::vector<Storey> stackedStoreys(int count, double height) {
  std::vector<Storey> storeys;
  storeys.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) storeys.push_back({.floor_z = i * height, .ceilingHeight = height - kSlab});
  return storeys;
}

/// Rooms of the lowest storey, and which of them each drawn space became.
std::vector<std::optional<int>> addRooms(const PlanDrawing& drawing, const std::vector<std::optional<Polygon>>& faces,
                                         Building& building) {
  std::vector<std::optional<int>> roomOfSpace(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (!faces[i]) continue;
    roomOfSpace[i] = static_cast<int>(building.rooms.size());
    const auto& space = drawing.spaces[i];
    building.rooms.push_back({.label = space.label, .use = useOfLabel(space.label), .outline = *faces[i]});
  }
  return roomOfSpace;
}

int shifted(int room, std::size_t rooms) {
  return room == kOutside ? kOutside : room + static_cast<int>(rooms);
}

/// Repeats rooms and doors of the lowest storey on all others, and gives each its id.
void stack(Building& building) {
  const std::size_t roomCount = building.rooms.size();
  const std::size_t doorCount = building.doors.size();
  for (int storey = 0; std::cmp_less(storey, building.storeys.size()); ++storey) {
    const std::size_t offset = static_cast<std::size_t>(storey) * roomCount;
    for (std::size_t i = 0; i < roomCount; ++i) {
      if (storey > 0) building.rooms.push_back(Room(building.rooms[i]));
      Room& room = building.rooms[offset + i];
      room.id = numbered("r", storey, i);
      room.storey = storey;
    }
    for (std::size_t i = 0; i < doorCount; ++i) {
      if (storey > 0) building.doors.push_back(Door(building.doors[i]));
      Door& door = building.doors[static_cast<std::size_t>(storey) * doorCount + i];
      door.id = numbered("d", storey, i);
      door.storey = storey;
      if (storey > 0) door.rooms = {shifted(door.rooms[0], offset), shifted(door.rooms[1], offset)};
    }
  }
}

void addLifts(std::size_t roomsOfStorey, Building& building) {
  for (std::size_t i = 0; i < roomsOfStorey; ++i) {
    if (building.rooms[i].use != RoomUse::kLift) continue;
    Lift lift{.id = "l" + std::to_string(building.lifts.size()), .outline = building.rooms[i].outline};
    for (std::size_t room = i; room < building.rooms.size(); room += roomsOfStorey) {
      lift.rooms.push_back(static_cast<int>(room));
    }
    building.lifts.push_back(std::move(lift));
  }
}

}  // namespace

Building readFloorPlan(const std::filesystem::path& xml, const FloorPlanOptions& options) {
  if (options.storeys < 1) throw base::UsageError("storeys: at least 1, found " + std::to_string(options.storeys));
  PlanDrawing drawing = readDrawing(xml);
  base::Random random(options.seed, "floor plan");
  const double wallThickness = random.uniform(0.15, 0.25);
  const double storeyHeight = random.uniform(2.8, 3.4);

  Building building{.name = drawing.name, .storeys = stackedStoreys(options.storeys, storeyHeight)};
  building.remarks = std::move(drawing.remarks);
  const auto faces = wallFacesOf(drawing, wallThickness, xml.string(), building.remarks);
  const auto roomOfSpace = addRooms(drawing, faces, building);
  const std::size_t roomsOfStorey = building.rooms.size();
  if (roomsOfStorey == 0) {
    throw base::FileError(base::expectedFound(xml.string(), "rooms that hold more than their walls", "none"));
  }
  placeDoors(drawing, roomOfSpace, options.seed, building);
  if (building.doors.empty()) {
    throw base::FileError(base::expectedFound(xml.string(), "a portal between two rooms", "none that can be built"));
  }
  hangLeaves(options.seed, building);
  stack(building);
  addStairs(options.seed, roomsOfStorey, storeyHeight, building);
  addLifts(roomsOfStorey, building);
  setDoorStates(options.seed, building);
  return building;
}

}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/evaluation/room_shapes.hpp"
#include "prodomos/geometry/cells.hpp"
#include "prodomos/simulation/building.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

/// Doors of floor plans some of whose rooms have been seen: what predictors of rooms are fitted to and compared on.
namespace prodomos::test {

inline constexpr double kPlanResolution = 0.1;  // metres, of cells; finer ones change the sizes of baselines by no step
inline constexpr std::array kSharesSeen = {0.0, 0.3, 0.6};

/// All corridors, and a share of the other rooms, drawn by seed.
inline std::vector<bool> drawSeen(const simulation::Building& building, double share, std::uint64_t seed) {
  base::Random random(seed, "fit_baselines " + building.name);
  std::vector<bool> seen;
  for (const auto& room : building.rooms) {
    seen.push_back(room.use == simulation::RoomUse::kCorridor || random.uniform() < share);
  }
  return seen;
}
inline std::vector<bool> drawSeen(const simulation::Building& building, double share) {
  return drawSeen(building, share, static_cast<std::uint64_t>(100 * share));
}

enum class SeenCell : std::uint8_t { kUnknown, kFloor, kWall };

/// The seen rooms, and the walls around them, a cell thick.
inline geometry::CellMap<SeenCell> seenCells(const simulation::Building& building, const std::vector<bool>& seen) {
  std::vector<geometry::Polygon> outlines;
  for (const auto& room : building.rooms) outlines.push_back(room.outline);
  geometry::CellMap<SeenCell> cells(geometry::boxOf(outlines, kPlanResolution), SeenCell::kUnknown);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i]) cells.fill(outlines[i], SeenCell::kFloor, kPlanResolution);
  }
  const auto floor = cells;
  const auto box = floor.box();
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) {
      if (floor.at({x, y}) != SeenCell::kFloor) continue;
      for (const int dy : {-1, 0, 1}) {
        for (const int dx : {-1, 0, 1}) {
          auto* beside = cells.find({x + dx, y + dy});
          if (beside != nullptr && *beside == SeenCell::kUnknown) *beside = SeenCell::kWall;
        }
      }
    }
  }
  return cells;
}

/// One that a predicted room is judged on.
inline bool isOrdinary(const simulation::Room& room) {
  return room.use == simulation::RoomUse::kRoom &&
         std::abs(geometry::signedArea(room.outline)) <= evaluation::kLargestRoom;
}

/// The door's pose with the x-axis into rooms[far].
inline geometry::Pose2 poseTowards(const simulation::Door& door, std::size_t far) {
  return door.pose * geometry::Pose2{0.0, 0.0, far == 1 ? 0.0 : std::numbers::pi};
}

/// Doors with a leaf from a seen room into an unseen one, which is door.rooms[far].
inline void visitDoorsToUnseen(const simulation::Building& building, const std::vector<bool>& seen,
                               const std::function<void(const simulation::Door& door, std::size_t far)>& visit) {
  for (const auto& door : building.doors) {
    if (door.leaves == 0) continue;
    for (const std::size_t far : {0U, 1U}) {
      const int room = door.rooms[far];
      const int other = door.rooms[1 - far];
      if (room == simulation::kOutside || other == simulation::kOutside) continue;
      if (!seen[static_cast<std::size_t>(room)] && seen[static_cast<std::size_t>(other)]) visit(door, far);
    }
  }
}

}  // namespace prodomos::test

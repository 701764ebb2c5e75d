// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/plans/plan_stairs.hpp"

#include "prodomos/base/random.hpp"

#include "simulation/plans/stairwell.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace prodomos::simulation {

namespace {

constexpr double kHighestStep = 0.19;
constexpr double kShortestStep = 0.26;
constexpr double kLongestStep = 0.31;

/// Steps that fill the height exactly, of a size that feet like: two risers and a tread are about 0.63 m.
Climb comfortableClimb(double storeyHeight, base::Random& random) {
  Climb climb;
  climb.stepCount = static_cast<int>(std::lround(storeyHeight / random.uniform(0.16, 0.18)));
  climb.stepHeight = storeyHeight / climb.stepCount;
  const double depth = 0.63 - 2.0 * climb.stepHeight + random.uniform(-0.01, 0.01);
  climb.stepDepth = std::clamp(depth, kShortestStep, kLongestStep);
  return climb;
}

/// The steepest one may build.
Climb steepClimb(double storeyHeight) {
  const int steps = static_cast<int>(std::ceil(storeyHeight / kHighestStep));
  return {.stepCount = steps, .stepHeight = storeyHeight / steps, .stepDepth = kShortestStep};
}

/// Where one stands who has just come in by each of the room's doors.
std::vector<Eigen::Vector2d> entrancesOf(const Building& building, int room) {
  constexpr double kStep = 0.35;
  std::vector<Eigen::Vector2d> entrances;
  for (const auto& door : building.doors) {
    const double inside = kStep + door.wallThickness / 2.0;
    if (door.rooms[0] == room) entrances.push_back(door.pose * Eigen::Vector2d(-inside, 0.0));
    if (door.rooms[1] == room) entrances.push_back(door.pose * Eigen::Vector2d(inside, 0.0));
  }
  return entrances;
}

}  // namespace

void addStairs(std::uint64_t seed, std::size_t roomsOfStorey, double storeyHeight, Building& building) {
  base::Random random(seed, "stairs");
  const Climb comfortable = comfortableClimb(storeyHeight, random);
  const int storeys = static_cast<int>(building.storeys.size());
  for (std::size_t i = 0; i < roomsOfStorey; ++i) {
    const Room& room = building.rooms[i];
    if (room.use != RoomUse::kStairs) continue;
    const auto entrances = entrancesOf(building, static_cast<int>(i));
    auto plan = planStairwell(room.outline, entrances, comfortable);
    if (!plan) plan = planStairwell(room.outline, entrances, steepClimb(storeyHeight));
    if (!plan) {
      building.remarks.push_back("stairwell " + room.id +
                                 " stays empty: it is too small for flights and the way to its doors");
      continue;
    }
    for (int storey = 0; storey < std::max(1, storeys - 1); ++storey) {
      const int here = static_cast<int>(i) + storey * static_cast<int>(roomsOfStorey);
      const int above = storey + 1 < storeys ? here + static_cast<int>(roomsOfStorey) : kOutside;
      const double floorLevel = building.storeys[static_cast<std::size_t>(storey)].floor_z;
      for (Staircase flight : plan->flights) {
        flight.id = "s" + std::to_string(storey) + "." + std::to_string(building.stairs.size());
        flight.lowerStorey = storey;
        flight.upperStorey = storey + 1;
        flight.rooms = {here, above};
        flight.foot.z() += floorLevel;
        building.stairs.push_back(flight);
      }
      if (!plan->landing) continue;
      building.landings.push_back(*plan->landing);
      building.landings.back().lowerStorey = storey;
      building.landings.back().z += floorLevel;
    }
  }
}

}  // namespace prodomos::simulation

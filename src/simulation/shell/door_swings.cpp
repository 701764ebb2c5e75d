// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/shell/door_swings.hpp"

#include "prodomos/base/random.hpp"

#include "simulation/shell/openings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace prodomos::simulation {

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kRightAngle = 90.0 * kDegree;
constexpr double kWidestSwing = 95.0 * kDegree;

/// Whether a leaf that hangs in the wall's face has space at an angle.
bool isFree(const Building& building, const Door& door, const Hinge& hinge, double angle) {
  const int side = door.opensAlongNormal ? 1 : 0;
  const int room = door.rooms[static_cast<std::size_t>(side)];
  const double face = (side == 0 ? -0.5 : 0.5) * door.wallThickness;
  if (room == kOutside) return true;
  const auto& outline = building.rooms[static_cast<std::size_t>(room)].outline;
  // The closed leaf runs from its hinge to the other side.
  const double heading = (hinge.y_in_door > 0.0 ? -kRightAngle : kRightAngle) + hinge.turn * angle;
  constexpr double kClearance = 0.05;
  constexpr double kSpacing = 0.1;
  const double length = leafWidthOf(door) + kClearance;
  for (double along = kSpacing; along <= length; along += kSpacing) {
    const Eigen::Vector2d point_in_door(face + along * std::cos(heading), hinge.y_in_door + along * std::sin(heading));
    const bool isInTunnel = std::abs(point_in_door.x()) <= std::abs(face) + kClearance;
    if (!isInTunnel && !contains(outline, door.pose * point_in_door)) return false;
  }
  return true;
}

/// Into the smaller room, but never onto stairs.
bool prefersSecondRoom(const Building& building, const Door& door) {
  const auto weight = [&](int room) {
    if (room == kOutside) return 0.0;  // Outside doors open outwards.
    const Room& inside = building.rooms[static_cast<std::size_t>(room)];
    return signedArea(inside.outline) + (inside.use == RoomUse::kStairs ? 1e6 : 0.0);
  };
  return weight(door.rooms[1]) < weight(door.rooms[0]);
}

bool touchesStairs(const Building& building, const Door& door) {
  return std::ranges::any_of(door.rooms, [&](int room) {
    return room != kOutside && building.rooms[static_cast<std::size_t>(room)].use == RoomUse::kStairs;
  });
}

bool crossesCorridor(const Building& building, const Door& door) {
  return std::ranges::all_of(door.rooms, [&](int room) {
    return room != kOutside && building.rooms[static_cast<std::size_t>(room)].use == RoomUse::kCorridor;
  });
}

}  // namespace

double widestAngle(const Building& building, const Door& door) {
  constexpr double kStep = 5.0 * kDegree;
  double widest = kWidestSwing;
  for (const Hinge& hinge : hingesOf(door)) {
    double angle = 0.0;
    while (angle + kStep <= widest + kDegree && isFree(building, door, hinge, angle + kStep)) angle += kStep;
    widest = std::min(widest, angle);
  }
  return widest;
}

void hangLeaves(std::uint64_t seed, Building& building) {
  base::Random random(seed, "hinges");
  for (auto& door : building.doors) {
    const bool isContrary = random.uniform() < 0.15 && !touchesStairs(building, door);
    const bool isLeft = random.uniform() < 0.5;
    const bool alongNormal = prefersSecondRoom(building, door) != isContrary;
    const auto sideOf = [](bool left) { return left ? map::HingeSide::kLeft : map::HingeSide::kRight; };
    const std::array<std::pair<bool, bool>, 4> ways{
        {{alongNormal, isLeft}, {alongNormal, !isLeft}, {!alongNormal, isLeft}, {!alongNormal, !isLeft}}};
    double widest = -1.0;
    for (const auto& [along, left] : ways) {
      Door tried = door;
      tried.opensAlongNormal = along;
      tried.hingeSide = sideOf(left);
      const double angle = widestAngle(building, tried);
      if (angle <= widest) continue;
      widest = angle;
      door = tried;
      constexpr double kEnough = 85.0 * kDegree;
      if (widest >= kEnough) break;
    }
  }
}

void setDoorStates(std::uint64_t seed, Building& building) {
  base::Random random(seed, "states of doors");
  for (auto& door : building.doors) {
    const double chance = random.uniform();
    const double ajar = random.uniform(15.0, 50.0) * kDegree;
    const double open = random.uniform(75.0, 95.0) * kDegree;
    door.swings.clear();
    if (door.leaves == 0 || isLiftDoor(building, door)) continue;
    const bool mostlyOpen = crossesCorridor(building, door);
    const double closedUpTo = mostlyOpen ? 0.25 : 0.65;
    const double ajarUpTo = mostlyOpen ? 0.30 : 0.80;
    if (chance < closedUpTo) continue;
    const double angle = std::min(chance < ajarUpTo ? ajar : open, widestAngle(building, door));
    constexpr double kLeastAngle = 10.0 * kDegree;
    if (angle >= kLeastAngle) door.swings = {{0.0, angle}};
  }
}

}  // namespace prodomos::simulation

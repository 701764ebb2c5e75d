// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/building.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prodomos::simulation {

namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

std::uint16_t numbered(std::size_t before, std::size_t index) {
  return static_cast<std::uint16_t>(1 + before + index);
}

/// Of the corners a, b, c: left turn positive.
double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return cross(b - a, c - a);
}

bool liesWithin(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  return std::min(a.x(), b.x()) <= p.x() && p.x() <= std::max(a.x(), b.x()) && std::min(a.y(), b.y()) <= p.y() &&
         p.y() <= std::max(a.y(), b.y());
}

bool segmentsMeet(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                  const Eigen::Vector2d& d) {
  const double abc = turn(a, b, c);
  const double abd = turn(a, b, d);
  const double cda = turn(c, d, a);
  const double cdb = turn(c, d, b);
  if (abc * abd < 0.0 && cda * cdb < 0.0) return true;
  return (abc == 0.0 && liesWithin(a, b, c)) || (abd == 0.0 && liesWithin(a, b, d)) ||
         (cda == 0.0 && liesWithin(c, d, a)) || (cdb == 0.0 && liesWithin(c, d, b));
}

}  // namespace

std::uint16_t doorInstance(std::size_t door) {
  return numbered(0, door);
}

std::uint16_t stairsInstance(const Building& building, std::size_t stairs) {
  return numbered(building.doors.size(), stairs);
}

std::uint16_t thingInstance(const Building& building, std::size_t thing) {
  return numbered(building.doors.size() + building.stairs.size(), thing);
}

std::uint16_t personInstance(const Building& building, std::size_t person) {
  return numbered(building.doors.size() + building.stairs.size() + building.things.size(), person);
}

double openingAngle(const Door& door, double time) {
  if (door.swings.empty()) return 0.0;
  const auto next = std::ranges::upper_bound(door.swings, time, {}, &Swing::time);
  if (next == door.swings.begin()) return next->angle;
  const auto before = std::prev(next);
  if (next == door.swings.end()) return before->angle;
  return std::lerp(before->angle, next->angle, (time - before->time) / (next->time - before->time));
}

map::DoorState stateOf(double openingAngle) {
  constexpr double kAjar = 5.0 * std::numbers::pi / 180.0;
  constexpr double kOpen = 60.0 * std::numbers::pi / 180.0;
  if (openingAngle < kAjar) return map::DoorState::kClosed;
  return openingAngle < kOpen ? map::DoorState::kAjar : map::DoorState::kOpen;
}

bool isLiftDoor(const Building& building, const Door& door) {
  return std::ranges::any_of(door.rooms, [&](int room) {
    return room != kOutside && building.rooms[static_cast<std::size_t>(room)].use == RoomUse::kLift;
  });
}

Eigen::Vector3d headOf(const Staircase& stairs) {
  // The last riser ends on the upper floor: there is one tread less than there are risers.
  const double run = (stairs.stepCount - 1) * stairs.stepDepth;
  return stairs.foot + Eigen::Vector3d(run * std::cos(stairs.direction), run * std::sin(stairs.direction),
                                       stairs.stepCount * stairs.stepHeight);
}

int roomAt(const Building& building, int storey, const Eigen::Vector2d& point) {
  const auto holds = [&](const Room& room) { return room.storey == storey && contains(room.outline, point); };
  const auto room = std::ranges::find_if(building.rooms, holds);
  return room == building.rooms.end() ? kOutside : static_cast<int>(room - building.rooms.begin());
}

RoomUse useOfLabel(std::string_view label) {
  if (label == "STAIRS") return RoomUse::kStairs;
  if (label == "ELEVATOR" || label == "LIFT") return RoomUse::kLift;
  for (const std::string_view corridor : {"CORRIDOR", "HALL", "LOBBY", "ENTRANCE"}) {
    if (label == corridor) return RoomUse::kCorridor;
  }
  return RoomUse::kRoom;
}

bool isSlit(const Polygon& polygon, std::size_t edge) {
  constexpr double kWidest = 1e-3;
  const std::size_t n = polygon.size();
  const auto& from = polygon[edge];
  const auto& to = polygon[(edge + 1) % n];
  for (std::size_t i = 0; i < n; ++i) {
    const bool runsBack = (polygon[i] - to).norm() < kWidest && (polygon[(i + 1) % n] - from).norm() < kWidest;
    if (runsBack && i != edge) return true;
  }
  return false;
}

std::optional<std::pair<std::size_t, std::size_t>> findSelfCrossing(const Polygon& polygon) {
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const auto& a = polygon[i];
    const auto& b = polygon[(i + 1) % n];
    // The neighbour shares a corner; it crosses only where it runs back over this edge.
    const auto& c = polygon[(i + 2) % n];
    if (turn(a, b, c) == 0.0 && (b - a).dot(c - b) < 0.0) return std::pair{i, (i + 1) % n};
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      if (segmentsMeet(a, b, polygon[j], polygon[(j + 1) % n])) return std::pair{i, j};
    }
  }
  return std::nullopt;
}

}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/plans/shared_walls.hpp"

#include "simulation/shell/openings.hpp"

#include <algorithm>
#include <utility>

namespace prodomos::simulation {

namespace {

constexpr double kCornerMargin = 0.12;  // Of an opening: its frame must fit.
constexpr double kBetweenDoors = 0.25;  // Two frames and a little wall.
constexpr double kLeastCosine = 0.94;   // 20°

void block(std::vector<Interval>& free, const Interval& taken) {
  std::vector<Interval> rest;
  for (const auto& part : free) {
    if (taken.from >= part.to || taken.to <= part.from) {
      rest.push_back(part);
      continue;
    }
    rest.push_back({part.from, taken.from});
    rest.push_back({taken.to, part.to});
  }
  std::erase_if(rest, [](const Interval& part) { return part.length() < kLeastDoorWidth; });
  free = std::move(rest);
}

Interval shadowOf(const SharedWall& wall, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double first = (a - wall.origin).dot(wall.along);
  const double second = (b - wall.origin).dot(wall.along);
  return {std::min(first, second), std::max(first, second)};
}

/// Takes out what is already open in that edge of the room.
void blockDoors(const Building& building, int room, std::size_t edge, SharedWall& wall) {
  const auto& outline = building.rooms[static_cast<std::size_t>(room)].outline;
  const Edge face = edgeOf(outline, edge);
  for (const auto& door : building.doors) {
    for (const int side : {0, 1}) {
      if (door.rooms[static_cast<std::size_t>(side)] != room) continue;
      const auto opening = openingIn(outline, door, side);
      if (!opening || opening->edge != edge) continue;
      const Interval taken =
          shadowOf(wall, face.from + opening->from * face.direction(), face.from + opening->to * face.direction());
      block(wall.free, {taken.from - kBetweenDoors, taken.to + kBetweenDoors});
    }
  }
}

}  // namespace

double SharedWall::faceAt(std::size_t side, double position) const {
  const Eigen::Vector2d from = faces[side].from - origin;
  const Eigen::Vector2d span = faces[side].to - faces[side].from;
  const double share = (position - from.dot(along)) / span.dot(along);
  return (from + share * span).dot(normal());
}

std::vector<SharedWall> sharedWalls(const Building& building, const std::array<int, 2>& rooms,
                                    const Eigen::Vector2d& origin) {
  const auto& first = building.rooms[static_cast<std::size_t>(rooms[0])].outline;
  const auto& second = building.rooms[static_cast<std::size_t>(rooms[1])].outline;
  std::vector<SharedWall> walls;
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (std::size_t j = 0; j < second.size(); ++j) {
      const Edge ours = edgeOf(first, i);
      const Edge theirs = edgeOf(second, j);
      // Both rooms have their inside to the left: their faces of one wall run against each other.
      if (ours.direction().dot(theirs.direction()) > -kLeastCosine) continue;
      SharedWall wall{
          .origin = origin, .along = (ours.direction() - theirs.direction()).normalized(), .faces = {ours, theirs}};
      const Interval a = shadowOf(wall, ours.from, ours.to);
      const Interval b = shadowOf(wall, theirs.from, theirs.to);
      const Interval both{std::max(a.from, b.from) + kCornerMargin, std::min(a.to, b.to) - kCornerMargin};
      if (both.length() < kLeastDoorWidth || wall.thicknessAt((both.from + both.to) / 2.0) <= 0.0) continue;
      wall.free.push_back(both);
      blockDoors(building, rooms[0], i, wall);
      blockDoors(building, rooms[1], j, wall);
      if (!wall.free.empty()) walls.push_back(std::move(wall));
    }
  }
  return walls;
}

}  // namespace prodomos::simulation

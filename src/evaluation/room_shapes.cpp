// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/room_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace prodomos::evaluation {

namespace {

/// Mean of a value over all shapes, or over those of ordinary rooms.
template <typename Value>
std::optional<double> meanOf(const std::vector<RoomShape>& shapes, bool ordinaryOnly, const Value& value) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const auto& shape : shapes) {
    if (ordinaryOnly && !shape.isOrdinary) continue;
    sum += value(shape);
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / static_cast<double>(count);
}

std::size_t indexOfRadius(double radius) {
  const auto steps = static_cast<std::size_t>(std::lround(radius / kRadiusStep));
  return std::clamp<std::size_t>(steps, 1, kRadiusSteps) - 1;
}

/// The room is predicted where its door was closed when the prediction was made.
bool isBehindClosedDoor(const Scene& scene, std::size_t index) {
  const auto& behind = scene.behind[index];
  if (!behind.door || !behind.room || !behind.isUnseen) return false;
  const auto& door = scene.truth.doors[*behind.door];
  return door.leaves > 0 && stateAt(door, scene.claims.spaces[index].made) == map::DoorState::kClosed;
}

RoomShape shapeBehind(const Scene& scene, std::size_t index, const ClaimedDoor& door, const Baselines& baselines) {
  const auto& space = scene.claims.spaces[index];
  const auto& room = scene.truth.rooms[*scene.behind[index].room];
  const DoorView view(door.T_world_door, room.outline, [&](const Eigen::Vector2d& point) {
    return scene.known.isKnown(room.storey, geometry::cellAt(point.x(), point.y(), kCell), space.made);
  });
  return judgeShape(likelyRoom(space), view, room.use == "room", baselines);
}

/// Closed to the end, visible from somewhere, and on one side or the other a room that nobody knows.
FoundCount countDoors(const Scene& scene) {
  std::set<std::size_t> predicted;
  for (std::size_t i = 0; i < scene.behind.size(); ++i) {
    const bool stands = scene.claims.spaces[i].state != map::PredictionState::kRefuted;
    if (scene.behind[i].door && stands) predicted.insert(*scene.behind[i].door);
  }
  FoundCount count;
  for (std::size_t i = 0; i < scene.truth.doors.size(); ++i) {
    const auto& door = scene.truth.doors[i];
    const bool closed = door.leaves > 0 && stateAt(door, base::Time::max()) == map::DoorState::kClosed;
    if (!closed || !door.sighting.visible || isLiftDoor(scene.truth, door)) continue;
    const bool hidesRoom = std::ranges::any_of(door.rooms, [&](const std::string& id) {
      const auto room = findRoom(scene.truth, id);
      return room && !scene.truth.rooms[*room].entered &&
             scene.unseenArea(*room, base::Time::max()) > scene.area(*room) / 2.0;
    });
    if (hidesRoom) count += {1, predicted.contains(i) ? 1U : 0U};
  }
  return count;
}

}  // namespace

Polygon likelyRoom(const ClaimedSpace& space) {
  if (!space.room_in_world.empty() || space.areas_in_world.empty()) return space.room_in_world;
  return space.areas_in_world.begin()->second;
}

RoomShape judgeShape(const Polygon& likelyRoom, const DoorView& view, bool isRoom, const Baselines& baselines) {
  RoomShape shape{.isOrdinary = isRoom && view.roomArea() <= kLargestRoom};
  shape.predictedArea = static_cast<double>(cellsIn(likelyRoom).size()) * kCell * kCell;
  shape.iou = view.iou(likelyRoom);
  shape.fixedBox = view.iou(baselines.fixedBox);
  shape.clippedBox = view.iouClipped(baselines.clippedBox);
  shape.oracleBox = view.iou(view.bestBox());
  shape.halfDiscs = view.iousOfHalfDiscs();
  shape.halfDisc = shape.halfDiscs[indexOfRadius(baselines.halfDiscRadius)];
  return shape;
}

std::size_t RoomShapes::ordinaryCount() const {
  return static_cast<std::size_t>(std::ranges::count_if(shapes, &RoomShape::isOrdinary));
}

std::optional<double> RoomShapes::all() const {
  return meanOf(shapes, false, [](const RoomShape& shape) { return shape.iou; });
}
std::optional<double> RoomShapes::ordinary() const {
  return meanOf(shapes, true, [](const RoomShape& shape) { return shape.iou; });
}
std::optional<double> RoomShapes::fixedBox() const {
  return meanOf(shapes, true, [](const RoomShape& shape) { return shape.fixedBox; });
}
std::optional<double> RoomShapes::clippedBox() const {
  return meanOf(shapes, true, [](const RoomShape& shape) { return shape.clippedBox; });
}
std::optional<double> RoomShapes::oracleBox() const {
  return meanOf(shapes, true, [](const RoomShape& shape) { return shape.oracleBox; });
}

std::optional<double> RoomShapes::halfDiscBest() const {
  return meanOf(shapes, true, [](const RoomShape& shape) { return shape.halfDisc; });
}

std::optional<double> RoomShapes::halfDiscEqualArea() const {
  const auto meanArea = meanOf(shapes, true, [](const RoomShape& shape) { return shape.predictedArea; });
  if (!meanArea) return std::nullopt;
  const auto index = indexOfRadius(std::sqrt(2.0 * *meanArea / std::numbers::pi));
  return meanOf(shapes, true, [index](const RoomShape& shape) { return shape.halfDiscs[index]; });
}

RoomScore& RoomScore::operator+=(const RoomScore& other) {
  shapes.insert(shapes.end(), other.shapes.begin(), other.shapes.end());
  doors += other.doors;
  return *this;
}

RoomScore scoreRooms(const Scene& scene, const Baselines& baselines) {
  RoomScore score;
  std::set<base::SubMapId> judged;  // two doors may have one predicted room
  for (std::size_t i = 0; i < scene.claims.spaces.size(); ++i) {
    const auto& space = scene.claims.spaces[i];
    const auto* door = scene.findDoor(space.cause);
    if (door == nullptr || !isBehindClosedDoor(scene, i) || !judged.insert(space.node).second) continue;
    score.shapes.push_back(shapeBehind(scene, i, *door, baselines));
  }
  score.doors = countDoors(scene);
  return score;
}

}  // namespace prodomos::evaluation

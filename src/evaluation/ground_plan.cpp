// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/ground_plan.hpp"

#include "prodomos/evaluation/detections.hpp"

#include <algorithm>

namespace prodomos::evaluation {

namespace {

constexpr double kStandsBelow = 0.3;  // metres above the floor; what hangs higher hangs on a wall

constexpr int kMargin = 20;  // cells around the rooms, for doors that lead outside

geometry::CellBox boxOfStorey(const Truth& truth, int storey) {
  std::vector<Polygon> outlines;
  for (const auto& room : truth.rooms) {
    if (room.storey == storey) outlines.push_back(room.outline);
  }
  auto box = boxOf(outlines);
  if (box.empty()) return box;
  const geometry::CellIndex first = box.first;
  const geometry::CellIndex last = box.last;
  box.add({first.x - kMargin, first.y - kMargin});
  box.add({last.x + kMargin, last.y + kMargin});
  return box;
}

/// As wide as the door and `depth` deep, about that pose.
Polygon acrossDoor(const geometry::Pose2& T_world_middle, double width, double depth) {
  return boxBehind(T_world_middle, width / 2.0, -width / 2.0, -depth / 2.0, depth / 2.0);
}

bool standsOn(const TrueObject& object, double floorHeight) {
  if (object.mobility == map::Mobility::kDynamic || object.poses.empty()) return false;
  const double middle = object.poses.front().T_world_object.translation().z();
  return middle - object.size.z() / 2.0 < floorHeight + kStandsBelow;
}

Polygon footprintOf(const TrueObject& object) {
  const auto T_world_object = geometry::toPose2(object.poses.front().T_world_object);
  const Eigen::Vector2d half = object.size.head<2>() / 2.0;
  return boxBehind(T_world_object, half.y(), -half.y(), -half.x(), half.x());
}

}  // namespace

GroundPlan::GroundPlan(const Truth& truth, int storey) : doors_(truth.doors) {
  const auto box = boxOfStorey(truth, storey);
  rooms_ = openings_ = leaves_ = CellMap<std::int32_t>(box, -1);
  things_ = CellMap<std::uint8_t>(box, 0);
  for (std::size_t i = 0; i < truth.rooms.size(); ++i) {
    if (truth.rooms[i].storey == storey) rooms_.fill(truth.rooms[i].outline, static_cast<std::int32_t>(i));
  }
  for (std::size_t i = 0; i < truth.doors.size(); ++i) {
    const auto& door = truth.doors[i];
    if (door.storey != storey) continue;
    openings_.fill(acrossDoor(poseOf(door), door.width, door.wallThickness), static_cast<std::int32_t>(i));
    if (door.leaves > 0) leaves_.fill(acrossDoor(leafPoseOf(door), door.width, kCell), static_cast<std::int32_t>(i));
  }
  const auto index = static_cast<std::size_t>(storey);
  const double floorHeight = index < truth.storeys.size() ? truth.storeys[index].floor_z : 0.0;
  for (const auto& object : truth.objects) {
    if (object.storey == storey && standsOn(object, floorHeight)) things_.fill(footprintOf(object), 1);
  }
}

std::optional<std::size_t> GroundPlan::roomAt(geometry::CellIndex cell) const {
  const auto room = rooms_.at(cell);
  return room < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(room));
}

bool GroundPlan::isFloor(geometry::CellIndex cell, base::Time at) const {
  const auto leaf = leaves_.at(cell);
  if (leaf >= 0 && stateAt(doors_[static_cast<std::size_t>(leaf)], at) == map::DoorState::kClosed) return false;
  return rooms_.at(cell) >= 0 || openings_.at(cell) >= 0;
}

std::vector<GroundPlan> groundPlansOf(const Truth& truth) {
  std::vector<GroundPlan> plans;
  for (std::size_t storey = 0; storey < truth.storeys.size(); ++storey) {
    plans.emplace_back(truth, static_cast<int>(storey));
  }
  return plans;
}

std::optional<std::size_t> findRoom(const Truth& truth, const std::string& id) {
  const auto room = std::ranges::find(truth.rooms, id, &TrueRoom::id);
  if (room == truth.rooms.end()) return std::nullopt;
  return static_cast<std::size_t>(room - truth.rooms.begin());
}

}  // namespace prodomos::evaluation

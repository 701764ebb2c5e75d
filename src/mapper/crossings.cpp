// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/crossings.hpp"

#include <cmath>

namespace prodomos::mapper {

namespace {

constexpr double kSameFloor = 1.0;  // metres from the door's floor to the way
constexpr double kJamb = 0.1;       // metres that a way may seem to lie beside the opening

struct LastCrossing {
  std::ptrdiff_t step = 0;
  bool isOdd = false;
};

LastCrossing crossingsOf(std::span<const Eigen::Vector3d> way_in_map, const Passage& door) {
  const geometry::Pose3 T_door_map = door.T_map_passage.inverse();
  LastCrossing last;
  for (std::size_t i = 1; i < way_in_map.size(); ++i) {
    const Eigen::Vector3d from = T_door_map * way_in_map[i - 1];
    const Eigen::Vector3d to = T_door_map * way_in_map[i];
    if ((from.x() < 0.0) == (to.x() < 0.0)) continue;
    const Eigen::Vector3d at = from + (to - from) * (from.x() / (from.x() - to.x()));
    if (std::abs(at.y()) > door.halfWidth + kJamb || std::abs(at.z()) > kSameFloor) continue;
    last = {static_cast<std::ptrdiff_t>(i), !last.isOdd};
  }
  return last;
}

}  // namespace

std::vector<Passage> passagesOf(std::span<const map::Entity> entities,
                                const std::function<geometry::Pose3(base::SubMapId)>& T_map_submap) {
  std::vector<Passage> passages;
  for (const auto& entity : entities) {
    // Upright, on the floor of the sub-map that it was seen from.
    const auto pose = [&] {
      return geometry::Pose3(T_map_submap(entity.submap) *
                             geometry::toPose3(geometry::toPose2(entity.T_submap_entity), 0.0));
    };
    if (const auto* door = std::get_if<map::Door>(&entity.attributes)) {
      passages.push_back({entity.id, pose(), door->width / 2.0, 0.0});
    } else if (const auto* stairs = std::get_if<map::Staircase>(&entity.attributes)) {
      const auto run = map::runOf(entity);
      if (run) passages.push_back({entity.id, pose(), stairs->stepWidth / 2.0, *run / 2.0});
    }
  }
  return passages;
}

std::optional<Crossing> doorCrossed(std::span<const Eigen::Vector3d> way_in_map, std::span<const Passage> passages) {
  std::optional<Crossing> crossed;
  std::ptrdiff_t latest = 0;
  for (const auto& passage : passages) {
    if (passage.halfRun > 0.0) continue;
    const auto last = crossingsOf(way_in_map, passage);
    if (!last.isOdd || last.step < latest) continue;
    latest = last.step;
    const Eigen::Vector3d end = passage.T_map_passage.inverse() * way_in_map.back();
    crossed = Crossing{passage.entity, std::abs(end.x())};
  }
  return crossed;
}

std::optional<base::EntityId> flightClimbed(std::span<const Eigen::Vector3d> way_in_map,
                                            std::span<const Passage> passages) {
  std::optional<base::EntityId> climbed;
  std::size_t latest = 0;
  for (const auto& passage : passages) {
    if (passage.halfRun == 0.0) continue;
    const geometry::Pose3 T_flight_map = passage.T_map_passage.inverse();
    for (std::size_t i = latest; i < way_in_map.size(); ++i) {
      const Eigen::Vector3d at = T_flight_map * way_in_map[i];
      if (std::abs(at.x()) > passage.halfRun || std::abs(at.y()) > passage.halfWidth) continue;
      latest = i;
      climbed = passage.entity;
    }
  }
  return climbed;
}

void nameWay(map::Edge& edge, std::span<const Eigen::Vector3d> way_in_map, std::span<const Passage> passages) {
  if (edge.kind == map::EdgeKind::kStairs) {
    edge.cause = flightClimbed(way_in_map, passages);
    return;
  }
  if (edge.kind == map::EdgeKind::kLift) return;
  const auto crossed = doorCrossed(way_in_map, passages);
  edge.cause = crossed ? std::optional(crossed->entity) : std::nullopt;
  if (edge.kind != map::EdgeKind::kLoop) edge.kind = crossed ? map::EdgeKind::kDoor : map::EdgeKind::kTravelled;
}

}  // namespace prodomos::mapper

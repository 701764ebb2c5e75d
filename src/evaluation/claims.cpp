// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/claims.hpp"

#include <algorithm>

namespace prodomos::evaluation {

namespace {

using geometry::transformed;

const map::Entity* findEntity(const map::MapView& view, base::EntityId id) {
  const auto found = std::ranges::find(view.entities(), id, &map::Entity::id);
  return found == view.entities().end() ? nullptr : &*found;
}

/// Believed no more; it stays in the map for the sake of a bet.
bool isGivenUp(const map::Entity& entity) {
  return entity.confidence <= 0.0;
}

ClaimedStaircase claimedStairs(const map::Entity& entity, const map::Staircase& stairs,
                               const geometry::Pose3& T_world_submap, int storey) {
  ClaimedStaircase claim{entity.id, storey, geometry::toPose2(T_world_submap * entity.T_submap_entity), stairs, {}};
  if (const auto run = map::runOf(entity)) {
    const auto foot = claim.T_world_stairs * geometry::Pose2{-*run / 2.0, 0.0, 0.0};
    claim.foot = Eigen::Vector2d(foot.x, foot.y);
  }
  return claim;
}

std::optional<std::multimap<base::EntityId, base::Time>> detectionsOf(const map::MapView& view) {
  std::multimap<base::EntityId, base::Time> images;
  for (const auto& event : view.events()) {
    if (event.kind != "detected") continue;
    if (const auto entity = base::parseId<base::EntityId>(event.subject)) images.emplace(*entity, event.time);
  }
  if (images.empty()) return std::nullopt;
  return images;
}

ClaimedSpace claimedSpace(const map::MapView& view, const map::Prediction& prediction, const Placement& placement) {
  ClaimedSpace claim{.id = prediction.id,
                     .node = prediction.node,
                     .cause = prediction.cause,
                     .mobility = std::nullopt,
                     .probability = prediction.probability,
                     .made = prediction.made,
                     .settled = prediction.settled,
                     .state = prediction.state,
                     .areas_in_world = {},
                     .room_in_world = {}};
  if (const auto* cause = findEntity(view, prediction.cause)) claim.mobility = map::mobility(cause->attributes);
  const auto seenFrom = placement.T_world_submap.find(prediction.submap);
  if (seenFrom == placement.T_world_submap.end()) return claim;
  const geometry::Pose3 T_world_node = seenFrom->second * prediction.T_submap_node;
  claim.storey = placement.modelledStoreyAt(T_world_node.translation().z());
  for (const auto& area : prediction.areas) {
    claim.areas_in_world[area.threshold] = transformed(T_world_node, area.outline_in_node);
  }
  claim.room_in_world = transformed(T_world_node, prediction.room_in_node);
  return claim;
}

}  // namespace

Claims claimsOf(const map::MapView& view, const Placement& placement) {
  Claims claims;
  for (const auto& entity : view.entities()) {
    const auto frame = placement.T_world_submap.find(entity.submap);
    if (frame == placement.T_world_submap.end() || isGivenUp(entity)) continue;
    const int storey = placement.storeyAt(frame->second.translation().z());
    if (const auto* door = std::get_if<map::Door>(&entity.attributes)) {
      claims.doors.push_back({entity.id, storey, geometry::toPose2(frame->second * entity.T_submap_entity), *door,
                              entity.firstSeen, entity.lastSeen});
    } else if (const auto* stairs = std::get_if<map::Staircase>(&entity.attributes)) {
      claims.stairs.push_back(claimedStairs(entity, *stairs, frame->second, storey));
    }
  }
  for (const auto& prediction : view.predictions()) {
    claims.spaces.push_back(claimedSpace(view, prediction, placement));
  }
  claims.images = detectionsOf(view);
  return claims;
}

Claims claimsOf(const map::MapView& view, const Truth& truth) {
  return claimsOf(view, placementOf(view, truth));
}

}  // namespace prodomos::evaluation

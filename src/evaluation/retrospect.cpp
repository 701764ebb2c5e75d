// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/retrospect.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>

namespace prodomos::evaluation {

namespace {

using geometry::transformed;

Polygon polygonOf(const nlohmann::json& corners) {
  Polygon polygon;
  for (const auto& corner : corners) polygon.emplace_back(corner.at(0).get<double>(), corner.at(1).get<double>());
  return polygon;
}

struct Shape {
  std::map<double, Polygon> areas_in_world;
  Polygon room_in_world;
};

/// None where the event does not tell one.
std::optional<Shape> shapeIn(const std::string& payload, const Placement& placement) {
  try {
    const auto told = nlohmann::json::parse(payload);
    const auto& T_world_submap = placement.T_world_submap.at({told.at("submap").get<std::int64_t>()});
    Shape shape{.areas_in_world = {}, .room_in_world = transformed(T_world_submap, polygonOf(told.at("room")))};
    for (const auto& area : told.at("areas")) {
      shape.areas_in_world[area.at("threshold")] = transformed(T_world_submap, polygonOf(area.at("outline")));
    }
    return shape;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  } catch (const std::out_of_range&) {  // of a sub-map that is not there
    return std::nullopt;
  }
}

}  // namespace

Retrospect::Retrospect(const map::MapView& view)
    : placement(placementOf(view)),
      claims(claimsOf(view, placement)),
      known(knownSpaceOf(view, placement, &map::Node::end)),
      places(known, claims.doors) {
  for (const auto& [id, T_world_submap] : placement.T_world_submap) ends.push_back(view.graph().getNode(id).end);
  std::ranges::sort(ends);
  recall(view);
}

/// Brings back what was told when bets were made: events "prediction_made" keep it (docs/map-file.md).
void Retrospect::recall(const map::MapView& view) {
  for (const auto& event : view.events()) {
    if (event.kind != "prediction_made") continue;
    const auto id = base::parseId<base::PredictionId>(event.subject);
    const auto bet = std::ranges::find(claims.spaces, id, [](const auto& space) { return std::optional(space.id); });
    if (bet == claims.spaces.end()) continue;
    const auto shape = shapeIn(event.payload, placement);
    if (!shape) continue;
    bet->areas_in_world = shape->areas_in_world;
    bet->room_in_world = shape->room_in_world;
    recalled_.insert(bet->id);
  }
}

const ClaimedDoor* Retrospect::findDoor(base::EntityId id) const {
  const auto found = std::ranges::find(claims.doors, id, &ClaimedDoor::id);
  return found == claims.doors.end() ? nullptr : &*found;
}

std::optional<base::Time> Retrospect::toldAt(const ClaimedSpace& bet) const {
  if (recalled_.contains(bet.id)) return bet.made;
  if (!bet.settled) return std::nullopt;
  const auto end = std::ranges::lower_bound(ends, *bet.settled);
  return end == ends.begin() ? bet.made : std::max(bet.made, *std::prev(end));
}

bool cameTrue(const ClaimedSpace& bet) {
  using map::PredictionState;
  return bet.settled && (bet.state == PredictionState::kConfirmed || bet.state == PredictionState::kMerged);
}

}  // namespace prodomos::evaluation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "query_json.hpp"

#include <nlohmann/json.hpp>

namespace prodomos::apps {

namespace {

using nlohmann::json;

template <typename T>
json orNull(const std::optional<T>& value) {
  return value ? json(*value) : json(nullptr);
}

template <typename Id>
json idsOf(const std::vector<Id>& ids) {
  json list = json::array();
  for (const auto id : ids) list.push_back(toString(id));
  return list;
}

json toJson(const geometry::Pose2& pose) {
  return {{"x", pose.x}, {"y", pose.y}, {"theta", pose.theta}};
}

/// The pose is that of the x-axis on the floor's plane, and the height of the entity's middle.
template <typename Attributes>
json ofSeen(const query::Seen<Attributes>& seen) {
  json answer = {{"id", toString(seen.id)},
                 {"submap", toString(seen.submap)},
                 {"floor", orNull(seen.floor)},
                 {"pose", toJson(geometry::toPose2(seen.T_map_entity))},
                 {"z", seen.T_map_entity.translation().z()},
                 {"confidence", seen.confidence},
                 {"last_seen", base::toString(seen.lastSeen)}};
  answer.update(json::parse(map::toJson(map::EntityAttributes(seen.attributes))));
  return answer;
}

}  // namespace

std::string_view toString(map::CellState state) {
  return state == map::CellState::kFree ? "free" : state == map::CellState::kOccupied ? "occupied" : "unknown";
}

json toJson(const query::PlaceAnswer& answer) {
  return {{"place", orNull(answer.place)},
          {"submap", answer.submap ? json(toString(*answer.submap)) : json(nullptr)},
          {"floor", orNull(answer.floor)},
          {"state", toString(answer.state)},
          {"probability", answer.probability}};
}

json toJson(const std::optional<query::Route>& route) {
  if (!route) return nullptr;
  return {{"length_m", route->length},
          {"probability", route->probability},
          {"submaps", idsOf(route->submaps)},
          {"edges", idsOf(route->edges)}};
}

json toJson(const query::FreeFloor& floor) {
  json outline = json::array();
  for (const auto& corner : floor.outline_in_map) outline.push_back({corner.x(), corner.y()});
  return {{"threshold", floor.threshold}, {"area_m2", floor.area}, {"outline", outline}};
}

json toJson(const query::PredictedRoom& room) {
  json free = json::array();
  for (const auto& floor : room.freeFloor) free.push_back({{"threshold", floor.threshold}, {"area_m2", floor.area}});
  return {{"node", toString(room.node)},
          {"prediction", toString(room.prediction)},
          {"cause", toString(room.cause)},
          {"door_state", room.doorState ? json(map::toString(*room.doorState)) : json(nullptr)},
          {"floor", orNull(room.floor)},
          {"probability", room.probability},
          {"expected_area_m2", room.expectedArea},
          {"free_floor", free},
          {"viewpoint", toJson(room.viewpoint_in_map)},
          {"viewpoint_is_free", room.isViewpointFree},
          {"blocked", room.blocked ? json(base::toString(*room.blocked)) : json(nullptr)},
          {"route", toJson(room.route)},
          {"gain_per_metre", orNull(room.gainPerMetre)}};
}

json toJson(const map::MapChanges& changes) {
  json events = json::array();
  for (const auto& event : changes.events) {
    events.push_back({{"time", base::toString(event.time)},
                      {"session", toString(event.session)},
                      {"kind", event.kind},
                      {"subject", event.subject},
                      {"payload", json::parse(event.payload)}});
  }
  return {{"revision", changes.revision},
          {"nodes", idsOf(changes.nodes)},
          {"edges", idsOf(changes.edges)},
          {"entities", idsOf(changes.entities)},
          {"predictions", idsOf(changes.predictions)},
          {"events", events}};
}

json toJson(const query::Seen<map::Door>& door) {
  return ofSeen(door);
}
json toJson(const query::Seen<map::Staircase>& stairs) {
  return ofSeen(stairs);
}
json toJson(const query::Seen<map::Human>& person) {
  return ofSeen(person);
}

}  // namespace prodomos::apps

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"

#include "query/places.hpp"
#include "query/routes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <sstream>
#include <tuple>

namespace prodomos::query {

namespace {

constexpr double kStandingDistance = 0.8;  // metres in front of a door or of stairs
constexpr double kLeastWay = 1.0;          // metres; nearer, nothing is gained by being nearer
constexpr double kSameThreshold = 1e-9;

/// Where nobody has seen floor: straight in front of a door, of a flight's foot or, where it descends, of its top.
geometry::Pose2 usualViewpoint(const map::Entity& cause) {
  const auto* stairs = std::get_if<map::Staircase>(&cause.attributes);
  const double turn = stairs != nullptr && stairs->height < 0.0 ? std::numbers::pi : 0.0;
  const double distance = kStandingDistance + map::runOf(cause).value_or(0.0) / 2.0;
  return geometry::toPose2(cause.T_submap_entity) * geometry::Pose2{0.0, 0.0, turn} *
         geometry::Pose2{-distance, 0.0, 0.0};
}

FreeFloor freeFloorOf(const map::MapView& view, const map::Prediction& prediction, const map::PredictedArea& area) {
  const auto outline = geometry::transformed(geometry::toPose2(view.T_map_node(prediction)), area.outline_in_node);
  return {area.threshold, std::abs(geometry::signedArea(outline)), outline};
}

PredictedRoom roomOf(const map::MapView& view, const map::Prediction& prediction, const map::Entity& cause) {
  PredictedRoom room{.node = prediction.node, .prediction = prediction.id, .cause = prediction.cause};
  if (const auto* door = std::get_if<map::Door>(&cause.attributes)) room.doorState = door->state;
  room.floor = view.graph().getNode(prediction.node).floor;
  room.probability = prediction.probability;
  room.expectedArea = prediction.expectedArea;
  room.blocked = prediction.blocked;
  for (const auto& area : prediction.areas) room.freeFloor.push_back(freeFloorOf(view, prediction, area));
  const auto T_map_submap = geometry::toPose2(view.graph().getNode(prediction.submap).T_map_submap);
  room.isViewpointFree = prediction.viewpoint_in_submap.has_value();
  room.viewpoint_in_map = T_map_submap * prediction.viewpoint_in_submap.value_or(usualViewpoint(cause));
  return room;
}

/// Best first.
auto rankOf(const PredictedRoom& room) {
  return std::tuple(room.blocked.has_value(), -room.gainPerMetre.value_or(0.0), -room.probability);
}

}  // namespace

std::vector<PredictedRoom> predictedRooms(const map::MapView& view, double leastProbability,
                                          std::optional<Position> from) {
  std::vector<PredictedRoom> rooms;
  std::vector<KnownSpot> viewpoints;
  for (const auto& prediction : view.predictions()) {
    const bool isRoom = view.graph().hasNode(prediction.node) && prediction.node != prediction.submap;
    const bool isOpen = prediction.state == map::PredictionState::kOpen;
    if (!isRoom || !isOpen || prediction.probability < leastProbability) continue;
    const auto cause = std::ranges::find(view.entities(), prediction.cause, &map::Entity::id);
    if (cause == view.entities().end()) continue;
    rooms.push_back(roomOf(view, prediction, *cause));
    const auto& viewpoint = rooms.back().viewpoint_in_map;
    viewpoints.push_back({{viewpoint.x, viewpoint.y, {}}, prediction.submap});
  }
  if (const auto start = from ? submapKnowing(view, *from) : std::nullopt) {
    auto routes = routesBetween(view, {*from, *start}, viewpoints);
    for (std::size_t i = 0; i < rooms.size(); ++i) {
      auto& room = rooms[i];
      room.route = std::move(routes[i]);
      if (!room.route) continue;
      room.gainPerMetre = room.probability * room.expectedArea / std::max(kLeastWay, room.route->length);
    }
  }
  std::ranges::stable_sort(rooms, {}, rankOf);
  return rooms;
}

std::vector<FreeFloor> freeFloor(const map::MapView& view, base::SubMapId node, double threshold) {
  std::vector<FreeFloor> found;
  std::set<double> others;
  for (const auto& prediction : view.predictions()) {
    if (prediction.node != node || prediction.state != map::PredictionState::kOpen) continue;
    for (const auto& area : prediction.areas) {
      if (std::abs(area.threshold - threshold) > kSameThreshold) {
        others.insert(area.threshold);
      } else {
        found.push_back(freeFloorOf(view, prediction, area));
      }
    }
  }
  if (found.empty() && !others.empty()) {
    std::ostringstream expected;
    for (const double other : others) expected << (other == *others.begin() ? "" : ", ") << other;
    std::ostringstream given;
    given << threshold;
    throw base::UsageError(base::expectedFound("threshold", "one of " + expected.str(), given.str()));
  }
  return found;
}

}  // namespace prodomos::query

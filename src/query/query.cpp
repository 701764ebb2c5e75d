// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/query/query.hpp"

#include <algorithm>
#include <functional>
#include <numbers>
#include <utility>

namespace prodomos::query {

namespace {

constexpr double kStandingDistance = 0.8;  // metres in front of a door or of stairs
constexpr double kFarthest = 1e4;          // metres; no sensor reaches farther from where its sub-map began

/// Where to stand to go through the entity that causes the prediction, looking there: in front of a door, of a flight's
/// foot or, where it descends, of its top.
geometry::Pose2 viewpointOf(const map::MapView& view, const map::Entity& cause) {
  const auto& submap = view.graph().getNode(cause.submap);
  const geometry::Pose2 entity = geometry::toPose2(submap.T_map_submap * cause.T_submap_entity);
  const auto* stairs = std::get_if<map::Staircase>(&cause.attributes);
  const double turn = stairs != nullptr && stairs->height < 0.0 ? std::numbers::pi : 0.0;
  const double distance = kStandingDistance + map::runOf(cause).value_or(0.0) / 2.0;
  return entity * geometry::Pose2{0.0, 0.0, turn} * geometry::Pose2{-distance, 0.0, 0.0};
}

Eigen::Vector2d inSubMap(const map::Node& node, const Position& position) {
  const auto at = inverse(geometry::toPose2(node.T_map_submap)) * geometry::Pose2{position.x, position.y, 0.0};
  return {at.x, at.y};
}

/// The observed ones of its floor that may know the spot, with their distance.
std::vector<std::pair<double, base::SubMapId>> nearestSubMaps(const map::MapView& view, const Position& position) {
  std::vector<std::pair<double, base::SubMapId>> found;
  for (const auto id : view.graph().nodes()) {
    const auto& node = view.graph().getNode(id);
    if (node.kind == map::SubMapKind::kPredicted) continue;
    if (position.floor && node.floor && node.floor != position.floor) continue;
    const double distance = inSubMap(node, position).norm();
    if (distance < kFarthest) found.emplace_back(distance, id);  // never true of what is not a number
  }
  std::ranges::sort(found);
  return found;
}

}  // namespace

std::vector<PredictedRoom> predictedRooms(const map::MapView& view, double leastProbability,
                                          std::optional<Position> from) {
  const auto start = from ? placeAt(view, *from).submap : std::nullopt;
  std::vector<PredictedRoom> rooms;
  for (const auto& prediction : view.predictions()) {
    if (prediction.state != map::PredictionState::kOpen || prediction.probability < leastProbability) continue;
    const auto cause = std::ranges::find(view.entities(), prediction.cause, &map::Entity::id);
    if (cause == view.entities().end() || !view.graph().hasNode(prediction.node)) continue;
    PredictedRoom room{prediction.node,           prediction.id,
                       prediction.cause,          view.graph().getNode(prediction.node).floor,
                       prediction.probability,    prediction.expectedArea,
                       viewpointOf(view, *cause), std::nullopt};
    if (start) room.route = view.graph().shortestRoute(*start, cause->submap);
    rooms.push_back(std::move(room));
  }
  std::ranges::stable_sort(rooms, std::greater<>(), &PredictedRoom::probability);
  return rooms;
}

PlaceAnswer placeAt(const map::MapView& view, const Position& position) {
  // Several sub-maps may know the spot: the one that began nearest has seen it best.
  for (const auto& [distance, id] : nearestSubMaps(view, position)) {
    const auto grid = view.findLayer<map::OccupancyGrid>(id);
    if (grid == nullptr) continue;
    const auto& node = view.graph().getNode(id);
    const auto cell = grid->cellAt(inSubMap(node, position));
    if (grid->state(cell) == map::CellState::kUnknown) continue;
    return {node.place, id, node.floor, grid->state(cell), grid->probability(cell)};
  }
  return {};
}

std::optional<map::Route> routeBetween(const map::MapView& view, const Position& from, const Position& to) {
  const auto start = placeAt(view, from).submap;
  const auto goal = placeAt(view, to).submap;
  if (!start || !goal) return std::nullopt;
  return view.graph().shortestRoute(*start, *goal);
}

}  // namespace prodomos::query

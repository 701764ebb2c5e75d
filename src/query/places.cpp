// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "query/places.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace prodomos::query {

namespace {

constexpr double kFarthest = 1e4;  // metres; no sensor reaches farther from where its sub-map began

/// The observed ones of its floor that may know the spot, with their distance.
std::vector<std::pair<double, base::SubMapId>> nearestSubMaps(const map::MapView& view, const Position& position) {
  std::vector<std::pair<double, base::SubMapId>> found;
  for (const auto id : view.graph().nodes()) {
    const auto& node = view.graph().getNode(id);
    if (node.kind == map::SubMapKind::kPredicted) continue;
    if (position.floor && node.floor && node.floor != position.floor) continue;
    const double distance = spotIn(node, position).norm();
    if (distance < kFarthest) found.emplace_back(distance, id);  // never true of what is not a number
  }
  std::ranges::sort(found);
  return found;
}

bool isWithin(const map::Prediction& prediction, const Eigen::Vector2d& point_in_node) {
  return geometry::contains(prediction.room_in_node, point_in_node) ||
         std::ranges::any_of(prediction.areas, [&](const map::PredictedArea& area) {
           return geometry::contains(area.outline_in_node, point_in_node);
         });
}

}  // namespace

Eigen::Vector2d spotIn(const map::Node& node, const Position& position) {
  return geometry::inverse(geometry::toPose2(node.T_map_submap)) * Eigen::Vector2d(position.x, position.y);
}

PlaceAnswer placeAt(const map::MapView& view, const Position& position, const map::PlaceMap* places) {
  // Several sub-maps may know the spot: the one that began nearest has seen it best.
  for (const auto& [distance, id] : nearestSubMaps(view, position)) {
    const auto grid = view.findLayer<map::OccupancyGrid>(id);
    if (grid == nullptr) continue;
    const auto& node = view.graph().getNode(id);
    const auto cell = grid->cellAt(spotIn(node, position));
    if (grid->state(cell) == map::CellState::kUnknown) continue;
    auto place = places == nullptr ? node.place : places->placeAt({position.x, position.y}, node.floor);
    return {place, id, node.floor, grid->state(cell), grid->probability(cell)};
  }
  return {};
}

std::optional<base::SubMapId> submapKnowing(const map::MapView& view, const Position& position) {
  if (const auto observed = placeAt(view, position).submap) return observed;
  for (const auto& prediction : view.predictions()) {
    const auto* const node = view.graph().findNode(prediction.node);
    if (node == nullptr || node->kind != map::SubMapKind::kPredicted) continue;
    if (position.floor && node->floor && node->floor != position.floor) continue;
    if (isWithin(prediction, spotIn(*node, position))) return node->id;
  }
  return std::nullopt;
}

}  // namespace prodomos::query

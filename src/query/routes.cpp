// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "query/routes.hpp"

#include "query/places.hpp"

#include <cmath>
#include <map>

namespace prodomos::query {

namespace {

/// Of the predicted sub-maps, that they are there.
std::map<base::SubMapId, double> probabilities(const map::MapView& view) {
  std::map<base::SubMapId, double> ofNode;
  for (const auto& prediction : view.predictions()) {
    const bool isOpen = prediction.state == map::PredictionState::kOpen && prediction.node != prediction.submap;
    if (isOpen) ofNode[prediction.node] = prediction.probability;
  }
  return ofNode;
}

}  // namespace

std::vector<std::optional<Route>> routesBetween(const map::MapView& view, const KnownSpot& from,
                                                const std::vector<KnownSpot>& to) {
  const auto& graph = view.graph();
  std::vector<base::SubMapId> goals;
  goals.reserve(to.size());
  for (const auto& spot : to) goals.push_back(spot.submap);
  const auto ofNode = probabilities(view);
  auto ways = graph.shortestRoutes(from.submap, goals);
  std::vector<std::optional<Route>> routes(to.size());
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (!ways[i]) continue;
    const auto& goal = to[i];
    // The origins of the first and the last sub-map may lie behind: within one, the way is straight.
    const double length = from.submap == goal.submap
                              ? std::hypot(goal.position.x - from.position.x, goal.position.y - from.position.y)
                              : spotIn(graph.getNode(from.submap), from.position).norm() + ways[i]->length +
                                    spotIn(graph.getNode(goal.submap), goal.position).norm();
    double probability = 1.0;
    for (const auto id : ways[i]->submaps) {
      if (const auto found = ofNode.find(id); found != ofNode.end()) probability *= found->second;
    }
    routes[i] = Route{std::move(ways[i]->submaps), std::move(ways[i]->edges), length, probability};
  }
  return routes;
}

std::optional<Route> routeBetween(const map::MapView& view, const Position& from, const Position& to) {
  const auto start = submapKnowing(view, from);
  const auto goal = submapKnowing(view, to);
  if (!start || !goal) return std::nullopt;
  return routesBetween(view, {from, *start}, {{to, *goal}}).front();
}

}  // namespace prodomos::query

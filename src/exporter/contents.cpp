// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/contents.hpp"

#include "exporter/text.hpp"

#include <algorithm>
#include <set>

namespace prodomos::exporter {

std::vector<std::optional<int>> floorsOf(const map::MapView& view) {
  std::set<std::optional<int>> floors;
  for (const auto id : view.graph().nodes()) floors.insert(view.graph().getNode(id).floor);
  if (floors.size() > 1) floors.erase(std::nullopt);  // what has no floor counts to every one
  if (floors.empty()) floors.insert(std::nullopt);
  return {floors.begin(), floors.end()};
}

bool onFloor(std::optional<int> floorOfThing, std::optional<int> plan) {
  return !floorOfThing || !plan || *floorOfThing == *plan;
}

std::string logNames(const map::MapView& view) {
  std::string names;
  for (const auto& session : view.sessions()) names += (names.empty() ? "" : " + ") + fileName(session.log);
  return names.empty() ? "prodomos map" : names;
}

Eigen::Quaterniond quaternionOf(const geometry::Pose3& pose) {
  Eigen::Quaterniond rotation(pose.linear());
  rotation.normalize();
  if (rotation.w() < 0.0) rotation.coeffs() = -rotation.coeffs();
  return rotation;
}

geometry::Pose3 poseInMap(const map::MapView& view, const map::Entity& entity) {
  return view.graph().getNode(entity.submap).T_map_submap * entity.T_submap_entity;
}

const map::Prediction* predictionOf(const map::MapView& view, base::SubMapId node) {
  const auto found = std::ranges::find_if(view.predictions(), [node](const auto& prediction) {
    return prediction.node == node && !prediction.isConditional();
  });
  return found == view.predictions().end() ? nullptr : &*found;
}

std::optional<int> floorOf(const map::MapView& view, const map::Prediction& prediction) {
  const auto* const node = view.graph().findNode(prediction.node);
  return node == nullptr ? view.graph().getNode(prediction.submap).floor : node->floor;
}

std::vector<map::Node> observedNodes(const map::MapView& view) {
  std::vector<map::Node> nodes;
  for (const auto id : view.graph().nodes()) {
    const auto& node = view.graph().getNode(id);
    if (node.kind == map::SubMapKind::kObserved) nodes.push_back(node);
  }
  return nodes;
}

std::vector<map::Edge> observedEdges(const map::MapView& view) {
  const auto& graph = view.graph();
  const auto observed = [&graph](base::SubMapId id) { return graph.getNode(id).kind == map::SubMapKind::kObserved; };
  std::vector<map::Edge> edges;
  for (const auto id : graph.edges()) {
    const auto& edge = graph.getEdge(id);
    if (observed(edge.from) && observed(edge.to)) edges.push_back(edge);
  }
  return edges;
}

std::vector<Trail> trailsOf(const map::MapView& view) {
  std::vector<Trail> trails;
  const auto finish = [&trails](Trail& trail) {
    if (trail.points_in_map.size() > 1) trails.push_back(trail);
    trail.points_in_map.clear();
  };
  for (const auto& track : view.tracks()) {
    if (track.className != "human") continue;
    Trail trail{.track = track.id};
    for (const auto& state : track.states) {
      const auto* node = view.graph().findNode(state.submap);
      if (node == nullptr) continue;
      if (trail.floor != node->floor) finish(trail);
      if (trail.points_in_map.empty()) trail.submap = node->id;
      trail.floor = node->floor;
      trail.points_in_map.emplace_back((node->T_map_submap * state.T_submap_thing).translation());
    }
    finish(trail);
  }
  return trails;
}

}  // namespace prodomos::exporter

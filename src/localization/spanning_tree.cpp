// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/pose_graph.hpp"

#include "localization/graph_index.hpp"

#include <algorithm>
#include <deque>
#include <optional>

namespace prodomos::localization {

namespace {

geometry::Pose2 inverted(const geometry::Pose2& pose) {
  return geometry::inverse(pose);
}

geometry::Pose3 inverted(const geometry::Pose3& pose) {
  return pose.inverse();
}

/// Constraints by the vertices at their ends.
struct Link {
  std::size_t constraint = 0;
  bool isForward = true;
};

template <typename Pose>
class SpanningTree {
 public:
  explicit SpanningTree(Graph<Pose>& graph)
      : graph_(graph), index_(graph), links_(graph.vertices.size()), isPlaced_(anchored(graph, index_)) {
    for (std::size_t i = 0; i < graph.constraints.size(); ++i) {
      const auto [from, to] = index_.ends(i);
      links_[from].push_back({i, true});
      links_[to].push_back({i, false});
    }
  }

  void grow() {
    std::deque<std::size_t> trusted;
    std::deque<std::size_t> doubtful;
    const auto enter = [&](std::size_t vertex) {
      trusted.push_back(vertex);
      doubtful.push_back(vertex);
    };
    for (std::size_t i = 0; i < isPlaced_.size(); ++i) {
      if (isPlaced_[i]) enter(i);
    }
    // All that trusted constraints reach, before the first doubtful one is followed.
    while (!trusted.empty() || !doubtful.empty()) {
      auto& queue = trusted.empty() ? doubtful : trusted;
      const bool follow = trusted.empty();
      const std::size_t vertex = queue.front();
      queue.pop_front();
      for (const auto& link : links_[vertex]) {
        if (graph_.constraints[link.constraint].isDoubtful != follow) continue;
        if (const auto reached = place(vertex, link)) enter(*reached);
      }
    }
  }

 private:
  std::optional<std::size_t> place(std::size_t vertex, const Link& link) {
    const auto [from, to] = index_.ends(link.constraint);
    const std::size_t reached = link.isForward ? to : from;
    if (isPlaced_[reached]) return std::nullopt;
    const Pose& T_from_to = graph_.constraints[link.constraint].T_from_to;
    graph_.vertices[reached].pose = graph_.vertices[vertex].pose * (link.isForward ? T_from_to : inverted(T_from_to));
    isPlaced_[reached] = true;
    return reached;
  }

  Graph<Pose>& graph_;
  GraphIndex index_;
  std::vector<std::vector<Link>> links_;
  std::vector<bool> isPlaced_;
};

}  // namespace

template <typename Pose>
void placeBySpanningTree(Graph<Pose>& graph) {
  SpanningTree<Pose>(graph).grow();
}

template <typename Pose>
int componentCount(const Graph<Pose>& graph) {
  const auto parts = partsOf(graph, GraphIndex(graph));
  return parts.empty() ? 0 : std::ranges::max(parts) + 1;
}

template void placeBySpanningTree(PlanarPoseGraph& graph);
template void placeBySpanningTree(PoseGraph& graph);
template int componentCount(const PlanarPoseGraph& graph);
template int componentCount(const PoseGraph& graph);

}  // namespace prodomos::localization

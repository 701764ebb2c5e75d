// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "localization/spanning_tree.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <utility>

namespace prodomos::localization {

namespace {

geometry::Pose2 inverted(const geometry::Pose2& pose) {
  return geometry::inverse(pose);
}

geometry::Pose3 inverted(const geometry::Pose3& pose) {
  return pose.inverse();
}

}  // namespace

template <typename Pose>
SpanningTree::SpanningTree(const Graph<Pose>& graph, Follow follow)
    : index_(graph),
      steps_(graph.vertices.size()),
      begins_(graph.vertices.size(), graph.vertices.size()),
      depths_(graph.vertices.size(), 0),
      jumps_(graph.vertices.size(), 0) {
  std::vector<std::vector<Step>> links(graph.vertices.size());
  for (std::size_t i = 0; i < graph.constraints.size(); ++i) {
    const auto [from, to] = index_.ends(i);
    links[from].push_back({from, i, true});
    links[to].push_back({to, i, false});
  }
  // Two queues: what doubtful constraints lead to is reached only once trusted ones lead nowhere any more.
  std::array<std::deque<std::size_t>, 2> queues;
  const auto isReached = [&](std::size_t vertex) { return begins_[vertex] < begins_.size(); };
  const auto reach = [&](std::size_t vertex, const Step* step) {
    enter(vertex, step);
    for (auto& queue : queues) queue.push_back(vertex);
  };
  const auto spread = [&] {
    while (!queues[0].empty() || (follow == Follow::kTrustedFirst && !queues[1].empty())) {
      const bool isDoubtful = queues[0].empty();
      auto& queue = queues[isDoubtful ? 1 : 0];
      const auto vertex = queue.front();
      queue.pop_front();
      for (const auto& link : links[vertex]) {
        const auto [from, to] = index_.ends(link.constraint);
        const auto next = link.isForward ? to : from;
        if (graph.constraints[link.constraint].isDoubtful != isDoubtful || isReached(next)) continue;
        reach(next, &link);
      }
    }
  };
  const auto isAnchored = anchored(graph, index_);
  for (std::size_t vertex = 0; vertex < begins_.size(); ++vertex) {
    if (isAnchored[vertex]) reach(vertex, nullptr);
  }
  spread();
  for (std::size_t vertex = 0; vertex < begins_.size(); ++vertex) {
    if (isReached(vertex)) continue;
    reach(vertex, nullptr);
    spread();
  }
}

void SpanningTree::enter(std::size_t vertex, const Step* step) {
  order_.push_back(vertex);
  if (step == nullptr) {
    begins_[vertex] = jumps_[vertex] = vertex;
    return;
  }
  const auto before = step->before;
  steps_[vertex] = *step;
  begins_[vertex] = begins_[before];
  depths_[vertex] = depths_[before] + 1;
  // Two jumps of one length make the next one twice as long (Myers, An applicative random-access stack, 1983).
  const auto jump = jumps_[before];
  const bool areEqual = depths_[before] - depths_[jump] == depths_[jump] - depths_[jumps_[jump]];
  jumps_[vertex] = areEqual ? jumps_[jump] : before;
}

std::size_t SpanningTree::meeting(std::size_t a, std::size_t b) const {
  if (depths_[a] < depths_[b]) std::swap(a, b);
  while (depths_[a] > depths_[b]) a = depths_[jumps_[a]] >= depths_[b] ? jumps_[a] : steps_[a]->before;
  // At one depth the jumps are of one length.
  while (a != b) {
    const bool canJump = jumps_[a] != jumps_[b];
    a = canJump ? jumps_[a] : steps_[a]->before;
    b = canJump ? jumps_[b] : steps_[b]->before;
  }
  return a;
}

template <typename Pose>
void placeBySpanningTree(Graph<Pose>& graph) {
  const SpanningTree tree(graph, Follow::kTrustedFirst);
  for (const auto vertex : tree.order()) {
    const auto& step = tree.stepTo(vertex);
    if (!step) continue;
    const Pose& T_from_to = graph.constraints[step->constraint].T_from_to;
    graph.vertices[vertex].pose =
        graph.vertices[step->before].pose * (step->isForward ? T_from_to : inverted(T_from_to));
  }
}

template <typename Pose>
int componentCount(const Graph<Pose>& graph) {
  const auto parts = partsOf(graph, GraphIndex(graph));
  return parts.empty() ? 0 : std::ranges::max(parts) + 1;
}

template SpanningTree::SpanningTree(const PlanarPoseGraph& graph, Follow follow);
template SpanningTree::SpanningTree(const PoseGraph& graph, Follow follow);
template void placeBySpanningTree(PlanarPoseGraph& graph);
template void placeBySpanningTree(PoseGraph& graph);
template int componentCount(const PlanarPoseGraph& graph);
template int componentCount(const PoseGraph& graph);

}  // namespace prodomos::localization

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "localization/graph_index.hpp"

#include "prodomos/base/error.hpp"

#include <algorithm>
#include <numeric>
#include <string>

namespace prodomos::localization {

template <typename Pose>
GraphIndex::GraphIndex(const Graph<Pose>& graph) {
  indexOfId_.reserve(graph.vertices.size());
  for (std::size_t i = 0; i < graph.vertices.size(); ++i) indexOfId_.emplace_back(graph.vertices[i].id, i);
  std::ranges::sort(indexOfId_);
  const auto twice = std::ranges::adjacent_find(indexOfId_, {}, [](const auto& entry) { return entry.first; });
  if (twice != indexOfId_.end()) {
    throw base::Error(base::expectedFound("vertex " + std::to_string(twice->first), "an id of its own", "it twice"));
  }
  ends_.reserve(graph.constraints.size());
  for (const auto& constraint : graph.constraints) ends_.emplace_back(at(constraint.from), at(constraint.to));
}

std::size_t GraphIndex::at(std::int64_t id) const {
  // Ids mostly count up from the first.
  const auto first = indexOfId_.empty() ? 0 : indexOfId_.front().first;
  const auto guess = static_cast<std::uint64_t>(id) - static_cast<std::uint64_t>(first);
  if (guess < indexOfId_.size() && indexOfId_[guess].first == id) return indexOfId_[guess].second;
  const auto found = std::ranges::lower_bound(indexOfId_, id, {}, [](const auto& entry) { return entry.first; });
  if (found == indexOfId_.end() || found->first != id) {
    throw base::Error(base::expectedFound("pose graph", "a vertex " + std::to_string(id), "none"));
  }
  return found->second;
}

template <typename Pose>
std::vector<int> partsOf(const Graph<Pose>& graph, const GraphIndex& index) {
  // Union by the lesser index: a part is named by its first vertex.
  std::vector<std::size_t> leader(graph.vertices.size());
  std::iota(leader.begin(), leader.end(), std::size_t{0});
  const auto find = [&](std::size_t vertex) {
    while (leader[vertex] != vertex) vertex = leader[vertex] = leader[leader[vertex]];
    return vertex;
  };
  for (std::size_t i = 0; i < graph.constraints.size(); ++i) {
    const auto [from, to] = index.ends(i);
    const auto [first, second] = std::minmax({find(from), find(to)});
    leader[second] = first;
  }
  std::vector<int> parts(graph.vertices.size());
  int count = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = find(i) == i ? count++ : parts[find(i)];
  return parts;
}

template <typename Pose>
std::vector<bool> anchored(const Graph<Pose>& graph, const GraphIndex& index) {
  const auto parts = partsOf(graph, index);
  std::vector<bool> isHeld(parts.empty() ? 0 : static_cast<std::size_t>(std::ranges::max(parts)) + 1, false);
  std::vector<bool> isFixed(parts.size(), false);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    isFixed[i] = graph.vertices[i].isFixed;
    if (isFixed[i]) isHeld[static_cast<std::size_t>(parts[i])] = true;
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto part = static_cast<std::size_t>(parts[i]);
    if (!isHeld[part]) isFixed[i] = isHeld[part] = true;
  }
  return isFixed;
}

template GraphIndex::GraphIndex(const Graph<geometry::Pose2>& graph);
template GraphIndex::GraphIndex(const Graph<geometry::Pose3>& graph);
template std::vector<int> partsOf(const Graph<geometry::Pose2>& graph, const GraphIndex& index);
template std::vector<int> partsOf(const Graph<geometry::Pose3>& graph, const GraphIndex& index);
template std::vector<bool> anchored(const Graph<geometry::Pose2>& graph, const GraphIndex& index);
template std::vector<bool> anchored(const Graph<geometry::Pose3>& graph, const GraphIndex& index);

}  // namespace prodomos::localization

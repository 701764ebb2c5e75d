// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/localization/pose_graph.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace prodomos::localization {

/// Vertices by their place in the graph instead of their id.
class GraphIndex {
 public:
  /// Throws base::Error where an id is taken twice or a constraint's end is missing.
  template <typename Pose>
  explicit GraphIndex(const Graph<Pose>& graph);

  /// Throws base::Error where there is none.
  std::size_t at(std::int64_t id) const;
  /// From and to of a constraint.
  std::pair<std::size_t, std::size_t> ends(std::size_t constraint) const { return ends_[constraint]; }

 private:
  std::vector<std::pair<std::int64_t, std::size_t>> indexOfId_;  ///< ascending
  std::vector<std::pair<std::size_t, std::size_t>> ends_;
};

/// Of each vertex the number of the part of the graph that it is in; parts count from 0 by their first vertices.
template <typename Pose>
std::vector<int> partsOf(const Graph<Pose>& graph, const GraphIndex& index);

/// Of each vertex whether it stays: those that the graph fixes, and the first of each part without any.
template <typename Pose>
std::vector<bool> anchored(const Graph<Pose>& graph, const GraphIndex& index);

}  // namespace prodomos::localization

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/localization/pose_graph.hpp"

#include "localization/graph_index.hpp"

#include <optional>
#include <vector>

namespace prodomos::localization {

enum class Follow { kTrustedOnly, kTrustedFirst };

/// Ways from the anchored vertices to all others, breadth first. Where only trusted constraints are followed, parts
/// that they do not reach begin with their first vertex.
class SpanningTree {
 public:
  struct Step {
    std::size_t before = 0;
    std::size_t constraint = 0;
    bool isForward = true;  ///< along the constraint, from its `from`
  };

  template <typename Pose>
  explicit SpanningTree(const Graph<Pose>& graph, Follow follow = Follow::kTrustedOnly);

  const GraphIndex& index() const { return index_; }
  /// All vertices, each after the one that leads to it.
  const std::vector<std::size_t>& order() const { return order_; }
  /// None for where a way begins.
  const std::optional<Step>& stepTo(std::size_t vertex) const { return steps_[vertex]; }
  /// Where the ways to two vertices of the same part divide; takes steps as the logarithm of their length.
  std::size_t meeting(std::size_t a, std::size_t b) const;
  /// The first vertex of its way.
  std::size_t part(std::size_t vertex) const { return begins_[vertex]; }

 private:
  void enter(std::size_t vertex, const Step* step);

  GraphIndex index_;
  std::vector<std::size_t> order_;
  std::vector<std::optional<Step>> steps_;
  std::vector<std::size_t> begins_;
  std::vector<std::size_t> depths_;
  std::vector<std::size_t> jumps_;  ///< far back along the way, such that any vertex is a few jumps away
};

}  // namespace prodomos::localization

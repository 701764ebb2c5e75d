// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/localization/pose_graph.hpp"

#include <cstddef>
#include <vector>

namespace prodomos::localization {

struct ConsistencyConfig {
  /// Two true loops are taken for contradicting each other so often.
  double rejectedTruePairs = 0.01;
};

/// The largest set of doubtful constraints of which each two agree: going one loop, the trusted way, the other loop
/// back, and the trusted way again leads to the start, but for what the information of all of these lets expect
/// (pairwise consistency maximization: Mangelson et al., ICRA 2018). The trusted way is that of the spanning tree of
/// placeBySpanningTree(), so that poses do not matter; its two stretches are taken as independent. False loops agree
/// with each other by chance alone, so true ones outvote them even where they are few.
///
/// Indices into graph.constraints, ascending. Loops whose ends no trusted way joins are judged within the parts that
/// they join; a loop that nothing can be compared with counts as a set of one. The same input gives the same set.
/// Throws base::Error as optimize() does.
std::vector<std::size_t> consistentLoops(const PoseGraph& graph, const ConsistencyConfig& config = {});

}  // namespace prodomos::localization

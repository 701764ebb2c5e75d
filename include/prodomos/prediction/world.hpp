// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/entity.hpp"
#include "prodomos/map/records.hpp"
#include "prodomos/map/topological_graph.hpp"
#include "prodomos/prediction/surroundings.hpp"

#include <functional>
#include <span>
#include <vector>

namespace prodomos::prediction {

/// What is known now, at the end of a sub-map.
struct World {
  base::Time now{};
  base::SessionId session;
  std::span<const map::Entity> entities;  ///< all that are believed
  std::span<const map::Node> nodes;       ///< observed sub-maps, where they lie now
  /// Grids that may know something about a spot.
  std::function<std::vector<PlacedGrid>(const Eigen::Vector3d& spot_in_map)> gridsNear;
  std::function<base::SubMapId()> newNodeId;
  std::function<base::EdgeId()> newEdgeId;
  std::span<const map::Track> tracks{};  ///< where people were since the last time
};

}  // namespace prodomos::prediction

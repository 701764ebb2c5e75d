// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/map_store.hpp"
#include "prodomos/perception/perception.hpp"
#include "prodomos/prediction/surroundings.hpp"

#include "mapper/graph_refiner.hpp"

#include <deque>
#include <memory>
#include <optional>
#include <utility>

namespace prodomos::mapper {

/// What is known around a sub-map: its grid, and what those of its neighbours add. Who passes a doorway sees one side
/// of it in one sub-map and the other side in the next.
class Surroundings {
 public:
  /// Reads finished sub-maps from the store, and where they lie from the graph. Both must outlive this.
  Surroundings(const map::MapStore& store, const GraphRefiner& graph) : store_(store), graph_(graph) {}

  /// None where the sub-map has no grid. `running`: the one that is not in the store yet.
  std::optional<perception::Perception::Surroundings> of(base::SubMapId submap, const map::SubMap& running);
  /// Of the sub-maps that began nearest to a spot of the map, and may know something about it.
  std::vector<prediction::PlacedGrid> gridsNear(const Eigen::Vector3d& spot_in_map, const map::SubMap& running);

 private:
  using Grid = std::shared_ptr<const map::OccupancyGrid>;
  Grid gridOf(base::SubMapId submap, const map::SubMap& running);

  const map::MapStore& store_;
  const GraphRefiner& graph_;
  std::deque<std::pair<base::SubMapId, Grid>> recent_;  // reading a grid takes longer than merging it
};

}  // namespace prodomos::mapper

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/fused_grid.hpp"

namespace prodomos::map {

OccupancyGrid fuseGrids(const MapView& view, std::optional<int> floor) {
  std::optional<OccupancyGrid> fused;
  for (const auto id : view.graph().nodes()) {
    const auto& node = view.graph().getNode(id);
    if (node.kind == SubMapKind::kPredicted || (floor && node.floor && node.floor != floor)) continue;
    const auto grid = view.findLayer<OccupancyGrid>(id);
    if (grid == nullptr) continue;
    if (!fused) fused = OccupancyGrid(grid->config());
    fused->merge(*grid, node.T_map_submap);
  }
  return fused.value_or(OccupancyGrid());
}

}  // namespace prodomos::map

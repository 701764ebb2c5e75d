// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/surroundings.hpp"

#include <algorithm>

namespace prodomos::mapper {

namespace {

constexpr double kReach = 8.0;          // metres between the origins of neighbours
constexpr std::size_t kNeighbours = 3;  // the nearest; each one's pose is a little off, and blurs walls
constexpr double kMargin = 3.0;         // metres around what the sub-map knows itself
constexpr std::size_t kRecent = 24;

constexpr double kFarthest = 20.0;      // metres from where a sub-map began to what it tells
constexpr std::size_t kMostGrids = 12;  // the nearest have seen a spot best

geometry::CellBox grown(geometry::CellBox box, double cells) {
  const int margin = static_cast<int>(cells);
  return {{box.first.x - margin, box.first.y - margin}, {box.last.x + margin, box.last.y + margin}};
}

}  // namespace

std::optional<perception::Perception::Surroundings> Surroundings::of(base::SubMapId submap,
                                                                     const map::SubMap& running) {
  const auto& node = graph_.node(submap);
  const auto own = gridOf(submap, running);
  if (own == nullptr) return std::nullopt;
  perception::Perception::Surroundings around{submap, *own, node.begin, node.end};
  const auto limits = grown(own->knownBox(), kMargin / own->resolution());
  for (const auto& neighbour : graph_.nearest(submap, kReach, kNeighbours)) {
    const auto grid = gridOf(neighbour.id, running);
    if (grid == nullptr) continue;
    around.grid.mergeWithin(limits, *grid, node.T_map_submap.inverse() * neighbour.T_map_submap);
    around.begin = std::min(around.begin, neighbour.begin);
    around.end = std::max(around.end, neighbour.end);
  }
  return around;
}

std::vector<prediction::PlacedGrid> Surroundings::gridsNear(const Eigen::Vector3d& spot_in_map,
                                                            const map::SubMap& running) {
  auto nodes = graph_.nodes();
  const auto distanceTo = [&](const map::Node& node) { return (node.T_map_submap.translation() - spot_in_map).norm(); };
  std::erase_if(nodes, [&](const map::Node& node) { return distanceTo(node) > kFarthest; });
  std::ranges::stable_sort(nodes, {}, distanceTo);
  if (nodes.size() > kMostGrids) nodes.resize(kMostGrids);
  std::vector<prediction::PlacedGrid> grids;
  for (const auto& node : nodes) {
    if (auto grid = gridOf(node.id, running)) grids.push_back({node.id, node.T_map_submap, std::move(grid)});
  }
  return grids;
}

Surroundings::Grid Surroundings::gridOf(base::SubMapId submap, const map::SubMap& running) {
  if (submap == running.node.id) return {Grid(), running.findLayer<map::OccupancyGrid>()};  // owned by the sub-map
  const auto known = std::ranges::find(recent_, submap, &std::pair<base::SubMapId, Grid>::first);
  if (known != recent_.end()) return known->second;
  Grid grid = std::dynamic_pointer_cast<const map::OccupancyGrid>(
      std::shared_ptr<const map::MapLayer>(store_.findLayer(submap, map::OccupancyGrid::kTypeId)));
  recent_.emplace_back(submap, grid);
  if (recent_.size() > kRecent) recent_.pop_front();
  return grid;
}

}  // namespace prodomos::mapper

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/cells.hpp"
#include "prodomos/map/occupancy_grid.hpp"

#include <memory>
#include <vector>

namespace prodomos::test {

/// What a robot has seen of rooms: their floor is free, and a wall of one cell stands around it but for where nobody
/// looked.
inline std::shared_ptr<const map::OccupancyGrid> seenFloor(const std::vector<geometry::Polygon>& floors,
                                                           const std::vector<geometry::Polygon>& unseen = {}) {
  using geometry::CellIndex;
  geometry::CellBox box = geometry::boxOf(floors);
  box.add({box.first.x - 1, box.first.y - 1});
  box.add({box.last.x + 1, box.last.y + 1});
  geometry::CellMap<int> isFree(box, 0);
  for (const auto& floor : floors) isFree.fill(floor, 1);
  geometry::CellMap<int> isSeen(box, 1);
  for (const auto& part : unseen) isSeen.fill(part, 0);

  map::OccupancyGridConfig config;
  config.resolution = geometry::kCell;
  auto grid = std::make_shared<map::OccupancyGrid>(config);
  evaluation::visitCells(box, [&](CellIndex cell) {
    bool isBeside = false;
    evaluation::visitCells({{cell.x - 1, cell.y - 1}, {cell.x + 1, cell.y + 1}},
                           [&](CellIndex near) { isBeside |= isFree.at(near) != 0; });
    const bool isWall = isFree.at(cell) == 0;
    if (!isBeside || isSeen.at(cell) == 0) return;
    const map::OccupancyGrid::Beam beam{.end = geometry::centreOf(cell), .hit = isWall};
    grid->insert(beam.end, {&beam, 1});
  });
  return grid;
}

}  // namespace prodomos::test

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/known_space.hpp"

#include "prodomos/evaluation/alignment.hpp"

#include <algorithm>
#include <limits>

namespace prodomos::evaluation {

namespace {

/// The known part of a grid, as a rectangle of the world.
Polygon outlineOf(const KnownGrid& known) {
  const auto box = known.grid->knownBox();
  if (box.empty()) return {};
  const double size = known.grid->resolution();
  return boxBehind(known.T_world_grid, (box.last.y + 1) * size, box.first.y * size, box.first.x * size,
                   (box.last.x + 1) * size);
}

}  // namespace

KnownSpace::KnownSpace(std::vector<KnownGrid> grids) {
  std::ranges::stable_sort(grids, {}, &KnownGrid::begin);
  std::map<int, std::vector<Polygon>> outlines;
  for (const auto& grid : grids) outlines[grid.storey].push_back(outlineOf(grid));
  for (const auto& [storey, polygons] : outlines) cellsOfStorey_.emplace(storey, CellMap<Cell>(boxOf(polygons), {}));
  for (const auto& grid : grids) {
    begins_.push_back(grid.begin);
    add(static_cast<std::int32_t>(begins_.size()) - 1, grid);
  }
}

void KnownSpace::add(std::int32_t number, const KnownGrid& known) {
  auto& cells = cellsOfStorey_.at(known.storey);
  const auto T_grid_world = geometry::inverse(known.T_world_grid);
  for (const auto index : cellsIn(outlineOf(known))) {
    const auto centre = centreOf(index);
    const auto inGrid = T_grid_world * geometry::Pose2{centre.x(), centre.y(), 0.0};
    const auto value = known.grid->cell(known.grid->cellAt({inGrid.x, inGrid.y}));
    Cell* cell = cells.find(index);
    if (value == map::OccupancyGrid::kUnknownCell || cell == nullptr) continue;
    if (cell->since < 0) cell->since = number;
    cell->evidence += value;
  }
}

bool KnownSpace::isKnown(int storey, geometry::CellIndex cell, base::Time at) const {
  const auto cells = cellsOfStorey_.find(storey);
  if (cells == cellsOfStorey_.end()) return false;
  const auto since = cells->second.at(cell).since;
  return since >= 0 && begins_[static_cast<std::size_t>(since)] <= at;
}

bool KnownSpace::isKnown(int storey, geometry::CellIndex cell) const {
  return isKnown(storey, cell, base::Time::max());
}

bool KnownSpace::isFree(int storey, geometry::CellIndex cell) const {
  const auto cells = cellsOfStorey_.find(storey);
  if (cells == cellsOfStorey_.end()) return false;
  const auto& found = cells->second.at(cell);
  return found.since >= 0 && found.evidence < 0;
}

double KnownSpace::freeArea() const {
  std::size_t count = 0;
  for (const auto& [storey, cells] : cellsOfStorey_) {
    const auto& box = cells.box();
    for (int y = box.first.y; y <= box.last.y; ++y) {
      for (int x = box.first.x; x <= box.last.x; ++x) count += isFree(storey, {x, y}) ? 1U : 0U;
    }
  }
  return static_cast<double>(count) * kCell * kCell;
}

KnownSpace knownSpaceOf(const map::MapView& view, const Truth& truth) {
  std::vector<KnownGrid> grids;
  for (const auto& [id, T_world_submap] : truthFromSubMaps(view, truth)) {
    auto grid = view.findLayer<map::OccupancyGrid>(id);
    if (!grid) continue;
    grids.push_back({storeyAt(truth, T_world_submap.translation().z()), view.graph().getNode(id).begin,
                     geometry::toPose2(T_world_submap), std::move(grid)});
  }
  return KnownSpace(std::move(grids));
}

}  // namespace prodomos::evaluation

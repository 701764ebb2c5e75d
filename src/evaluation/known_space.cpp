// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/known_space.hpp"

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
  std::ranges::stable_sort(grids, {}, &KnownGrid::since);
  std::map<int, std::vector<Polygon>> outlines;
  for (const auto& grid : grids) outlines[grid.storey].push_back(outlineOf(grid));
  for (const auto& [storey, polygons] : outlines) cellsOfStorey_.emplace(storey, CellMap<Cell>(boxOf(polygons), {}));
  for (const auto& grid : grids) {
    times_.push_back(grid.since);
    add(static_cast<std::int32_t>(times_.size()) - 1, grid);
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
  return since >= 0 && times_[static_cast<std::size_t>(since)] <= at;
}

bool KnownSpace::isKnown(int storey, geometry::CellIndex cell) const {
  return isKnown(storey, cell, base::Time::max());
}

map::CellState KnownSpace::state(int storey, geometry::CellIndex cell) const {
  const auto cells = cellsOfStorey_.find(storey);
  if (cells == cellsOfStorey_.end()) return map::CellState::kUnknown;
  const auto found = cells->second.at(cell);
  if (found.since < 0) return map::CellState::kUnknown;
  return found.evidence < 0 ? map::CellState::kFree : map::CellState::kOccupied;
}

std::vector<int> KnownSpace::storeys() const {
  std::vector<int> storeys;
  for (const auto& [storey, cells] : cellsOfStorey_) storeys.push_back(storey);
  return storeys;
}

geometry::CellBox KnownSpace::box(int storey) const {
  const auto cells = cellsOfStorey_.find(storey);
  return cells == cellsOfStorey_.end() ? geometry::CellBox{} : cells->second.box();
}

double KnownSpace::freeArea() const {
  std::size_t count = 0;
  for (const auto& [storey, cells] : cellsOfStorey_) {
    const int floor = storey;  // which clang 14 does not let a lambda capture by its binding
    visitCells(cells.box(), [&](geometry::CellIndex cell) { count += isFree(floor, cell) ? 1U : 0U; });
  }
  return static_cast<double>(count) * kCell * kCell;
}

KnownSpace knownSpaceOf(const map::MapView& view, const Placement& placement, base::Time map::Node::*since) {
  std::vector<KnownGrid> grids;
  for (const auto& [id, T_world_submap] : placement.T_world_submap) {
    auto grid = view.findLayer<map::OccupancyGrid>(id);
    if (!grid) continue;
    grids.push_back({placement.storeyAt(T_world_submap.translation().z()), view.graph().getNode(id).*since,
                     geometry::toPose2(T_world_submap), std::move(grid)});
  }
  return KnownSpace(std::move(grids));
}

KnownSpace knownSpaceOf(const map::MapView& view, const Truth& truth) {
  return knownSpaceOf(view, placementOf(view, truth), &map::Node::begin);
}

}  // namespace prodomos::evaluation

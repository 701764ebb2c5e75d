// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/alignment.hpp"
#include "prodomos/evaluation/cells.hpp"
#include "prodomos/evaluation/truth.hpp"
#include "prodomos/map/map_view.hpp"
#include "prodomos/map/occupancy_grid.hpp"

#include <map>
#include <memory>
#include <vector>

namespace prodomos::evaluation {

/// The grid of a sub-map, in the world.
struct KnownGrid {
  int storey = 0;
  base::Time since{};  ///< all that it knows counts as known from then on
  geometry::Pose2 T_world_grid;
  std::shared_ptr<const map::OccupancyGrid> grid;
};

/// Which cells of the world a map has observed, and since when: a map's grids tell the time of a cell to the sub-map,
/// so a cell counts as known since the time of the first grid that knows it.
class KnownSpace {
 public:
  KnownSpace() = default;
  explicit KnownSpace(std::vector<KnownGrid> grids);

  bool isKnown(int storey, geometry::CellIndex cell, base::Time at) const;
  bool isKnown(int storey, geometry::CellIndex cell) const;  ///< ever
  /// By all grids together, in the end.
  map::CellState state(int storey, geometry::CellIndex cell) const;
  bool isFree(int storey, geometry::CellIndex cell) const { return state(storey, cell) == map::CellState::kFree; }
  double freeArea() const;                  ///< m², of all storeys
  std::vector<int> storeys() const;         ///< ascending; those that a grid shows
  geometry::CellBox box(int storey) const;  ///< of all known cells; empty where there are none

 private:
  struct Cell {
    std::int32_t since = -1;    ///< index of the first grid that knows it
    std::int32_t evidence = 0;  ///< sum of log-odds
  };

  void add(std::int32_t number, const KnownGrid& known);

  std::vector<base::Time> times_;  ///< of the grids, ascending
  std::map<int, CellMap<Cell>> cellsOfStorey_;
};

/// Of all observed sub-maps with a grid; a cell is known since the first that knows it began, or ended.
KnownSpace knownSpaceOf(const map::MapView& view, const Placement& placement, base::Time map::Node::*since);
/// Since they began, in the world of the truth. Throws base::Error where map and truth have no time in common.
KnownSpace knownSpaceOf(const map::MapView& view, const Truth& truth);

}  // namespace prodomos::evaluation

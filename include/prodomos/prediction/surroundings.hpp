// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/id.hpp"
#include "prodomos/geometry/cells.hpp"
#include "prodomos/map/occupancy_grid.hpp"

#include <memory>
#include <span>
#include <vector>

namespace prodomos::prediction {

/// The grid of an observed sub-map.
struct PlacedGrid {
  base::SubMapId submap;
  geometry::Pose3 T_map_submap = geometry::Pose3::Identity();
  std::shared_ptr<const map::OccupancyGrid> grid;
};

/// Another door or doorway of the same floor.
struct Opening {
  base::EntityId id;
  geometry::Pose2 T_here_opening;  ///< middle of the leaf; the x-axis points to its far side
  double width = 0.0;              ///< metres
  bool hasLeaf = true;
};

/// What is known around an entity, told in a frame of its own (`here`): on the floor, z up; of a door the origin is the
/// middle of the leaf and x points to the far side, of a staircase the origin is the end that was not seen and x points
/// the way that one walks there. y points to the left.
class Surroundings {
 public:
  /// Metres, of a cell's side.
  static constexpr double kCell = 0.1;
  /// Cells that are looked at; all others are unknown. Metres: 6 behind the origin, 12 ahead, 9 to either side.
  static constexpr geometry::CellBox kBox{{-60, -90}, {119, 89}};

  /// Nothing is known there.
  Surroundings() : Surroundings(geometry::Pose3::Identity(), {}) {}
  /// Grids whose sub-map's floor lies within `kSameFloor` of the height of `here`; the sum of their evidence decides.
  Surroundings(const geometry::Pose3& T_map_here, std::span<const PlacedGrid> grids);

  static constexpr double kSameFloor = 1.0;  ///< metres

  const geometry::Pose3& T_map_here() const { return T_map_here_; }
  map::CellState state(geometry::CellIndex cell) const { return cells_.at(cell); }
  map::CellState state(const Eigen::Vector2d& point_in_here) const {
    return state(geometry::cellAt(point_in_here.x(), point_in_here.y(), kCell));
  }
  bool isAnythingKnown() const;
  /// For what else is known, and for worlds of tests and of floor plans.
  void set(geometry::CellIndex cell, map::CellState state);

  std::vector<Opening> openings;              ///< without the entity's own
  std::vector<geometry::Polygon> taken_here;  ///< rooms that are predicted behind others of these

 private:
  geometry::Pose3 T_map_here_;
  geometry::CellMap<map::CellState> cells_;
};

}  // namespace prodomos::prediction

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/grid_index.hpp"
#include "prodomos/geometry/polygon.hpp"

#include <Eigen/Core>

#include <vector>

/// Shapes as sets of small square cells: where polygons are cut, joined and measured. A cell belongs to a shape where
/// its centre does.
namespace prodomos::geometry {

inline constexpr double kCell = 0.05;  ///< metres, of a cell's side where no other is asked for

/// Those of an endless grid at the origin whose centres lie in the polygon (even-odd), row by row; none where a corner
/// is not finite.
std::vector<CellIndex> cellsIn(const Polygon& polygon, double resolution = kCell);

Eigen::Vector2d centreOf(CellIndex cell, double resolution = kCell);

/// Of all polygons; empty where there is no corner.
CellBox boxOf(const std::vector<Polygon>& polygons, double resolution = kCell);

/// A value for each cell of a box, `outside` for all others.
template <typename Value>
class CellMap {
 public:
  CellMap() = default;
  CellMap(const CellBox& box, Value outside)
      : box_(box),
        outside_(outside),
        values_(box.empty() ? 0 : static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height()),
                outside) {}

  const CellBox& box() const { return box_; }
  Value at(CellIndex cell) const { return box_.contains(cell) ? values_[index(cell)] : outside_; }
  /// Null outside of the box.
  Value* find(CellIndex cell) { return box_.contains(cell) ? &values_[index(cell)] : nullptr; }
  void fill(const Polygon& polygon, Value value, double resolution = kCell) {
    for (const auto cell : cellsIn(polygon, resolution)) {
      if (Value* found = find(cell)) *found = value;
    }
  }

 private:
  std::size_t index(CellIndex cell) const {
    return static_cast<std::size_t>(cell.y - box_.first.y) * static_cast<std::size_t>(box_.width()) +
           static_cast<std::size_t>(cell.x - box_.first.x);
  }

  CellBox box_;
  Value outside_{};
  std::vector<Value> values_;
};

}  // namespace prodomos::geometry

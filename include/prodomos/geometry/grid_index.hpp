// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <compare>

namespace prodomos::geometry {

/// A cell of an endless grid: covers [x, x + 1) x [y, y + 1) in units of its resolution.
struct CellIndex {
  int x = 0;
  int y = 0;

  auto operator<=>(const CellIndex&) const = default;
};

inline CellIndex cellAt(double x, double y, double resolution) {
  return {static_cast<int>(std::floor(x / resolution)), static_cast<int>(std::floor(y / resolution))};
}

inline double cellCentre(int index, double resolution) {
  return (index + 0.5) * resolution;
}

/// Cells first.x … last.x by first.y … last.y, both included; empty where last lies before first.
struct CellBox {
  CellIndex first;
  CellIndex last{-1, -1};

  bool empty() const { return last.x < first.x || last.y < first.y; }
  int width() const { return last.x - first.x + 1; }
  int height() const { return last.y - first.y + 1; }
  bool contains(CellIndex cell) const {
    return cell.x >= first.x && cell.x <= last.x && cell.y >= first.y && cell.y <= last.y;
  }
  void add(CellIndex cell) {
    if (empty()) {
      first = last = cell;
      return;
    }
    if (cell.x < first.x) first.x = cell.x;
    if (cell.y < first.y) first.y = cell.y;
    if (cell.x > last.x) last.x = cell.x;
    if (cell.y > last.y) last.y = cell.y;
  }
  bool operator==(const CellBox&) const = default;
};

}  // namespace prodomos::geometry

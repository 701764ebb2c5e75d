// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/cells.hpp"

#include <algorithm>
#include <cmath>

namespace prodomos::geometry {

namespace {

constexpr double kFarthest = 1e4;  // metres; nothing indoors lies farther away

bool isSensible(const Polygon& polygon) {
  return polygon.size() >= 3 && std::ranges::all_of(polygon, [](const Eigen::Vector2d& corner) {
           return corner.allFinite() && corner.cwiseAbs().maxCoeff() < kFarthest;
         });
}

/// Where the edges cross the line at that height, ascending.
std::vector<double> crossings(const Polygon& polygon, double y) {
  std::vector<double> x;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto& a = polygon[i];
    const auto& b = polygon[(i + 1) % polygon.size()];
    if ((a.y() <= y) == (b.y() <= y)) continue;
    x.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
  }
  std::ranges::sort(x);
  return x;
}

/// The first cell whose centre does not lie below the coordinate.
int firstFrom(double coordinate, double resolution) {
  return static_cast<int>(std::ceil(coordinate / resolution - 0.5));
}

}  // namespace

std::vector<CellIndex> cellsIn(const Polygon& polygon, double resolution) {
  std::vector<CellIndex> cells;
  if (!isSensible(polygon)) return cells;
  const auto [lowest, highest] =
      std::ranges::minmax_element(polygon, {}, [](const auto& corner) { return corner.y(); });
  const int end = firstFrom(highest->y(), resolution);
  for (int y = firstFrom(lowest->y(), resolution); y < end; ++y) {
    const auto x = crossings(polygon, cellCentre(y, resolution));
    for (std::size_t i = 0; i + 1 < x.size(); i += 2) {
      const int last = firstFrom(x[i + 1], resolution);
      for (int column = firstFrom(x[i], resolution); column < last; ++column) cells.push_back({column, y});
    }
  }
  return cells;
}

Eigen::Vector2d centreOf(CellIndex cell, double resolution) {
  return {cellCentre(cell.x, resolution), cellCentre(cell.y, resolution)};
}

CellBox boxOf(const std::vector<Polygon>& polygons, double resolution) {
  CellBox box;
  for (const auto& polygon : polygons) {
    if (!isSensible(polygon)) continue;
    for (const auto& corner : polygon) box.add(cellAt(corner.x(), corner.y(), resolution));
  }
  return box;
}

}  // namespace prodomos::geometry

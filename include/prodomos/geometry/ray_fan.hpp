// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/grid_index.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace prodomos::geometry {

/// The cells that a fan of rays from one point passes, each of them once.
///
/// Rays of a scan overlap near the sensor: walked one by one, most cells are visited many times. Here the grid is swept
/// row by row instead. In a row, neighbouring rays whose gap is narrower than a cell leave no cell between them
/// untouched, so a whole run of them is one span, known from its first and its last ray alone. Runs only ever split:
/// where a gap grows to a cell, and where a ray ends. A ray whose gaps to both sides have grown to a cell meets no cell
/// of any other ray any more; it leaves the runs and is walked to its end alone.
///
/// The result is exact: a cell is in a span if and only if a ray meets its inside. Coordinates are rounded to odd
/// multiples of 1/256 cell, so that no ray begins or ends on a border between cells; crossings are then fractions of
/// whole numbers small enough for a double division to tell exactly on which side of a border they lie.
class RayFan {
 public:
  /// Calls visit(y, first, last) for cells first … last of row y, both included. No cell comes twice. All coordinates
  /// in cells and within ±4 million.
  template <typename Visit>
  void trace(const Eigen::Vector2d& origin, std::span<const Eigen::Vector2d> ends, Visit&& visit) {
    const Span own = begin(origin, ends);
    if (!ends.empty()) visit(originRow_, own.first, own.last);
    for (const int direction : {1, -1}) {
      scheduleSplits(direction);
      for (int row = 1; !runs_.empty(); ++row) {
        for (const auto& span : sweepRow(row)) visit(originRow_ + direction * row, span.first, span.last);
      }
      for (const auto& ray : lone_) walk(ray, direction, visit);
    }
  }

 private:
  /// Cells of a row, both included.
  struct Span {
    int first;
    int last;
  };
  /// Seen from the origin, mirrored so that it points upwards (dy > 0). Rows count from the origin's.
  struct Ray {
    double dx = 0.0;  // 1/256 cells, whole numbers
    double dy = 0.0;
    double slope = 0.0;  // dx / dy
    int endRow = 0;
    int endCell = 0;    // x of the cell it ends in
    int aloneFrom = 0;  // first row in which it shares no cell with others
  };
  /// Crosses the border below its next row at x + rest / dy, 1/256 cells.
  struct LoneRay {
    std::int32_t x;
    std::int32_t rest;
    std::int32_t step;
    std::int32_t restStep;
    std::int32_t dy;
    int row;
    int endRow;
    int endCell;
    bool leansRight;
  };
  /// Neighbouring rays without a gap between them.
  struct Run {
    int first;
    int last;
  };

  Span begin(const Eigen::Vector2d& origin, std::span<const Eigen::Vector2d> ends);
  void scheduleSplits(int direction);
  std::span<const Span> sweepRow(int row);
  void leaveAlone(const Ray& ray, int row);
  double crossing(const Ray& ray, int row) const;
  int firstCrossed(const Ray& ray, int row) const;
  int lastCrossed(const Ray& ray, int row) const;
  int lastRowWithoutGap(const Ray& right, const Ray& left, int lastRow) const;
  static void sortFromRightToLeft(std::vector<Ray>& rays);

  template <typename Visit>
  void walk(LoneRay ray, int direction, Visit& visit) const;

  std::int32_t originX_ = 0;  // 1/256 cells, odd
  int originRow_ = 0;
  double riseUp_ = 0.0;    // from the origin to the upper border of its row, 1/256 cells
  double riseDown_ = 0.0;  // … to the lower one
  double rise_ = 0.0;      // the one of them that counts for the direction at hand

  std::vector<Ray> up_;
  std::vector<Ray> down_;
  const std::vector<Ray>* rays_ = nullptr;  // the ones of the direction at hand
  std::vector<Run> runs_;
  std::vector<Run> runsAbove_;
  std::vector<int> expiring_;      // by row: the first of the pairs (i, i + 1) whose gap opens there, -1 = none
  std::vector<int> nextExpiring_;  // by pair: the next one of the same row
  std::vector<LoneRay> lone_;
  std::vector<Span> crossed_;
  std::vector<Span> spans_;
};

/// Step by step, in whole numbers, and without branches on what chance decides.
template <typename Visit>
void RayFan::walk(LoneRay ray, int direction, Visit& visit) const {
  // A corner belongs to neither of the cells that only touch there: seen from the left, the cell before it is the last.
  const auto lastCell = [](std::int32_t x, std::int32_t rest) { return (x - static_cast<int>(rest == 0)) >> 8; };
  int cell = ray.x >> 8;
  int last = lastCell(ray.x, ray.rest);
  int y = originRow_ + direction * ray.row;
  for (int row = ray.row; row < ray.endRow; ++row, y += direction) {
    const int cellBelow = cell;
    const int lastBelow = last;
    ray.rest += ray.restStep;
    const std::int32_t carry = -static_cast<std::int32_t>(ray.rest >= ray.dy);  // all bits or none
    ray.rest -= ray.dy & carry;
    ray.x += ray.step - carry;
    cell = ray.x >> 8;
    last = lastCell(ray.x, ray.rest);
    if (ray.leansRight) {
      visit(y, cellBelow, last);
    } else {
      visit(y, cell, lastBelow);
    }
  }
  if (ray.leansRight) {
    visit(y, cell, ray.endCell);
  } else {
    visit(y, ray.endCell, last);
  }
}

}  // namespace prodomos::geometry

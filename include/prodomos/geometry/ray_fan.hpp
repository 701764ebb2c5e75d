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
/// row by row instead. In a row, neighbouring rays whose gap is narrower than a cell leave no cell between them untouched,
/// so a whole run of them is one span, known from its first and its last ray alone. Runs only ever split: where a gap
/// grows to a cell, and where a ray ends. A ray whose gaps to both sides have grown to a cell meets no cell of any other
/// ray any more; it leaves the sweep and is walked to its end alone.
///
/// The result is exact: a cell is in a span if and only if a ray meets its inside. Coordinates are rounded to odd
/// multiples of 1/256 cell, so that no ray begins or ends on a border between cells; crossings are then fractions of
/// whole numbers small enough for a double division to tell exactly on which side of a border they lie.
class RayFan {
 public:
  /// Cells first … last of row y, both included.
  struct Span {
    int y = 0;
    int first = 0;
    int last = 0;
  };

  /// All coordinates in cells and within ±4 million. The spans do not overlap; valid until the next call.
  std::span<const Span> trace(const Eigen::Vector2d& origin, std::span<const Eigen::Vector2d> ends);

 private:
  /// Seen from the origin, mirrored so that it points upwards (dy > 0). Rows count from the origin's.
  struct Ray {
    double dx = 0.0;  // 1/256 cells, whole numbers
    double dy = 0.0;
    double slope = 0.0;  // dx / dy
    int endRow = 0;
    int endCell = 0;      // x of the cell it ends in
    int aloneFrom = 0;    // first row in which it shares no cell with others
  };
  struct Interval {
    int first;
    int last;
  };
  struct Run {
    int first;
    int last;
  };

  Interval crossed(const Ray& ray, int row) const;
  int lastRowWithoutGap(const Ray& right, const Ray& left, int lastRow) const;
  static void sortFromRightToLeft(std::vector<Ray>& rays);
  void sweepUpwards(std::vector<Ray>& rays, bool mirrored);
  int scheduleSplits(std::vector<Ray>& rays);
  void splitRuns(int row);
  void emitRow(const std::vector<Ray>& rays, int row, bool mirrored);
  void walkAlone(const Ray& ray, bool mirrored);

  std::int32_t originX_ = 0;  // 1/256 cells, odd
  double rise_ = 0.0;         // from the origin to the upper border of its row, 1/256 cells
  int originRow_ = 0;

  std::vector<Span> spans_;
  std::vector<Ray> up_;
  std::vector<Ray> down_;
  std::vector<Run> runs_;
  std::vector<Run> splitRuns_;
  std::vector<int> expiring_;      // by row: the first of the pairs (i, i + 1) whose gap opens there, -1 = none
  std::vector<int> nextExpiring_;  // by pair: the next one of the same row
  std::vector<Interval> intervals_;
};

}  // namespace prodomos::geometry

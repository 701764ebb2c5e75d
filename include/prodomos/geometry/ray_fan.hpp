// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/grid_index.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace prodomos::geometry {

/// The cells that a fan of rays from one point passes, each of them once.
///
/// Rays of a scan overlap near the sensor: walked one by one, most cells are visited many times. Here the grid is swept
/// row by row instead. In a row, neighbouring rays whose gap is narrower than a cell leave no cell between them untouched,
/// so a whole run of them is one span, known from its first and its last ray alone. Runs only ever split: where a gap
/// grows to a cell, and where a ray ends. A ray whose gaps to both sides have grown to a cell meets no cell of any other
/// ray any more; it leaves the runs and is
/// followed step by step.
///
/// The result is exact: a cell is in a span if and only if a ray meets its inside. Coordinates are rounded to odd
/// multiples of 1/256 cell, so that no ray begins or ends on a border between cells; crossings are then fractions of
/// whole numbers small enough for a double division to tell exactly on which side of a border they lie.
class RayFan {
 public:
  /// Cells first … last of a row, both included.
  struct Span {
    int first = 0;
    int last = 0;
  };
  using Visitor = std::function<void(int y, std::span<const Span>)>;

  /// Hands the spans to `visit`, each row once; they do not overlap. All coordinates in cells and within ±4 million.
  void trace(const Eigen::Vector2d& origin, std::span<const Eigen::Vector2d> ends, const Visitor& visit);

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
  /// Rays that meet cells of their own only, and lean to one side. Each crosses the border below the next row at
  /// x + rest / dy, 1/256 cells.
  struct LoneRays {
    std::vector<std::int32_t> x;
    std::vector<std::int32_t> rest;
    std::vector<std::int32_t> step;
    std::vector<std::int32_t> restStep;
    std::vector<std::int32_t> dy;
    std::vector<int> endRow;
    std::vector<int> endCell;
    int nextEnd = 0;  // the least endRow

    void clear();
    void add(const Ray& ray, std::int64_t x, std::int64_t rest, std::int64_t step, std::int64_t restStep);
    void remove(std::size_t i);
  };
  struct Run {
    int first;
    int last;
  };

  double crossing(const Ray& ray, int row) const;
  int firstCrossed(const Ray& ray, int row) const;
  int lastCrossed(const Ray& ray, int row) const;
  int lastRowWithoutGap(const Ray& right, const Ray& left, int lastRow) const;
  static void sortFromRightToLeft(std::vector<Ray>& rays);
  void sweepUpwards(std::vector<Ray>& rays, bool mirrored);
  int scheduleSplits(std::vector<Ray>& rays);
  void splitRuns(int row);
  void addRuns(const std::vector<Ray>& rays, int row);
  void leaveAlone(const Ray& ray, int row);
  void addAlone(LoneRays& rays, bool leanRight, int row);

  std::int32_t originX_ = 0;  // 1/256 cells, odd
  double rise_ = 0.0;         // from the origin to the upper border of its row, 1/256 cells
  int originRow_ = 0;

  const Visitor* visit_ = nullptr;
  std::vector<Span> spans_;  // of one row
  std::vector<Ray> up_;
  std::vector<Ray> down_;
  LoneRays leaningRight_;
  LoneRays leaningLeft_;
  std::vector<Run> runs_;
  std::vector<Run> splitRuns_;
  std::vector<int> expiring_;      // by row: the first of the pairs (i, i + 1) whose gap opens there, -1 = none
  std::vector<int> nextExpiring_;  // by pair: the next one of the same row
  std::vector<Span> crossedByRuns_;
};

}  // namespace prodomos::geometry

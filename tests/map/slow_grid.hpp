// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/occupancy_grid.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

/// The occupancy grid once more, slow and obviously right: the oracle that the fast one must meet cell by cell.
namespace prodomos::test {

class SlowGrid {
 public:
  explicit SlowGrid(const map::OccupancyGridConfig& config) : config_(config) {}

  /// Of every cell of the box: is it hit, else does a beam pass it?
  void insert(const Eigen::Vector2d& origin, const std::vector<map::OccupancyGrid::Beam>& beams) {
    const auto start = units(origin);
    std::map<geometry::CellIndex, bool> touched;  // true: hit
    for (const auto& beam : beams) {
      const Eigen::Vector2d way = beam.end - origin;
      const bool cut = way.norm() > config_.maxRange;
      const auto end = units(cut ? origin + way * (config_.maxRange / way.norm()) : beam.end);
      geometry::CellBox box;
      box.add(start.cell());
      box.add(end.cell());
      for (int y = box.first.y; y <= box.last.y; ++y) {
        for (int x = box.first.x; x <= box.last.x; ++x) {
          if (meets({x, y}, start, end)) touched.try_emplace({x, y}, false);
        }
      }
      if (beam.hit && !cut) touched[end.cell()] = true;
    }
    for (const auto& [cell, isHit] : touched) {
      const int before = values_.contains(cell) ? values_.at(cell) : 0;
      values_[cell] = isHit ? std::min(before + inUnits(config_.hit), inUnits(config_.clampHigh))
                            : std::max(before + inUnits(config_.miss), inUnits(config_.clampLow));
    }
  }

  /// Log-odds; none: unknown.
  std::optional<int> value(geometry::CellIndex cell) const {
    const auto found = values_.find(cell);
    return found == values_.end() ? std::nullopt : std::optional(found->second);
  }
  const std::map<geometry::CellIndex, int>& values() const { return values_; }

  static int inUnits(double probability) {
    return static_cast<int>(std::lround(24.0 * std::log(probability / (1.0 - probability))));
  }

 private:
  /// Whole numbers of 1/256 cell, odd: the rounding that RayFan documents.
  struct Point {
    std::int64_t x;
    std::int64_t y;

    geometry::CellIndex cell() const { return {static_cast<int>(x >> 8), static_cast<int>(y >> 8)}; }
  };
  Point units(const Eigen::Vector2d& point) const {
    const auto along = [&](double metres) {
      return 2 * static_cast<std::int64_t>(std::floor(metres * (1.0 / config_.resolution) * 128.0)) + 1;
    };
    return {along(point.x()), along(point.y())};
  }

  /// Does the segment meet the inside of the cell? They are disjoint if and only if a side's direction or the segment's
  /// normal separates them.
  static bool meets(geometry::CellIndex cell, const Point& a, const Point& b) {
    const std::int64_t left = 256 * static_cast<std::int64_t>(cell.x);
    const std::int64_t low = 256 * static_cast<std::int64_t>(cell.y);
    if (std::max(a.x, b.x) <= left || std::min(a.x, b.x) >= left + 256) return false;
    if (std::max(a.y, b.y) <= low || std::min(a.y, b.y) >= low + 256) return false;
    if (a.x == b.x && a.y == b.y) return true;
    int above = 0;
    int below = 0;
    for (const std::int64_t x : {left, left + 256}) {
      for (const std::int64_t y : {low, low + 256}) {
        const std::int64_t side = (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
        if (side >= 0) ++above;
        if (side <= 0) ++below;
      }
    }
    return above < 4 && below < 4;
  }

  map::OccupancyGridConfig config_;
  std::map<geometry::CellIndex, int> values_;
};

/// The beams of a scan as one would write them down: a sine and a cosine each.
inline std::vector<map::OccupancyGrid::Beam> beamsOf(const sensors::LaserScan& scan,
                                                     const geometry::Pose3& T_grid_sensor, double noReturn) {
  std::vector<map::OccupancyGrid::Beam> beams;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range = static_cast<double>(scan.ranges[i]);
    if (std::isnan(range) || range < 0.0) continue;
    const double angle = scan.firstAngle + static_cast<double>(i) * scan.angleStep;
    const double length = std::isinf(range) ? std::min(scan.maxRange, noReturn) : range;
    const Eigen::Vector3d end =
        T_grid_sensor * Eigen::Vector3d(length * std::cos(angle), length * std::sin(angle), 0.0);
    beams.push_back({end.head<2>(), !std::isinf(range)});
  }
  return beams;
}

/// As gridFromText() reads it, of the smallest box that holds all known cells.
inline std::string toText(const map::OccupancyGrid& grid) {
  const auto box = grid.knownBox();
  std::string text;
  for (int y = box.last.y; y >= box.first.y; --y) {
    for (int x = box.first.x; x <= box.last.x; ++x) {
      const auto state = grid.state({x, y});
      text += state == map::CellState::kUnknown ? ' ' : state == map::CellState::kFree ? '.' : '#';
    }
    text += '\n';
  }
  return text;
}

}  // namespace prodomos::test

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/prediction/surroundings.hpp"

#include <array>
#include <cmath>

namespace prodomos::prediction {

namespace {

using geometry::CellIndex;
using map::OccupancyGrid;

constexpr double kSample = Surroundings::kCell / 2.0;  // metres: walls are a cell of a grid thick, and must not be lost

/// Evidence of a cell: of its quarters, the strongest for an obstacle; else free where one is.
class Evidence {
 public:
  Evidence() : quarters_(quarterBox(), 0), isKnown_(quarterBox(), 0) {}

  void add(const OccupancyGrid& grid, const geometry::Pose2& T_grid_here) {
    const auto box = quarters_.box();
    const Eigen::Vector2d step(std::cos(T_grid_here.theta) * kSample, std::sin(T_grid_here.theta) * kSample);
    for (int y = box.first.y; y <= box.last.y; ++y) {
      Eigen::Vector2d point = T_grid_here * geometry::centreOf({box.first.x, y}, kSample);
      for (int x = box.first.x; x <= box.last.x; ++x, point += step) {
        const auto cell = grid.cell(grid.cellAt(point));
        if (cell == OccupancyGrid::kUnknownCell) continue;
        *quarters_.find({x, y}) += cell;
        *isKnown_.find({x, y}) = 1;
      }
    }
  }

  map::CellState stateOf(CellIndex cell) const {
    auto state = map::CellState::kUnknown;
    for (const CellIndex quarter : {CellIndex{2 * cell.x, 2 * cell.y}, CellIndex{2 * cell.x + 1, 2 * cell.y},
                                    CellIndex{2 * cell.x, 2 * cell.y + 1}, CellIndex{2 * cell.x + 1, 2 * cell.y + 1}}) {
      if (isKnown_.at(quarter) == 0) continue;
      if (quarters_.at(quarter) >= 0) return map::CellState::kOccupied;
      state = map::CellState::kFree;
    }
    return state;
  }

 private:
  static constexpr geometry::CellBox quarterBox() {
    const auto& [first, last] = Surroundings::kBox;
    return {{2 * first.x, 2 * first.y}, {2 * last.x + 1, 2 * last.y + 1}};
  }

  geometry::CellMap<std::int32_t> quarters_;
  geometry::CellMap<std::uint8_t> isKnown_;
};

bool reaches(const OccupancyGrid& grid, const geometry::Pose2& T_here_grid) {
  if (grid.box().empty()) return false;
  const auto box = grid.box();
  const double resolution = grid.resolution();
  geometry::CellBox covered;
  for (const int x : {box.first.x, box.last.x}) {
    for (const int y : {box.first.y, box.last.y}) {
      const Eigen::Vector2d corner = T_here_grid * geometry::centreOf({x, y}, resolution);
      covered.add(geometry::cellAt(corner.x(), corner.y(), Surroundings::kCell));
    }
  }
  const auto& window = Surroundings::kBox;
  return covered.first.x <= window.last.x && covered.last.x >= window.first.x && covered.first.y <= window.last.y &&
         covered.last.y >= window.first.y;
}

}  // namespace

Surroundings::Surroundings(const geometry::Pose3& T_map_here, std::span<const PlacedGrid> grids)
    : T_map_here_(T_map_here), cells_(kBox, map::CellState::kUnknown) {
  Evidence evidence;
  bool isAnythingKnown = false;
  for (const auto& placed : grids) {
    const geometry::Pose3 T_here_submap = T_map_here.inverse() * placed.T_map_submap;
    if (placed.grid == nullptr || std::abs(T_here_submap.translation().z()) > kSameFloor) continue;
    const geometry::Pose2 T_here_grid = geometry::toPose2(T_here_submap);
    if (!reaches(*placed.grid, T_here_grid)) continue;
    evidence.add(*placed.grid, geometry::inverse(T_here_grid));
    isAnythingKnown = true;
  }
  if (!isAnythingKnown) return;
  for (int y = kBox.first.y; y <= kBox.last.y; ++y) {
    for (int x = kBox.first.x; x <= kBox.last.x; ++x) *cells_.find({x, y}) = evidence.stateOf({x, y});
  }
}

bool Surroundings::isAnythingKnown() const {
  for (int y = kBox.first.y; y <= kBox.last.y; ++y) {
    for (int x = kBox.first.x; x <= kBox.last.x; ++x) {
      if (state(CellIndex{x, y}) != map::CellState::kUnknown) return true;
    }
  }
  return false;
}

void Surroundings::set(CellIndex cell, map::CellState state) {
  if (auto* found = cells_.find(cell)) *found = state;
}

}  // namespace prodomos::prediction

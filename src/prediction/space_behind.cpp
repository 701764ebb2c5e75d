// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prediction/space_behind.hpp"

#include "prediction/outline.hpp"

#include <cmath>
#include <cstdlib>

namespace prodomos::prediction {

namespace {

using geometry::CellIndex;

constexpr double kCell = Surroundings::kCell;
constexpr geometry::CellBox kNear{{1, -40}, {49, 39}};  // cells: the leaf and the wall that it is in lie before them
constexpr int kDeepestWall = 5;                         // cells; where a jamb or a threshold ends at the latest

}  // namespace

SpaceBehind spaceBehind(const Surroundings& around, double width) {
  const int half = static_cast<int>(std::floor(width / 2.0 / kCell));
  CellSet open(kNear, 1);
  for (const auto& room : around.taken_here) open.fill(room, 0, kCell);
  for (int y = kNear.first.y; y <= kNear.last.y; ++y) {
    for (int x = kNear.first.x; x <= kNear.last.x; ++x) {
      // Beside the opening lies its wall, whether it was seen or not.
      const bool isBeside = x <= kDeepestWall / 2 && std::abs(y) > half;
      if (isBeside || around.state(CellIndex{x, y}) == map::CellState::kOccupied) *open.find({x, y}) = 0;
    }
  }
  SpaceBehind space{.cells = {kNear, 0}};
  for (int x = kNear.first.x; x <= kDeepestWall; ++x) {
    for (int y = -half; y < half; ++y) {
      for (const auto cell : takePiece(open, {x, y})) {
        *space.cells.find(cell) = 1;
        (around.state(cell) == map::CellState::kFree ? space.seen : space.unseen) += kCell * kCell;
      }
    }
  }
  return space;
}

}  // namespace prodomos::prediction

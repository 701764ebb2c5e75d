// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prediction/space_behind.hpp"

#include <array>
#include <cmath>
#include <vector>

namespace prodomos::prediction {

namespace {

using geometry::CellIndex;

constexpr double kCell = Surroundings::kCell;
constexpr geometry::CellBox kNear{{1, -40}, {49, 39}};  // cells: the leaf and the wall that it is in lie before them
constexpr int kDeepestWall = 5;                         // cells; where a jamb or a threshold ends at the latest

}  // namespace

SpaceBehind spaceBehind(const Surroundings& around, double width) {
  SpaceBehind space{.cells = {kNear, 0}};
  geometry::CellMap<std::uint8_t> taken(kNear, 0);
  for (const auto& room : around.taken_here) taken.fill(room, 1, kCell);
  std::vector<CellIndex> open;
  const auto enter = [&](CellIndex cell) {
    auto* const isIn = space.cells.find(cell);
    if (isIn == nullptr || *isIn != 0 || taken.at(cell) != 0) return;
    const auto state = around.state(cell);
    if (state == map::CellState::kOccupied) return;
    *isIn = 1;
    (state == map::CellState::kFree ? space.seen : space.unseen) += kCell * kCell;
    open.push_back(cell);
  };
  const int half = static_cast<int>(std::floor(width / 2.0 / kCell));
  for (int x = kNear.first.x; x <= kDeepestWall; ++x) {
    for (int y = -half; y < half; ++y) enter({x, y});
  }
  while (!open.empty()) {
    const CellIndex at = open.back();
    open.pop_back();
    for (const CellIndex next :
         {CellIndex{at.x + 1, at.y}, CellIndex{at.x - 1, at.y}, CellIndex{at.x, at.y + 1}, CellIndex{at.x, at.y - 1}}) {
      // Beside the opening lies its wall, whether it was seen or not.
      if (next.x > kDeepestWall / 2 || std::abs(next.y) <= half) enter(next);
    }
  }
  return space;
}

}  // namespace prodomos::prediction

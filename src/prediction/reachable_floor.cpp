// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prediction/reachable_floor.hpp"

namespace prodomos::prediction {

namespace {

using geometry::CellBox;
using geometry::CellIndex;
using map::CellState;

constexpr CellBox kThreshold{{1, -4}, {5, 3}};  // where one steps in; of the leaf itself there may be more known

template <typename Visit>
void visitCells(const CellBox& box, const Visit& visit) {
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) visit(CellIndex{x, y});
  }
}

}  // namespace

CellSet reachableFloor(const Surroundings& around, const CellBox& box) {
  bool showsFloor = false;
  visitCells(kThreshold, [&](CellIndex cell) { showsFloor |= around.state(cell) == CellState::kFree; });
  CellSet open(box, 1);
  for (const auto& polygon : around.taken_here) open.fill(polygon, 0, Surroundings::kCell);
  visitCells(box, [&](CellIndex cell) {
    const auto state = around.state(cell);
    if (state == CellState::kOccupied || (state == CellState::kFree && !showsFloor)) *open.find(cell) = 0;
  });
  CellSet reached(box, 0);
  visitCells(kThreshold, [&](CellIndex start) {
    for (const auto cell : takePiece(open, start)) {
      if (around.state(cell) == CellState::kUnknown) *reached.find(cell) = 1;
    }
  });
  return reached;
}

}  // namespace prodomos::prediction

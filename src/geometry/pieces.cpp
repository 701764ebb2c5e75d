// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/pieces.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

namespace prodomos::geometry {

namespace {

/// Right, up, left, down: counter-clockwise.
constexpr std::array<CellIndex, 4> kSteps = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

CellIndex sum(CellIndex a, CellIndex b) {
  return {a.x + b.x, a.y + b.y};
}

}  // namespace

Piece takePiece(CellSet& cells, CellIndex start, bool byCorners) {
  Piece piece;
  const auto take = [&](CellIndex cell) {
    auto* value = cells.find(cell);
    if (value == nullptr || *value == 0) return;
    *value = 0;
    piece.push_back(cell);
  };
  take(start);
  std::size_t taken = 0;
  while (taken < piece.size()) {
    const auto cell = piece[taken++];
    for (std::size_t side = 0; side < kSteps.size(); ++side) {
      const auto beside = sum(cell, kSteps[side]);
      take(beside);
      if (byCorners) take(sum(beside, kSteps[(side + 1) % kSteps.size()]));
    }
  }
  return piece;
}

std::vector<Piece> piecesOf(const CellSet& cells) {
  auto rest = cells;
  std::vector<Piece> pieces;
  const auto& box = cells.box();
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) {
      if (rest.at({x, y}) == 0) continue;
      pieces.push_back(takePiece(rest, {x, y}));
      std::ranges::sort(pieces.back(), {}, [](CellIndex cell) { return std::pair(cell.y, cell.x); });
    }
  }
  std::ranges::stable_sort(pieces, std::greater(), &Piece::size);
  return pieces;
}

}  // namespace prodomos::geometry

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prediction/outline.hpp"

#include <algorithm>
#include <array>

namespace prodomos::prediction {

namespace {

using geometry::CellBox;
using geometry::CellIndex;

/// Right, up, left, down: counter-clockwise.
constexpr std::array<CellIndex, 4> kSteps = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

CellIndex operator+(CellIndex a, CellIndex b) {
  return {a.x + b.x, a.y + b.y};
}

/// With one more row and column of cells all round.
CellSet setOf(const Piece& piece) {
  CellBox box;
  for (const auto cell : piece) box.add(cell);
  CellSet cells({{box.first.x - 1, box.first.y - 1}, {box.last.x + 1, box.last.y + 1}}, 0);
  for (const auto cell : piece) *cells.find(cell) = 1;
  return cells;
}

/// Cells of the box that are not of the set, and from which one does not come out of it.
Piece holesOf(const CellSet& cells) {
  const auto box = cells.box();
  CellSet others(box, 0);
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) *others.find({x, y}) = cells.at({x, y}) == 0 ? 1 : 0;
  }
  takePiece(others, box.first, true);
  Piece holes;
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) {
      if (others.at({x, y}) != 0) holes.push_back({x, y});
    }
  }
  return holes;
}

}  // namespace

Piece withoutHoles(const Piece& piece) {
  if (piece.empty()) return piece;
  auto cells = setOf(piece);
  const auto holes = holesOf(cells);
  if (holes.empty()) return piece;
  for (const auto hole : holes) {
    for (CellIndex cell = hole; auto* value = cells.find(cell); ++cell.x) *value = 0;
  }
  return piecesOf(cells).front();
}

geometry::Polygon outlineOf(const Piece& piece, double resolution) {
  geometry::Polygon outline;
  if (piece.empty()) return outline;
  const auto cells = setOf(piece);
  // Along the edges of cells with the piece to the left, from the lower left corner of its first cell; where two cells
  // meet at a corner alone, leftwards, which passes the corner twice and crosses nothing.
  const auto leftOf = [&cells](CellIndex corner, std::size_t heading) {
    constexpr std::array<CellIndex, 4> kLeft = {{{0, 0}, {-1, 0}, {-1, -1}, {0, -1}}};
    return cells.at(corner + kLeft[heading]) != 0;
  };
  const CellIndex start = piece.front();
  CellIndex corner = start;
  std::size_t heading = 0;
  do {
    corner = corner + kSteps[heading];
    const std::size_t left = (heading + 1) % kSteps.size();
    const std::size_t right = (heading + 3) % kSteps.size();
    const std::size_t before = heading;
    if (!leftOf(corner, heading)) {
      heading = left;
    } else if (leftOf(corner, right)) {
      heading = right;
    }
    if (heading != before) outline.emplace_back(corner.x * resolution, corner.y * resolution);
  } while (corner != start || heading != 0);
  return outline;
}

}  // namespace prodomos::prediction

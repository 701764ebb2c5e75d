// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prediction/outline.hpp"

#include "prodomos/base/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace prodomos::prediction {
namespace {

using geometry::CellIndex;

/// '#' are cells; the first row is y = 0.
CellSet drawn(const std::vector<std::string>& rows) {
  CellSet cells({{0, 0}, {static_cast<int>(rows.front().size()) - 1, static_cast<int>(rows.size()) - 1}}, 0);
  for (int y = 0; y < std::ssize(rows); ++y) {
    for (int x = 0; x < std::ssize(rows.front()); ++x) {
      *cells.find({x, y}) = rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] == '#' ? 1 : 0;
    }
  }
  return cells;
}

std::set<CellIndex> asSet(const std::vector<CellIndex>& cells) {
  return {cells.begin(), cells.end()};
}

TEST(Outline, OfARectangleHasFourCorners) {
  const auto outline = outlineOf(piecesOf(drawn({"###", "###"})).front(), 0.5);
  EXPECT_EQ(outline.size(), 4U);
  EXPECT_DOUBLE_EQ(geometry::signedArea(outline), 1.5);
}

TEST(Outline, AHoleIsOpenedToOneSide) {
  const auto piece = withoutHoles(piecesOf(drawn({"#####", "#.###", "#####"})).front());
  EXPECT_EQ(piece.size(), 11U);
  const auto cells = asSet(geometry::cellsIn(outlineOf(piece, 0.1), 0.1));
  EXPECT_EQ(cells, asSet(piece));
  EXPECT_FALSE(cells.contains({1, 1}));
}

TEST(Outline, NoCellHasNoOutline) {
  EXPECT_TRUE(piecesOf(drawn({"..."})).empty());
  EXPECT_TRUE(withoutHoles({}).empty());
  EXPECT_TRUE(outlineOf({}, 0.1).empty());
}

TEST(Outline, HoldsTheCellsOfItsPieceAndNoOthers) {
  base::Random random(1, "outlines");
  for (int world = 0; world < 200; ++world) {
    CellSet cells({{-7, 3}, {9, 14}}, 0);
    const double share = random.uniform(0.4, 0.95);
    for (int y = 3; y <= 14; ++y) {
      for (int x = -7; x <= 9; ++x) *cells.find({x, y}) = random.uniform() < share ? 1 : 0;
    }
    const auto pieces = piecesOf(cells);
    ASSERT_FALSE(pieces.empty());
    const auto piece = withoutHoles(pieces.front());
    const auto whole = asSet(pieces.front());
    EXPECT_TRUE(std::ranges::all_of(piece, [&](CellIndex cell) { return whole.contains(cell); }));
    const auto outline = outlineOf(piece, 0.1);
    EXPECT_EQ(asSet(geometry::cellsIn(outline, 0.1)), asSet(piece));
    EXPECT_NEAR(geometry::signedArea(outline), 0.01 * static_cast<double>(piece.size()), 1e-9);
  }
}

}  // namespace
}  // namespace prodomos::prediction

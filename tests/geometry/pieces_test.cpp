// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/pieces.hpp"

#include "prodomos/base/random.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace prodomos::geometry {
namespace {

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

TEST(Pieces, HangTogetherByEdgesAndTheGreatestComesFirst) {
  const auto pieces = piecesOf(drawn({"#..##", ".#.##", "....."}));
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_EQ(pieces[0].size(), 4U);
  EXPECT_EQ(pieces[1], (Piece{{0, 0}}));
  EXPECT_EQ(pieces[2], (Piece{{1, 1}}));
}

TEST(Pieces, AreTakenOutOfTheirSet) {
  auto cells = drawn({"##.#", ".#.."});
  EXPECT_EQ(takePiece(cells, {0, 0}).size(), 3U);
  EXPECT_EQ(cells.at({1, 1}), 0);
  EXPECT_EQ(cells.at({3, 0}), 1);
  EXPECT_TRUE(takePiece(cells, {0, 0}).empty()) << "it is gone";
  EXPECT_TRUE(takePiece(cells, {-5, 9}).empty()) << "outside of the box";
}

TEST(Pieces, MayHangTogetherByCorners) {
  auto cells = drawn({"#..", ".#.", "..#"});
  EXPECT_EQ(takePiece(cells, {1, 1}, true).size(), 3U);
}

TEST(Pieces, OfRandomSetsHoldEachCellOnce) {
  base::Random random(3, "pieces");
  for (int run = 0; run < 50; ++run) {
    CellSet cells({{-4, -7}, {12, 9}}, 0);
    std::size_t count = 0;
    for (int y = -7; y <= 9; ++y) {
      for (int x = -4; x <= 12; ++x) count += *cells.find({x, y}) = random.uniform(0.0, 1.0) < 0.5 ? 1 : 0;
    }
    CellMap<int> pieceOf(cells.box(), -1);
    const auto pieces = piecesOf(cells);
    std::size_t held = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      held += pieces[i].size();
      for (const auto cell : pieces[i]) {
        EXPECT_EQ(pieceOf.at(cell), -1);
        *pieceOf.find(cell) = static_cast<int>(i);
      }
    }
    EXPECT_EQ(held, count);
    for (int y = -7; y <= 9; ++y) {
      for (int x = -4; x < 12; ++x) {
        if (cells.at({x, y}) == 0 || cells.at({x + 1, y}) == 0) continue;
        EXPECT_EQ(pieceOf.at({x, y}), pieceOf.at({x + 1, y}));
      }
    }
  }
}

}  // namespace
}  // namespace prodomos::geometry

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/prediction/surroundings.hpp"

#include "prediction/outline.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

namespace prodomos::prediction {

inline constexpr int kFirstCell = 1;  ///< ahead of the leaf, in cells: where a room may begin
/// All that lies behind a door.
inline constexpr geometry::CellBox kBehind{{kFirstCell, Surroundings::kBox.first.y}, Surroundings::kBox.last};

inline int inCells(double metres) {
  return static_cast<int>(std::lround(metres / Surroundings::kCell));
}

/// A box behind a door, in cells of Surroundings: from kFirstCell to before `end` ahead, from -right to before `left`
/// across.
struct RoomBox {
  int left = 0;
  int right = 0;
  int end = 0;

  geometry::CellBox cells() const { return {{kFirstCell, -right}, {end - 1, left - 1}}; }
};

/// How many cells of boxes one may reach, by an integral image.
class UnknownArea {
 public:
  explicit UnknownArea(const CellSet& reachable);

  int cellsOf(const RoomBox& box) const;

 private:
  static constexpr int kAhead = Surroundings::kBox.last.x + 1;
  static constexpr int kAcross = Surroundings::kBox.last.y - Surroundings::kBox.first.y + 1;
  static std::size_t index(int x, int y) {
    return static_cast<std::size_t>(x) * (kAcross + 1) + static_cast<std::size_t>(y);
  }

  std::vector<std::int32_t> below_;  // cells before x, to the right of y
};

/// Mean intersection over union with rooms that are alike likely, as far as they are not known.
class ExpectedIou {
 public:
  ExpectedIou(const std::vector<RoomBox>& rooms, const UnknownArea& area);

  double of(const RoomBox& guess) const;

 private:
  const std::vector<RoomBox>& rooms_;
  const UnknownArea& area_;
  std::vector<int> sizes_;  // in cells
};

/// Step by step to a box of the greatest value.
RoomBox bestBox(const ExpectedIou& expected, const RoomBox& start);

}  // namespace prodomos::prediction

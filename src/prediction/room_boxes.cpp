// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prediction/room_boxes.hpp"

#include <algorithm>

namespace prodomos::prediction {

UnknownArea::UnknownArea(const CellSet& reachable) : below_(static_cast<std::size_t>((kAhead + 1) * (kAcross + 1)), 0) {
  for (int x = 0; x < kAhead; ++x) {
    int inRow = 0;
    for (int y = 0; y < kAcross; ++y) {
      inRow += reachable.at({x, y + Surroundings::kBox.first.y});
      below_[index(x + 1, y + 1)] = below_[index(x, y + 1)] + inRow;
    }
  }
}

int UnknownArea::cellsOf(const RoomBox& box) const {
  const int left = box.left - Surroundings::kBox.first.y;
  const int right = -box.right - Surroundings::kBox.first.y;
  const int begin = std::min(kFirstCell, box.end);
  return below_[index(box.end, left)] - below_[index(box.end, right)] - below_[index(begin, left)] +
         below_[index(begin, right)];
}

ExpectedIou::ExpectedIou(const std::vector<RoomBox>& rooms, const UnknownArea& area) : rooms_(rooms), area_(area) {
  for (const auto& room : rooms) sizes_.push_back(area.cellsOf(room));
}

double ExpectedIou::of(const RoomBox& guess) const {
  const int own = area_.cellsOf(guess);
  double sum = 0.0;
  for (std::size_t i = 0; i < rooms_.size(); ++i) {
    const auto& room = rooms_[i];
    const int both = area_.cellsOf(
        {std::min(guess.left, room.left), std::min(guess.right, room.right), std::min(guess.end, room.end)});
    const int either = own + sizes_[i] - both;
    if (either > 0) sum += static_cast<double>(both) / either;
  }
  return sum / static_cast<double>(rooms_.size());
}

RoomBox bestBox(const ExpectedIou& expected, const RoomBox& start) {
  RoomBox best = start;
  double greatest = expected.of(best);
  const auto climb = [&](int RoomBox::*edge, int most, int step) {
    RoomBox moved = best;
    moved.*edge = std::clamp(moved.*edge + step, 0, most);
    const double value = expected.of(moved);
    if (value <= greatest) return false;
    greatest = value;
    best = moved;
    return true;
  };
  for (const int step : {8, 4, 2, 1}) {
    for (bool isBetter = true; isBetter;) {
      isBetter = false;
      for (const int move : {step, -step}) {
        isBetter |= climb(&RoomBox::left, Surroundings::kBox.last.y, move);
        isBetter |= climb(&RoomBox::right, -Surroundings::kBox.first.y, move);
        isBetter |= climb(&RoomBox::end, Surroundings::kBox.last.x, move);
      }
    }
  }
  return best;
}

}  // namespace prodomos::prediction

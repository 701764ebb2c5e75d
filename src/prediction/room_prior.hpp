// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/prediction/room_guess.hpp"

#include "prediction/room_forest.hpp"

namespace prodomos::prediction {

/// What was learned from floor plans: written by tests/bench/fit_rooms, described in docs/rooms.md.
struct RoomPrior {
  Forest side;   ///< does the room end to the left within the next kBin metres, given that it reaches so far
  Forest end;    ///< the same ahead
  Forest space;  ///< is there unseen floor behind at all

  /// What the true IoU is where the forests expect one: offset + slope * expected.
  double iouOffset = 0.0;
  double iouSlope = 1.0;
  double areaSpread = 1.0;  ///< the true deviation of an area is so many times that of the rooms drawn
};

inline constexpr double kBin = 0.3;           ///< metres
inline constexpr std::size_t kSideBins = 30;  ///< of the places where a side wall may be
inline constexpr std::size_t kEndBins = 40;

const RoomPrior& trainedRoomPrior();

RoomGuess guessRoom(const Surroundings& around, double doorWidth, const RoomPrior& prior);

}  // namespace prodomos::prediction

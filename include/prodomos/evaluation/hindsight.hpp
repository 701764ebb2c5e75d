// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/calibration.hpp"
#include "prodomos/evaluation/free_space.hpp"
#include "prodomos/evaluation/room_shapes.hpp"
#include "prodomos/evaluation/score_page.hpp"
#include "prodomos/map/map_view.hpp"

#include <array>
#include <optional>
#include <vector>

/// What a map predicted, by what the rest of its log has shown: no truth is needed. docs/evaluation.md defines every
/// measure.
namespace prodomos::evaluation {

/// Of predicted cells that were unknown when they were told.
struct SeenCells {
  std::size_t free = 0;
  std::size_t occupied = 0;
  std::size_t unknown = 0;  ///< to the end

  std::size_t seen() const { return free + occupied; }
  std::size_t all() const { return seen() + unknown; }
  std::optional<double> precision() const { return shareOf(free, seen()); }
  std::optional<double> seenShare() const { return shareOf(seen(), all()); }
  SeenCells& operator+=(const SeenCells& other);
};

/// At one threshold, of settled bets.
struct HindsightLevel {
  std::array<SeenCells, 3> byMobility;  ///< of the cause, in the order of map::Mobility
  HalfDiscs halfDiscs;                  ///< behind the same doors

  SeenCells overall() const;
  std::optional<double> halfDiscPrecision() const;  ///< of as many cells as doors predict
  HindsightLevel& operator+=(const HindsightLevel& other);
};

/// Rooms of at least 2 m² beyond an opening that the map knows in the end, and those predicted there in time.
struct RoomRecall {
  FoundCount entered;     ///< the robot came in through the opening; predicted before
  FoundCount inTime;      ///< of these, through an opening that had been detected before
  FoundCount lookedInto;  ///< nobody entered; predicted at all

  RoomRecall& operator+=(const RoomRecall& other);
};

struct HindsightScore {
  std::array<std::size_t, 4> byState{};  ///< bets by doors and stairs, in the order of map::PredictionState
  std::vector<Bet> bets;                 ///< settled ones
  std::array<HindsightLevel, kThresholds.size()> levels;  ///< in the order of kThresholds
  RoomShapes rooms;                                       ///< behind bets that came true, as they were seen by the end
  std::size_t roomsNotSeen = 0;                           ///< such rooms that were seen too little to be compared
  RoomRecall recall;

  std::size_t made() const;
  std::size_t count(map::PredictionState state) const { return byState[static_cast<std::size_t>(state)]; }
  std::optional<double> settledShare() const { return shareOf(bets.size(), made()); }
  std::optional<double> precision() const;  ///< confirmed and merged, of the settled ones
  HindsightScore& operator+=(const HindsightScore& other);
};

HindsightScore scoreHindsight(const map::MapView& view);

/// One a floor: what was seen by the end, openings, and likely rooms by what became of them.
std::vector<ScorePicture> hindsightPictures(const map::MapView& view);

}  // namespace prodomos::evaluation

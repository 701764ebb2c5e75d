// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/claims.hpp"
#include "prodomos/evaluation/known_space.hpp"
#include "prodomos/evaluation/observed_places.hpp"
#include "prodomos/map/map_view.hpp"

#include <optional>
#include <set>
#include <vector>

namespace prodomos::evaluation {

/// A map, and what it had come to know by its end; the world is its own frame.
struct Retrospect {
  explicit Retrospect(const map::MapView& view);

  Placement placement;
  Claims claims;
  KnownSpace known;  ///< what a sub-map has seen is known when it ends: that is when bets are made and told anew
  ObservedPlaces places;
  std::vector<base::Time> ends;  ///< of observed sub-maps, ascending

  /// Null where it is no door, or is believed no more.
  const ClaimedDoor* findDoor(base::EntityId id) const;
  /// When the bet told what `claims` have of it: when it was made. Of maps whose events do not keep that, it is told as
  /// it was last before it was settled, with what earlier sub-maps had seen; none of those that are still open.
  std::optional<base::Time> toldAt(const ClaimedSpace& bet) const;

 private:
  void recall(const map::MapView& view);

  std::set<base::PredictionId> recalled_;  ///< told as when they were made
};

/// Settled, and there was an unseen space.
bool cameTrue(const ClaimedSpace& bet);

}  // namespace prodomos::evaluation

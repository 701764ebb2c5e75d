// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/claims.hpp"
#include "prodomos/evaluation/known_space.hpp"
#include "prodomos/evaluation/observed_places.hpp"
#include "prodomos/map/map_view.hpp"

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
  /// Of a settled bet. The ledger keeps it as it was told last before that: with what earlier sub-maps had seen.
  base::Time toldAt(const ClaimedSpace& bet) const;
};

/// Settled, and there was an unseen space.
bool cameTrue(const ClaimedSpace& bet);

}  // namespace prodomos::evaluation

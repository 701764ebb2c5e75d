// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/retrospect.hpp"

#include <algorithm>
#include <iterator>

namespace prodomos::evaluation {

Retrospect::Retrospect(const map::MapView& view)
    : placement(placementOf(view)),
      claims(claimsOf(view, placement)),
      known(knownSpaceOf(view, placement, &map::Node::end)),
      places(known, claims.doors) {
  for (const auto& [id, T_world_submap] : placement.T_world_submap) ends.push_back(view.graph().getNode(id).end);
  std::ranges::sort(ends);
}

const ClaimedDoor* Retrospect::findDoor(base::EntityId id) const {
  const auto found = std::ranges::find(claims.doors, id, &ClaimedDoor::id);
  return found == claims.doors.end() ? nullptr : &*found;
}

base::Time Retrospect::toldAt(const ClaimedSpace& bet) const {
  const auto end = std::ranges::lower_bound(ends, *bet.settled);
  return end == ends.begin() ? bet.made : std::max(bet.made, *std::prev(end));
}

bool cameTrue(const ClaimedSpace& bet) {
  using map::PredictionState;
  return bet.settled && (bet.state == PredictionState::kConfirmed || bet.state == PredictionState::kMerged);
}

}  // namespace prodomos::evaluation

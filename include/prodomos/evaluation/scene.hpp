// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/claims.hpp"
#include "prodomos/evaluation/detections.hpp"
#include "prodomos/evaluation/ground_plan.hpp"
#include "prodomos/evaluation/known_space.hpp"
#include "prodomos/evaluation/truth.hpp"
#include "prodomos/map/map_view.hpp"

#include <optional>
#include <vector>

namespace prodomos::evaluation {

/// What truly lies behind the opening that an entry of the ledger was made for.
struct Behind {
  std::optional<std::size_t> door;    ///< index into Truth::doors
  std::optional<std::size_t> flight;  ///< index into Truth::stairs; it ends at the height that was claimed
  std::optional<std::size_t> room;    ///< index into Truth::rooms, on the far side; none: outside, or not modelled
  /// Nobody knew at least kLeastUnseen of floor there, nor had entered it, when the prediction was made.
  bool isUnseen = false;

  bool exists() const { return door || flight; }
  /// Of a door that leads outside the truth does not tell what lies there.
  bool isJudged() const { return !door || room; }
};

inline constexpr double kLeastUnseen = 2.0;      ///< m²
inline constexpr double kStoreyTolerance = 0.5;  ///< metres between a claimed floor and the true one

/// A map and its truth in one world, and what of the map is what of the truth.
struct Scene {
  Truth truth;
  Claims claims;
  KnownSpace known;
  std::vector<GroundPlan> plans;          ///< by storey
  std::vector<ClaimMatch> doorMatches;    ///< of claims.doors
  std::vector<ClaimMatch> stairsMatches;  ///< of claims.stairs
  std::vector<Behind> behind;             ///< of claims.spaces

  /// Null where it is not a door, or the map has lost it.
  const ClaimedDoor* findDoor(base::EntityId cause) const;
  /// m² of the room's floor that the map did not know then, and all of it.
  double unseenArea(std::size_t room, base::Time at) const;
  double area(std::size_t room) const;
};

Scene makeScene(Truth truth, Claims claims, KnownSpace known);
/// Throws base::Error where the two have no time in common.
Scene makeScene(const map::MapView& view, Truth truth);

}  // namespace prodomos::evaluation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/alignment.hpp"
#include "prodomos/evaluation/cells.hpp"
#include "prodomos/evaluation/truth.hpp"
#include "prodomos/map/map_view.hpp"

#include <map>
#include <optional>
#include <vector>

/// What a map says of doors, stairs and what lies behind them, in a world. Each thing is brought there with the sub-map
/// that saw it (alignment.hpp), so that drift between sub-maps is not charged to a detector.
namespace prodomos::evaluation {

struct ClaimedDoor {
  base::EntityId id;
  int storey = 0;
  geometry::Pose2 T_world_door;  ///< middle of the leaf; the x-axis points to the far side
  map::Door door;
  base::Time firstSeen{};
  base::Time lastSeen{};
};

struct ClaimedStaircase {
  base::EntityId id;
  int storey = 0;                  ///< that it was seen from
  geometry::Pose2 T_world_stairs;  ///< middle of the flight; the x-axis points uphill
  map::Staircase stairs;
  /// Middle of the first riser: half the flight's run downhill from its middle. The run is that of the steps, else that
  /// of the entity's points; without either nobody can say.
  std::optional<Eigen::Vector2d> foot;
};

/// An entry of the ledger.
struct ClaimedSpace {
  base::PredictionId id;
  base::SubMapId node;
  base::EntityId cause;
  std::optional<map::Mobility> mobility;  ///< of its cause; none where the map has lost it
  std::optional<int> storey;              ///< none: at the height of no storey of the world
  double probability = 0.0;
  base::Time made{};
  std::optional<base::Time> settled;
  map::PredictionState state = map::PredictionState::kOpen;
  std::map<double, Polygon> areas_in_world;  ///< by threshold
  Polygon room_in_world;                     ///< the likely room; empty: not told
};

struct Claims {
  std::vector<ClaimedDoor> doors;
  std::vector<ClaimedStaircase> stairs;
  std::vector<ClaimedSpace> spaces;
  /// Of entities, the images in which they were detected: events "detected". None: the map does not tell.
  std::optional<std::multimap<base::EntityId, base::Time>> images;
};

Claims claimsOf(const map::MapView& view, const Placement& placement);
/// In the world of the truth. Throws base::Error where map and truth have no time in common.
Claims claimsOf(const map::MapView& view, const Truth& truth);

}  // namespace prodomos::evaluation

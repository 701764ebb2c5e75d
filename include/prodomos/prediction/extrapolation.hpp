// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/config.hpp"
#include "prodomos/map/entity.hpp"
#include "prodomos/map/prediction.hpp"
#include "prodomos/map/topological_graph.hpp"
#include "prodomos/prediction/room_guess.hpp"
#include "prodomos/prediction/surroundings.hpp"
#include "prodomos/prediction/walk.hpp"

#include <string>
#include <variant>
#include <vector>

/// M(S) of 002: what an entity tells of floor that nobody has seen.
namespace prodomos::prediction {

struct ExtrapolationConfig {
  double doorDistance = 0.5;      ///< metres, d: from a leaf to the origin of the sub-map behind it
  double doorSigma = 3.0;         ///< metres, of eq. (4)
  double doorSkew = 1.0;          ///< per metre of a door's width, c of α = c·w·ô
  double wall = 0.3;              ///< metres from a leaf, and from one side of a wall, to the other side of it
  double leastProbability = 0.9;  ///< of a cell to be floor of the room behind
  double stairsSigma = 0.5;       ///< of eq. (2), in widths of the steps
  double personSigma = 0.35;      ///< metres, of eq. (5)
  double personSkew = 1.0;        ///< |α| of eq. (5), away from the dominant side
  double horizon = 1.5;           ///< seconds that a walk is extrapolated by
  double leastSpeed = 0.3;        ///< m/s; who is slower stands
  double leastArea = 0.1;         ///< m²; what is less is not worth telling
  double range = 30.0;            ///< metres from its sub-map's origin that an entity may lie where nothing is known
};

void describe(base::ConfigVisitor& visitor, ExtrapolationConfig& config);

/// S_j of eq. (1): {P_S; R_S; U_j}, a sub-map that nobody has been in.
struct PredictedSubMap {
  geometry::Pose3 T_i_j = geometry::Pose3::Identity();  ///< into the frame of the entity's sub-map; on the floor, z up
  map::EdgeKind kind = map::EdgeKind::kDoor;
  map::Entity shared_in_j;                ///< the entity with its points, in S_j; `submap` is still that of S_i
  std::vector<map::PredictedArea> areas;  ///< U_j, by ascending threshold; none where nothing can be claimed
  geometry::Polygon room_in_j;            ///< likely outline; empty: not guessed
  double expectedArea = 0.0;              ///< m²: of the room where guessed, else of the greatest area
};

/// U_i of S_i' (eq. 5): floor that is free if the person leaves, where nothing was seen. Each strip is a bet of its
/// own, by ascending threshold, in the frame of the person's sub-map.
struct ConditionalFloor {
  std::vector<std::vector<map::PredictedArea>> strips;
};

/// Such an entity opens no space: objects, boxes, planes.
struct NothingBeyond {};

/// What is not taken at its word.
struct Refusal {
  std::string reason;
};

using Extrapolation = std::variant<PredictedSubMap, ConditionalFloor, NothingBeyond, Refusal>;

/// What extrapolate() refuses the entity for wherever it is; empty: nothing.
std::string faultOf(const map::Entity& entity);

/// T_submap_here: the frame that the surroundings of an entity are told in (see Surroundings); of a person, where it
/// stands and is heading. The identity where extrapolate() has something against it.
geometry::Pose3 T_submap_here(const map::Entity& entity);
/// … of a walk: at its beginning, the x-axis towards its end.
geometry::Pose3 T_submap_here(const Walk& walk);

/// M(S_i) of eq. (1). `around` is told in the entity's T_submap_here(); `guess`: of the room behind a door, null for
/// all others and where none is wanted. A human is taken to leave.
Extrapolation extrapolate(const map::Entity& entity, const Surroundings& around, const RoomGuess* guess,
                          const ExtrapolationConfig& config);

/// Eq. (5) along the observed and the linearly extrapolated way.
std::variant<ConditionalFloor, Refusal> extrapolate(const Walk& walk, const Surroundings& around,
                                                    const ExtrapolationConfig& config);

}  // namespace prodomos::prediction

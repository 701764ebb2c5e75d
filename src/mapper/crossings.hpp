// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pose.hpp"
#include "prodomos/map/entity.hpp"
#include "prodomos/map/topological_graph.hpp"

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <span>
#include <vector>

/// Where a way leads through doors and over stairs: places end there (002 §II-A).
namespace prodomos::mapper {

/// A door, doorway or staircase that a way may lead through.
struct Passage {
  base::EntityId entity;
  geometry::Pose3 T_map_passage = geometry::Pose3::Identity();
  double halfWidth = 0.0;  ///< metres
  double halfRun = 0.0;    ///< metres, of a flight; 0: a door
};

/// Of those that are believed, in their order.
std::vector<Passage> passagesOf(std::span<const map::Entity> entities,
                                const std::function<geometry::Pose3(base::SubMapId)>& T_map_submap);

/// The door, of which a way's end lies on another side than its beginning.
struct Crossing {
  base::EntityId entity;
  double beyond = 0.0;  ///< metres from the door to the way's end
};

/// The one crossed last, if there are several; none where the way comes back from wherever it goes.
std::optional<Crossing> doorCrossed(std::span<const Eigen::Vector3d> way_in_map, std::span<const Passage> passages);

/// The flight that the way goes along; the nearest to its end.
std::optional<base::EntityId> flightClimbed(std::span<const Eigen::Vector3d> way_in_map,
                                            std::span<const Passage> passages);

/// Tells the edge, which the way leads along, whether it is just travelled or leads through a door, and which door or
/// flight is its cause. Loops stay loops.
void nameWay(map::Edge& edge, std::span<const Eigen::Vector3d> way_in_map, std::span<const Passage> passages);

}  // namespace prodomos::mapper

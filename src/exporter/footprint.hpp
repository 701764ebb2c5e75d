// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/entity.hpp"

#include <vector>

namespace prodomos::exporter {

using Polyline = std::vector<Eigen::Vector2d>;

/// A door from above, in its own frame: the leaf as it stands (of a doorway its threshold), and the way it swings;
/// without hinges that are known there is none.
struct DoorPlan {
  Polyline leaf;
  Polyline swing;
};
DoorPlan doorPlan(const map::Door& door);

/// What an entity looks like from above, as lines in the map frame: a door's leaf and swing, a staircase's treads with
/// an arrow uphill, a human as a circle with a nose, a box or patch as its outline.
std::vector<Polyline> footprint(const map::Entity& entity, const geometry::Pose3& T_map_submap);

}  // namespace prodomos::exporter

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/entity.hpp"

#include <vector>

namespace prodomos::exporter {

using Polyline = std::vector<Eigen::Vector2d>;

/// What an entity looks like from above, as lines in the map frame: a door's leaf, a staircase's treads with an arrow
/// uphill, a human as a circle with a nose, a box or patch as its outline.
std::vector<Polyline> footprint(const map::Entity& entity, const geometry::Pose3& T_map_submap);

}  // namespace prodomos::exporter

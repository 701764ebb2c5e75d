// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/config.hpp"
#include "prodomos/map/occupancy_grid.hpp"
#include "prodomos/perception/sightings.hpp"

#include <vector>

namespace prodomos::perception {

struct DoorwayDetectorConfig {
  bool enabled = true;
};

void describe(base::ConfigVisitor& visitor, DoorwayDetectorConfig& config);

/// Gaps of door width between collinear walls of a grid, as a level laser shows them: open doors and doorways, which a
/// laser cannot tell apart (hasLeaf false). The normal points away from `observer_in_submap`. Time and range are those
/// of the caller.
std::vector<DoorSighting> findDoorways(const map::OccupancyGrid& grid, const Eigen::Vector2d& observer_in_submap,
                                       const DoorwayDetectorConfig& config);

}  // namespace prodomos::perception

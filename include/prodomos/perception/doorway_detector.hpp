// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/config.hpp"
#include "prodomos/geometry/pose.hpp"
#include "prodomos/map/occupancy_grid.hpp"
#include "prodomos/perception/sightings.hpp"

#include <vector>

namespace prodomos::perception {

struct DoorwayDetectorConfig {
  bool enabled = true;
  double leastWidth = 0.6;     ///< metres between the jambs
  double mostWidth = 4.0;      ///< metres; wider openings, up to that, are passages between corridors and halls
  double mostThickness = 0.4;  ///< metres, of the wall; deeper ones are corridors
  double leastWall = 0.5;      ///< metres of wall beside the jambs; less is furniture or a person
  double leastSpace = 0.6;     ///< metres of free floor before and behind; less is a niche or a cupboard
  double leastDetour = 4.0;    ///< metres; what one can go around on a shorter way is a gap between furniture
};

void describe(base::ConfigVisitor& visitor, DoorwayDetectorConfig& config);

/// Narrows between two jambs of a grid's walls, as a level laser shows them: open doors and doorways, which a laser
/// cannot tell apart (hasLeaf false). The normal points away from `observer_in_submap`; z is 0. Time and range are
/// those of the caller. Looks at the same grid are not independent of each other.
std::vector<DoorSighting> findDoorways(const map::OccupancyGrid& grid, const Eigen::Vector2d& observer_in_submap,
                                       const DoorwayDetectorConfig& config);

/// Whether a grid in which no doorway is found shows enough of the place of one to tell that there is none: the floor
/// where it would be is free, and a jamb is missing, a wall goes on beyond two of its corners, or all corners are seen.
bool showsNoDoorway(const map::OccupancyGrid& grid, const geometry::Pose2& T_submap_doorway, double width);

}  // namespace prodomos::perception

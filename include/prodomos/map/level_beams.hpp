// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/occupancy_grid.hpp"

#include <optional>
#include <vector>

namespace prodomos::map {

/// A reading's beams as seen from above, and where they begin; none for readings that range nothing. What ends at a
/// mover is left out.
///
/// A scan's beams are its own; those that say nothing are left out, those without a return have the length `noReturn`,
/// or the scanner's range. Of a depth image or a point cloud there is one beam per direction in which something was
/// seen: to the nearest point within the height band over the floor (z = 0 of the sub-map), else without a hit to the
/// farthest point below the band's top. A scan that was swept while the body moved is put right.
std::optional<Eigen::Vector2d> appendLevelBeams(const PlacedReading& placed, const HeightBand& band,
                                                std::vector<OccupancyGrid::Beam>& beams, double noReturn = 0.0);

/// Those of a scan; its mask of movers is a row with a pixel a beam.
void appendLevelBeams(const sensors::LaserScan& scan, const geometry::Pose3& T_grid_sensor, double noReturn,
                      const sensors::Mask* movers, std::vector<OccupancyGrid::Beam>& beams);

}  // namespace prodomos::map

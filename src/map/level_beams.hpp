// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/occupancy_grid.hpp"

#include <vector>

namespace prodomos::map {

/// A scan's beams as seen from above; those that say nothing are left out, those without a return have this length.
void appendLevelBeams(const sensors::LaserScan& scan, const geometry::Pose3& T_grid_sensor, double noReturn,
                      std::vector<OccupancyGrid::Beam>& beams);

/// One beam per direction in which a depth image saw something: to the nearest point within the height band over the
/// floor (z = 0 of the sub-map), else without a hit to the farthest point below the band's top.
void appendLevelBeams(const sensors::RgbdFrame& frame, const geometry::Pose3& T_grid_camera, const HeightBand& band,
                      const sensors::Mask* movers, std::vector<OccupancyGrid::Beam>& beams);

/// The same of a point cloud.
void appendLevelBeams(const sensors::PointCloud& cloud, const geometry::Pose3& T_grid_sensor, const HeightBand& band,
                      const sensors::Mask* movers, std::vector<OccupancyGrid::Beam>& beams);

}  // namespace prodomos::map

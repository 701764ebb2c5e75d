// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/localization/pose_search.hpp"
#include "prodomos/localization/scan_matcher.hpp"
#include "prodomos/map/occupancy_grid.hpp"
#include "prodomos/map/surface_layer.hpp"

#include <memory>
#include <optional>

namespace prodomos::localization {

/// What of a sub-map is matched with others.
struct MatchedLayers {
  std::shared_ptr<const map::SurfaceLayer> surface;
  std::shared_ptr<const map::OccupancyGrid> grid;
};

struct SubMapMatcherConfig {
  double searchResolution = 0.1;  ///< metres
  double leastScore = 0.35;       ///< mean likelihood of the points where the search ends
  double leastOverlap = 0.25;     ///< share of the points of either that must lie on the other's surface
  double leastWall = 4.0;         ///< metres of wall that both see
  double mostConflict = 0.15;     ///< share of the compared points that lie where the other has seen free floor
  double leastLead = 0.06;        ///< by which a pose must score better than any other place of the window
};

/// How two sub-maps lie to each other, were they to see the same place.
struct SubMapMatch {
  geometry::Pose2 T_from_to;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of x, y, theta in the axes of `to`
  double overlap = 0.0;   ///< share of the points, of the sub-map that has the fewer, that lie on the other's surface
  double conflict = 0.0;  ///< share of the compared points that contradict
};

/// None where they do not see the same place within the window, or where it cannot be told which place it is.
std::optional<SubMapMatch> matchSubMaps(const MatchedLayers& from, const MatchedLayers& to, const SearchWindow& window,
                                        const SubMapMatcherConfig& config = {});

}  // namespace prodomos::localization

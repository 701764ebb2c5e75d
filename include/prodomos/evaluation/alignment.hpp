// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/id.hpp"
#include "prodomos/evaluation/timed_poses.hpp"
#include "prodomos/evaluation/truth.hpp"
#include "prodomos/map/map_view.hpp"

#include <map>
#include <optional>
#include <vector>

/// A map begins where its robot did, the truth has a world: where the one lies in the other is told by when the robot
/// was where. All frames are level, so what is sought is a heading and a position.
namespace prodomos::evaluation {

/// Between two poses no more than half a second apart, or the one of just that time; none elsewhere. `poses` ascend in
/// time.
std::optional<geometry::Pose3> poseAt(const std::vector<TimedPose>& poses, base::Time time);

/// T_world_map that brings the map's way nearest to the true one: least squares of positions, where a radian of heading
/// counts like a metre, so that a robot that only turned is aligned too. What remains is the map's error, drift and
/// all. Throws base::Error where the two have no time in common.
geometry::Pose3 truthFromMap(const std::vector<TimedPose>& mapPoses, const Truth& truth);

/// T_world_submap of every observed sub-map with a part of the way, brought near by that part alone: what lies in a
/// sub-map is judged where its robot stood, and drift between sub-maps does not count. Sub-maps whose part has no true
/// pose follow the whole map. Throws as truthFromMap().
std::map<base::SubMapId, geometry::Pose3> truthFromSubMaps(const map::MapView& view, const Truth& truth);

/// The storey whose floor is nearest to that height; 0 where there is none.
int storeyAt(const Truth& truth, double z);

/// A map in a world: where its observed sub-maps lie there, and how high the floors of the storeys are.
struct Placement {
  std::map<base::SubMapId, geometry::Pose3> T_world_submap;
  std::vector<double> floors_z;  ///< index is the storey

  int storeyAt(double z) const;  ///< the nearest; 0 where there is none
  /// None where no floor is within a metre.
  std::optional<int> modelledStoreyAt(double z) const;
};

/// As truthFromSubMaps(). Throws as it does.
Placement placementOf(const map::MapView& view, const Truth& truth);
/// Without truth the map's own frame is the world, and its floors, by height, are the storeys.
Placement placementOf(const map::MapView& view);

}  // namespace prodomos::evaluation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/time.hpp"
#include "prodomos/map/entity.hpp"
#include "prodomos/map/topological_graph.hpp"

#include <optional>
#include <vector>

/// What detectors say of one reading: entities as that reading alone shows them, in the frame of the running sub-map.
/// EntityMemory makes lasting entities of them.
namespace prodomos::perception {

/// Of (x, y, z, yaw) in the sub-map: metres, radians. Large along what a reading does not show.
using Covariance4 = Eigen::Matrix4d;

/// A door or doorway as one reading shows it (002 §II-D). Axes as map::Door's entity: x is the normal, away from the
/// observer (o = n·sgn(nᵀ(t − sensor))); the origin is the middle of the closed leaf, or of the opening, on the floor.
struct DoorSighting {
  base::Time time{};
  std::optional<base::Time> since{};  ///< of sightings in a grid: when it was begun
  geometry::Pose3 T_submap_door = geometry::Pose3::Identity();
  Covariance4 covariance = Covariance4::Zero();
  map::Door door;              ///< hingeSide and state kUnknown where this reading does not tell
  double widthSigma = 0.0;     ///< metres
  double hingeEvidence = 0.0;  ///< log-odds of the hinge on the left, seen along x; 0: says nothing
  double openAngle = 0.0;      ///< radians from closed, of a leaf that is seen open or ajar
  double evidence = 0.0;       ///< log-odds that there is a door or doorway, as this reading alone tells
  bool whole = true;           ///< false: cut by the image's border or hidden in part
  double range = 0.0;          ///< metres from the sensor
};

/// One tread of a flight.
struct Step {
  double z = 0.0;      ///< height of the tread in the sub-map, metres
  double along = 0.0;  ///< of its front edge, metres from the sighting's origin uphill
  double depth = 0.0;  ///< of the tread, metres; 0: not measured
  double width = 0.0;  ///< across, metres
};

/// A flight as one reading shows it (002 §II-C). Axes as map::Staircase's entity: x uphill, level. The origin is the
/// middle of the foot: where the steps, continued downwards, stand on the robot's floor, should they do so at a riser;
/// else the lower edge of the lowest riser that was seen.
struct StaircaseSighting {
  base::Time time{};
  geometry::Pose3 T_submap_stairs = geometry::Pose3::Identity();
  Covariance4 covariance = Covariance4::Zero();
  std::vector<Step> steps;    ///< treads that were seen one by one, upwards
  double slope = 0.0;         ///< rise over run of the plane through the edges
  double width = 0.0;         ///< metres; of what was seen
  bool widthIsWhole = false;  ///< both sides were seen
  bool footIsSeen = false;    ///< the lowest step meets the floor that the robot is on
  bool headIsSeen = false;    ///< the landing at the top was seen
  bool descends = false;      ///< leads down from the robot's floor
  /// Height of the floor or landing that the flight leads to, in the sub-map: seen, else told by the ceiling, else
  /// guessed from the steps that were seen; the sigma says how sure. Sigma 0: nothing is said.
  double newFloor_z = 0.0;
  double newFloorSigma = 0.0;  ///< metres
  double evidence = 0.0;       ///< log-odds that this is a staircase, as this reading alone tells
  std::vector<Eigen::Vector3f> points_in_submap;
};

}  // namespace prodomos::perception

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "perception/door_landmark.hpp"

#include <optional>

namespace prodomos::perception {

/// Where a door is believed, in one common sub-map.
struct DoorPlace {
  Vector4 pose = Vector4::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();
  double width = 0.0;
  double widthSigma = 0.0;
  bool hasLeaf = true;
};

DoorPlace placeOf(const DoorSighting& sighting);
DoorPlace placeOf(const DoorLandmark& door, const Frames& frames, const EntityMemoryConfig& config);

/// Squared Mahalanobis distance of two that may be one, seen from whichever side; none where they cannot: too far off
/// in the wall, before it, in heading, height or width. Doors that only adjoin are two.
std::optional<double> distanceOfSame(const DoorPlace& a, const DoorPlace& b, const EntityMemoryConfig& config);

/// Whether what was taken for a closed door is the leaf of one that stands open: it hangs at a jamb, turned. Then on
/// which side of the door, seen along its normal.
std::optional<map::HingeSide> hingeSideOfLeaf(const DoorPlace& leaf, const DoorPlace& door);

/// Two openings in the same stretch of wall, which cannot both be there.
bool standInOnePlace(const DoorPlace& a, const DoorPlace& b);

/// Seen from opposite sides.
bool areOpposed(double yaw, double otherYaw);

/// Could such a thing be a door?
bool isPossible(const DoorSighting& sighting, const EntityMemoryConfig& config);

}  // namespace prodomos::perception

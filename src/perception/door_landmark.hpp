// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "perception/door_state.hpp"
#include "perception/landmark.hpp"
#include "perception/mean.hpp"

#include <vector>

namespace prodomos::perception {

struct DoorLook : Look {
  Vector4 pose_in_submap = Vector4::Zero();               ///< its normal as the landmark's
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();  ///< sum over the sightings
  Mean width;                                             ///< by information
  Mean height;                                            ///< of the sightings that tell one
  double hinge = 0.0;                                     ///< sum of log-odds of the left side
  double leaf = 0.0;                                      ///< sum of log-odds that there is a leaf

  static void fields(auto& archive, auto& self) {
    Look::fields(archive, self);
    archive(self.pose_in_submap, self.information, self.width, self.height, self.hinge, self.leaf);
  }
};

struct DoorLandmark : Landmark {
  std::vector<DoorLook> looks;
  Vector4 pose_in_submap = Vector4::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();
  double width = 0.0;
  double widthSigma = 0.0;
  double height = 0.0;
  double hinge = 0.0;      ///< log-odds of the left side
  double leaf = 0.0;       ///< log-odds that there is a leaf
  double leafAside = 0.0;  ///< of `leaf`, what was seen of it where it stood open, and of `hinge`
  double hingeAside = 0.0;
  DoorStateFilter state;
  double closedLeafNow = 0.0;  ///< evidence for a leaf that the last reading gave by a closed one
  bool isRivalled = false;     ///< one that is likelier stands in the same place

  static void fields(auto& archive, auto& self) {
    Landmark::fields(archive, self);
    archive(self.looks, self.pose_in_submap, self.covariance, self.width, self.widthSigma, self.height, self.hinge,
            self.leaf, self.leafAside, self.hingeAside, self.state, self.closedLeafNow, self.isRivalled);
  }
};

/// One more sighting of the door, as it lies in the look's sub-map.
void fuse(DoorLook& look, DoorSighting sighting, double yaw_in_submap, const EntityMemoryConfig& config);

/// Pose, size, hinge and existence from all looks, anchored where it was seen best.
void refresh(DoorLandmark& door, const Frames& frames, const EntityMemoryConfig& config);

/// `other`'s looks become `kept`'s, which lies where both are.
void takeOver(DoorLandmark& kept, const DoorLandmark& other, const Frames& frames);

/// Where none was seen, it is a doorway.
bool hasLeaf(const DoorLandmark& door);
map::Entity entityOf(const DoorLandmark& door);

}  // namespace prodomos::perception

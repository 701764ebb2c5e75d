// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "perception/landmark.hpp"
#include "perception/mean.hpp"
#include "perception/step_ladder.hpp"

#include <vector>

namespace prodomos::perception {

/// A tread that readings of one look show again and again.
struct Rung {
  Eigen::Vector3d edge_in_submap = Eigen::Vector3d::Zero();  ///< middle of its front edge
  int readings = 0;

  static void fields(auto& archive, auto& self) { archive(self.edge_in_submap, self.readings); }
};

struct StaircaseLook : Look {
  Eigen::Vector3d first_in_submap = Eigen::Vector3d::Zero();  ///< origin of the first sighting
  double heading = 0.0;                                       ///< uphill, mean
  double headingInformation = 0.0;
  std::vector<Rung> rungs;
  Mean riser;  ///< by the steps in a row
  Mean left;   ///< across from the first origin, metres
  Mean right;
  int wholes = 0;  ///< sightings of the whole width
  Mean foot_z;     ///< floor below the lowest step, where it is seen
  Mean head_z;     ///< floor or landing above the highest, by information

  static void fields(auto& archive, auto& self) {
    Look::fields(archive, self);
    archive(self.first_in_submap, self.heading, self.headingInformation, self.rungs, self.riser, self.left, self.right,
            self.wholes, self.foot_z, self.head_z);
  }
};

struct StaircaseLandmark : Landmark {
  std::vector<StaircaseLook> looks;
  double heading = 0.0;                                      ///< uphill
  Eigen::Vector3d foot_in_submap = Eigen::Vector3d::Zero();  ///< middle of the first riser's lower edge
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();
  double riser = 0.0;
  double depth = 0.0;
  double rise = 0.0;  ///< from the foot to the floor above
  double width = 0.0;
  bool widthIsWhole = false;
  bool descendsNow = false;   ///< in the last sighting: the robot is on the floor above
  std::size_t mostSteps = 0;  ///< of one sighting: the one whose points are kept
  base::SubMapId pointsSubmap;
  std::vector<Eigen::Vector3f> points;

  double slope() const { return riser / depth; }
  double run() const { return rise / slope(); }

  static void fields(auto& archive, auto& self) {
    Landmark::fields(archive, self);
    archive(self.looks, self.heading, self.foot_in_submap, self.covariance, self.riser, self.depth, self.rise,
            self.width, self.widthIsWhole, self.descendsNow, self.mostSteps, self.pointsSubmap, self.points);
  }
};

/// One more sighting, as it lies in the look's sub-map.
void fuse(StaircaseLandmark& stairs, StaircaseLook& look, const StaircaseSighting& sighting);

/// The flight leads down from the floor that the robot is on.
void fuseFloorAbove(StaircaseLook& look, double floor_z);

/// Steps, foot, head and width from all looks, anchored where it was seen best. False where no two steps are known.
bool refresh(StaircaseLandmark& stairs, const Frames& frames, const EntityMemoryConfig& config);

map::Entity entityOf(const StaircaseLandmark& stairs);

}  // namespace prodomos::perception

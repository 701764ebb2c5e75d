// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pose.hpp"
#include "prodomos/perception/rgbd_view.hpp"
#include "prodomos/perception/surfaces.hpp"

#include "perception/scan_segments.hpp"

#include <vector>

namespace prodomos::perception {

/// What a depth image or a scan shows where a door is believed: shares of spots on its leaf.
struct DoorAppearance {
  double range = 0.0;      ///< metres, from the camera to the door's middle
  double obliquity = 0.0;  ///< radians between the line of sight and the normal
  bool isWhole = false;    ///< both jambs and the top are in the image
  double hidden = 0.0;     ///< something stands before it
  double filled = 0.0;     ///< a surface in the plane of the door
  double through = 0.0;    ///< one sees through
  double unknown = 1.0;    ///< out of the image or without depth
  bool hasNoWall = false;  ///< one sees through on both sides of it too

  double known() const { return 1.0 - hidden - unknown; }
};

DoorAppearance appearanceOf(const geometry::Pose3& T_submap_door, double width, double height, const RgbdView& view,
                            const Surfaces& surfaces);
/// By the beams of a level scan that lead to the leaf's place; `isWhole` and `hasNoWall` are not told.
DoorAppearance appearanceOf(const geometry::Pose3& T_sensor_door, double width, const std::vector<ScanBeam>& beams);

}  // namespace prodomos::perception

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/time.hpp"
#include "prodomos/geometry/pose.hpp"
#include "prodomos/sensors/reading.hpp"

#include <cmath>

namespace prodomos::perception {

/// One RGB-D frame, and where it was taken. The sub-map's z points up against gravity.
struct RgbdView {
  base::Time time{};
  const sensors::RgbdFrame& frame;
  geometry::Pose3 T_submap_camera = geometry::Pose3::Identity();
  double floor_z = 0.0;                   ///< of the floor below the robot, in the sub-map, metres
  const sensors::Mask* movers = nullptr;  ///< pixels of what moves; null: none
};

/// Can points be made of it? Not without depth, a pinhole camera and a place.
inline bool hasPoints(const RgbdView& view) {
  const sensors::CameraIntrinsics& camera = view.frame.camera;
  return !view.frame.depth.empty() && camera.fx > 0.0 && camera.fy > 0.0 && std::isfinite(camera.fx * camera.fy) &&
         std::isfinite(camera.cx + camera.cy) && geometry::isFinite(view.T_submap_camera) &&
         std::isfinite(view.floor_z);
}

}  // namespace prodomos::perception

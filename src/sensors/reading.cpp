// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/sensors/reading.hpp"

namespace prodomos::sensors {

std::string_view kindName(const ReadingData& data) {
  static constexpr std::array<std::string_view, std::variant_size_v<ReadingData>> kNames = {
      "laser_scan", "odometry", "recorded_pose", "rgbd_frame", "point_cloud", "detections", "key_points"};
  return kNames[data.index()];
}

geometry::Pose3 cameraAxesInBody() {
  geometry::Pose3 axes = geometry::Pose3::Identity();
  axes.linear() << 0, 0, 1,  //
      -1, 0, 0,              //
      0, -1, 0;
  return axes;
}

}  // namespace prodomos::sensors

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/reading.hpp"

#include <cmath>

namespace prodomos::map {

/// Whether the i-th pixel, point or beam is of something that moves. No mask or an empty one: nothing moves.
inline bool isMover(const sensors::Mask* movers, std::size_t i) {
  return movers != nullptr && !movers->empty() && movers->pixels()[i] != 0;
}

/// Calls use(point_in_camera, x, y) for each step-th pixel of each step-th row whose depth is known and which is of
/// nothing that moves. Depth images are taken as rectified.
template <typename Use>
void forEachDepthPoint(const sensors::RgbdFrame& frame, int step, const sensors::Mask* movers, Use&& use) {
  for (int y = 0; y < frame.depth.height(); y += step) {
    const float* depths = frame.depth.row(y);
    const double rayY = (y - frame.camera.cy) / frame.camera.fy;
    for (int x = 0; x < frame.depth.width(); x += step) {
      const double depth = static_cast<double>(depths[x]);
      const auto pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.depth.width()) + static_cast<std::size_t>(x);
      if (!(depth > 0.0) || !std::isfinite(depth) || isMover(movers, pixel)) continue;
      use(Eigen::Vector3d((x - frame.camera.cx) / frame.camera.fx * depth, rayY * depth, depth), x, y);
    }
  }
}

}  // namespace prodomos::map

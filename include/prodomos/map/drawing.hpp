// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pose.hpp"
#include "prodomos/sensors/image.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace prodomos::map {

struct Rgba {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
  std::uint8_t a = 255;

  bool operator==(const Rgba&) const = default;
};

/// Coloured cells seen from above, in the x-y-plane of the sub-map; row 0 lies at the smallest y.
struct DrawnRaster {
  Eigen::Vector2d corner_in_submap = Eigen::Vector2d::Zero();  ///< of pixel (0, 0), metres
  double resolution = 0.05;                                    ///< metres a pixel
  sensors::Image<Rgba> pixels;
};

struct DrawnPoint {
  Eigen::Vector3f position_in_submap = Eigen::Vector3f::Zero();
  Rgba color;
};

struct DrawnBox {
  geometry::Pose3 T_submap_box = geometry::Pose3::Identity();  ///< of the centre
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  Rgba color;
  std::string label;
};

struct DrawnLine {
  std::vector<Eigen::Vector3d> points_in_submap;
  Rgba color;
  std::string label;
};

/// What a layer looks like, in the frame of its sub-map, from primitives that every exporter and viewer can draw.
struct Drawing {
  std::vector<DrawnRaster> rasters;
  std::vector<DrawnPoint> points;
  std::vector<DrawnBox> boxes;
  std::vector<DrawnLine> lines;
};

}  // namespace prodomos::map

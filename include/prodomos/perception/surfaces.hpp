// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/config.hpp"
#include "prodomos/geometry/plane.hpp"
#include "prodomos/perception/rgbd_view.hpp"
#include "prodomos/sensors/depth_grid.hpp"

#include <cstdint>
#include <vector>

namespace prodomos::perception {

struct SurfacesConfig {
  double voxel = 0.05;      ///< metres; one point a voxel takes part in the search for planes
  double maxDepth = 8.0;    ///< metres
  double leastArea = 0.15;  ///< m²; smaller patches are none
  std::uint64_t seed = 1;
};

void describe(base::ConfigVisitor& visitor, SurfacesConfig& config);

/// A piece of a plane (002 §II-C).
struct PlanarPatch {
  geometry::Plane plane_in_submap;                               ///< its normal points to the camera's side
  Eigen::Vector3d centroid_in_submap = Eigen::Vector3d::Zero();  ///< metres
  double area = 0.0;                                             ///< m²
  std::vector<std::uint32_t> cells;                              ///< of the depth grid, ascending: y * width + x

  /// Angle of the normal from the vertical, radians in [0, pi/2]: 0 for floors, pi/2 for walls.
  double tilt() const;
};

/// What one view shows of planes: shared by all detectors, so that it is found once a frame.
struct Surfaces {
  sensors::DepthGrid depth;           ///< with normals, in the camera
  std::vector<PlanarPatch> patches;   ///< by area, the greatest first
  std::vector<std::uint32_t> voxels;  ///< cells of the depth grid with a normal, one a voxel; ascending
  double floor_z = 0.0;               ///< in the sub-map: as this view shows the floor, else the view's own
  bool floorIsSeen = false;
};

/// Voxel filter, then planar patches by RANSAC (002 §II-C). Without usable depth: no patches.
Surfaces findSurfaces(const RgbdView& view, const SurfacesConfig& config);

}  // namespace prodomos::perception

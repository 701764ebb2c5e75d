// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/map_view.hpp"

#include "exporter/drawn_objects.hpp"

#include <Eigen/Geometry>
#include <mrpt/opengl/COpenGLScene.h>

/// The map as a scene of MRPT's: one plane a floor, what each sub-map's layers draw, the graph lifted above its floors.
namespace prodomos::exporter {

struct Scene {
  mrpt::opengl::COpenGLScene::Ptr objects;
  Eigen::AlignedBox3d extent_in_map;  ///< of walls and nodes; free space seen through windows may lie outside
};

Scene makeScene(const map::MapView& view, const Pen& pen = {});

/// Where a camera stands and looks.
struct Viewpoint {
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  double azimuth = 0.0;       ///< degrees, of the camera as seen from the target
  double elevation = 0.0;     ///< degrees
  double distance = 1.0;      ///< metres from the target
  double fieldOfView = 30.0;  ///< degrees, vertical

  /// With the wide default range of MRPT's, what stands in front is drawn behind the floors.
  double leastDepth() const { return 0.4 * distance; }
  double greatestDepth() const { return 3.0 * distance; }

  bool operator==(const Viewpoint&) const = default;
};

/// Sees all of the box, from above and aside, as near as its corners allow.
Viewpoint overview(const Eigen::AlignedBox3d& extent, double widthToHeight);
void setCamera(mrpt::opengl::COpenGLScene& scene, const Viewpoint& viewpoint);

}  // namespace prodomos::exporter

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pose.hpp"
#include "prodomos/map/drawing.hpp"

#include <mrpt/img/TColor.h>
#include <mrpt/math/TPoint3D.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/poses/CPose3D.h>

/// From the primitives that layers draw to objects of MRPT's 3D scenes.
namespace prodomos::exporter {

mrpt::poses::CPose3D toMrpt(const geometry::Pose3& pose);
mrpt::math::TPoint3D toMrpt(const Eigen::Vector3d& point);
mrpt::img::TColor toMrpt(map::Rgba color);

/// How thick lines, points and letters are: in pixels, which pictures that are scaled down later have more of.
struct Pen {
  double pixels = 1.0;  ///< a unit

  float line(double units) const { return static_cast<float>(units * pixels); }
  int text() const { return static_cast<int>(13.0 * pixels); }
};

/// All of the drawing, in its own frame.
mrpt::opengl::CSetOfObjects::Ptr toObjects(const map::Drawing& drawing, const Pen& pen);
/// A text that always faces the viewer.
mrpt::opengl::CRenderizable::Ptr toLabel(const std::string& text, const Eigen::Vector3d& position, map::Rgba color,
                                         const Pen& pen);

}  // namespace prodomos::exporter

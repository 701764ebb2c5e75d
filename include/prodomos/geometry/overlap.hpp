// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pose.hpp"

#include <Eigen/Core>

#include <vector>

/// How much two shapes have in common. All exact, but for rounding.
namespace prodomos::geometry {

/// m², of a simple polygon (not closed, either way round).
double areaOf(const std::vector<Eigen::Vector2d>& polygon);

/// m² that lie in both. The polygons must be simple, but need not be convex.
double sharedArea(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b);

/// A box that may lie askew.
struct OrientedBox {
  Pose3 T_frame_box = Pose3::Identity();           ///< of its middle
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< along its own axes, metres
};

double volumeOf(const OrientedBox& box);

/// m³ that lie in both; the boxes are given in one frame.
double sharedVolume(const OrientedBox& a, const OrientedBox& b);

/// Shared volume by that of both together, 0 … 1; 0 where neither has any.
double intersectionOverUnion(const OrientedBox& a, const OrientedBox& b);

}  // namespace prodomos::geometry

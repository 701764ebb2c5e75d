// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/plane.hpp"
#include "prodomos/geometry/pose.hpp"
#include "prodomos/perception/rgbd_view.hpp"
#include "prodomos/perception/surfaces.hpp"

#include <cmath>
#include <vector>

namespace prodomos::perception {

/// A spot on a patch's edge, past which one looks on.
struct EdgePoint {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< metres to the right, seen from the camera, and up
  double sigma = 0.0;                               ///< metres: half a pixel
  int past = 0;                                     ///< 0: above it one looks on; 1: to its right; -1: to its left
};

/// An upright patch that may be the side of a flight. Its steps are small: one looks at pixels, not at cells.
class Side {
 public:
  Side(const RgbdView& view, const Surfaces& surfaces, const PlanarPatch& patch)
      : depth_(view.frame.depth),
        grid_(surfaces.depth),
        patch_(patch),
        T_camera_submap_(view.T_submap_camera.inverse()),
        plane_in_camera_(geometry::transformed(T_camera_submap_, patch.plane_in_submap)),
        right_(Eigen::Vector3d::UnitZ().cross(patch.plane_in_submap.normal).normalized()),
        middle_(patch.centroid_in_submap) {}

  const Eigen::Vector3d& right() const { return right_; }
  Eigen::Vector3d pointAt(const Eigen::Vector2d& place) const {
    return middle_ + place.x() * right_ + place.y() * Eigen::Vector3d::UnitZ();
  }
  /// Upper and lateral edges. The lower ones tell nothing of steps.
  std::vector<EdgePoint> edge() const;

  enum class Shown { kNothing, kSide, kPast };
  /// What the view shows where that spot of the plane is; nothing where it is out of the image or something hides it.
  Shown at(const Eigen::Vector3d& spot_in_submap) const;

 private:
  Shown at(int u, int v, const Eigen::Vector3d& ray) const;
  Eigen::Vector2d placeOf(const Eigen::Vector3d& ray) const;
  /// As the treads behind the side are.
  bool isTurnedAway(const sensors::DepthGrid::Cell& cell) const {
    constexpr double kCosine = 0.4;
    const Eigen::Vector3d normal = normalOf(cell);
    return !normal.isZero() && normal.dot(plane_in_camera_.normal) < kCosine;
  }
  void addEdge(int x, int y, int dx, int dy, std::vector<EdgePoint>& points) const;

  const sensors::Image<float>& depth_;
  const sensors::DepthGrid& grid_;
  const PlanarPatch& patch_;
  geometry::Pose3 T_camera_submap_;
  geometry::Plane plane_in_camera_;
  Eigen::Vector3d right_;  ///< along the plane, level
  Eigen::Vector3d middle_;
};

/// Points of an edge along one slope. Places are turned so that x is uphill.
struct Outline {
  double rise = 0.0;  ///< over run
  std::vector<EdgePoint> points;

  double along(const EdgePoint& p) const { return (p.place.x() + rise * p.place.y()) / std::hypot(1.0, rise); }
  double above(const EdgePoint& p) const { return (p.place.y() - rise * p.place.x()) / std::hypot(1.0, rise); }
  Eigen::Vector2d middle() const;
};

/// The parts of an edge that look like a flight's steps, of upper edges (treads) and of those that one looks past
/// downhill (risers). `uphill`: 1 to the right, -1 to the left.
std::vector<Outline> findSawtooths(const std::vector<EdgePoint>& edge, int uphill);

}  // namespace prodomos::perception

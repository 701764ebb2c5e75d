// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"
#include "prodomos/simulation/surface.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace prodomos::simulation {

/// The parts of one thing, in a frame of its own: x to its front, z up, origin in the middle of its box's bottom. One
/// surface a material.
class Shape {
 public:
  using Part = std::size_t;  ///< a material in use

  Shape(const Thing& thing, std::uint16_t classId, std::uint16_t instance);

  double depth() const { return size_.x(); }
  double width() const { return size_.y(); }
  double height() const { return size_.z(); }
  double front() const { return size_.x() / 2.0; }
  double right() const { return -size_.y() / 2.0; }
  double left() const { return size_.y() / 2.0; }
  double back() const { return -size_.x() / 2.0; }

  Part use(const Material& material);
  void box(Part part, const Eigen::Vector3d& low, const Eigen::Vector3d& high);
  /// Four of them, at the corners of a rectangle around the origin.
  void legs(Part part, const Eigen::Vector2d& rectangle, double thickness, double bottom, double top);
  /// Upright; wider or narrower at its top.
  void cone(Part part, const Eigen::Vector2d& middle, double bottomRadius, double topRadius, double bottom, double top);
  void cylinder(Part part, const Eigen::Vector2d& middle, double radius, double bottom, double top) {
    cone(part, middle, radius, radius, bottom, top);
  }
  void ellipsoid(Part part, const Eigen::Vector3d& middle, const Eigen::Vector3d& radii);
  /// A blade seen from both sides, from its root to its tip, cut off at the thing's box.
  void leaf(Part part, const Eigen::Vector3d& root, const Eigen::Vector3d& tip, double width);
  /// Corners counter-clockwise seen from outside.
  void face(Part part, const std::vector<Eigen::Vector3d>& corners);

  /// In the world.
  std::vector<Surface> surfaces() const;

 private:
  void addSmooth(Part part, const std::vector<Eigen::Vector3d>& ring, const std::vector<Eigen::Vector3d>& normals,
                 std::size_t columns);

  geometry::Pose3 T_world_shape_;
  Eigen::Vector3d size_;
  std::uint16_t classId_;
  std::uint16_t instance_;
  std::vector<Surface> surfaces_in_shape_;
};

}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/geometry/pose.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace prodomos::geometry {

/// The points p with normal · p = offset.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< of length one
  double offset = 0.0;                                ///< metres from the origin along the normal

  /// Metres; positive on the side that the normal points to.
  double signedDistance(const Eigen::Vector3d& point) const { return normal.dot(point) - offset; }
  Plane flipped() const { return {-normal, -offset}; }
};

/// The same plane, told in a.
inline Plane transformed(const Pose3& T_a_b, const Plane& plane_in_b) {
  const Eigen::Vector3d normal = T_a_b.linear() * plane_in_b.normal;
  return {normal, plane_in_b.offset + normal.dot(T_a_b.translation())};
}

/// Least squares of the distances. None for fewer than three points, or for points on a line.
std::optional<Plane> fitPlane(std::span<const Eigen::Vector3d> points);

/// A plane and the points that lie on it.
struct FoundPlane {
  Plane plane;
  std::vector<std::uint32_t> inliers;  ///< ascending indices of the points
};

/// What is looked for in a cloud, and how hard.
struct PlaneSearch {
  int trials = 200;
  /// Metres that a point may lie off the plane: noise grows with range, and so may this.
  std::function<double(const Eigen::Vector3d& point)> tolerance = [](const Eigen::Vector3d&) { return 0.03; };
  /// Planes it is false for are none. Their normal may point to either side; see `facing`.
  std::function<bool(const Plane&)> accepts = [](const Plane&) { return true; };
  /// The normal is turned to this side.
  Eigen::Vector3d facing = Eigen::Vector3d::UnitZ();
};

/// The accepted plane that most points lie on: RANSAC (Fischler and Bolles 1981), then least squares on its inliers.
/// Draws all its chance from `random`. None where no three points give an accepted plane.
std::optional<FoundPlane> findPlane(std::span<const Eigen::Vector3d> points, const PlaneSearch& search,
                                    base::Random& random);

}  // namespace prodomos::geometry

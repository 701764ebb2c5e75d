// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/surface.hpp"

#include <Eigen/Geometry>

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace prodomos::test {

struct BruteHit {
  double distance = std::numeric_limits<double>::infinity();
  std::size_t surface = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of the triangle's front, not unit
};

/// What the ray meets first of all triangles, each tried: Möller and Trumbore 1997. Edges belong to triangles.
inline std::optional<BruteHit> castBruteForce(const std::vector<simulation::Surface>& surfaces,
                                              const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  constexpr double kEdge = 1e-6;
  std::optional<BruteHit> nearest;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const auto& vertices = surfaces[s].vertices;
    for (const auto& triangle : surfaces[s].triangles) {
      const Eigen::Vector3d a = vertices[triangle[0]].cast<double>();
      const Eigen::Vector3d ab = vertices[triangle[1]].cast<double>() - a;
      const Eigen::Vector3d ac = vertices[triangle[2]].cast<double>() - a;
      const Eigen::Vector3d p = direction.cross(ac);
      const double determinant = ab.dot(p);
      if (determinant == 0.0) continue;
      const Eigen::Vector3d from = origin - a;
      const double u = from.dot(p) / determinant;
      const Eigen::Vector3d q = from.cross(ab);
      const double v = direction.dot(q) / determinant;
      const double distance = ac.dot(q) / determinant;
      if (u < -kEdge || v < -kEdge || u + v > 1.0 + kEdge || distance <= 0.0) continue;
      if (!nearest || distance < nearest->distance) nearest = BruteHit{distance, s, ab.cross(ac)};
    }
  }
  return nearest;
}

}  // namespace prodomos::test

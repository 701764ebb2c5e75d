// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/surface.hpp"

#include <Eigen/Core>

#include <vector>

namespace prodomos::simulation {

/// A cross section: an ellipse, or with a greater `squareness` a rounded rectangle. The loft runs along side × front.
struct Ring {
  Eigen::Vector3d center;
  Eigen::Vector3d side;   ///< half axis
  Eigen::Vector3d front;  ///< half axis
  double squareness = 2.0;
};

/// How a loft ends: in a dome of that height, metres; 0 leaves it open.
struct Domes {
  double first = 0.0;
  double last = 0.0;
};

/// Adds a smooth skin over the rings, with normals, and texture coordinates in metres.
void addLoft(Surface& surface, std::vector<Ring> rings, int around, const Domes& domes = {});

/// Half axes a, b, c: c points to the poles.
void addEllipsoid(Surface& surface, const Eigen::Vector3d& center, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                  const Eigen::Vector3d& c, int around);

}  // namespace prodomos::simulation

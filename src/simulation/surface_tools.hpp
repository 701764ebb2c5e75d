// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"
#include "prodomos/simulation/surface.hpp"

#include <Eigen/Geometry>

#include <vector>

namespace prodomos::simulation {

Eigen::AlignedBox3f boundsOf(const Surface& surface);
Eigen::AlignedBox2d planOf(const Eigen::AlignedBox3f& box);
/// Counter-clockwise.
Polygon cornersOf(const Eigen::AlignedBox2d& box);

/// Pieces whose triangles hang together: corners within a millimetre are one. In the order of their first triangles.
std::vector<Surface> connectedPieces(const Surface& surface);

/// The surface without what lies within the box; triangles that reach out of it are cut at its sides.
Surface cutAway(const Surface& surface, const Eigen::AlignedBox3d& box);

struct Segment {
  Eigen::Vector2d a;
  Eigen::Vector2d b;
};

/// Where the level plane at height z meets the surface, seen from above.
std::vector<Segment> sliceAt(const Surface& surface, double z);

}  // namespace prodomos::simulation

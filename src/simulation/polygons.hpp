// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

/// Areas in the plane, metres.
namespace prodomos::simulation {

/// The edge from corner i to the next one; of a counter-clockwise polygon its inside lies to the left.
struct Edge {
  Eigen::Vector2d from;
  Eigen::Vector2d to;

  double length() const { return (to - from).norm(); }
  Eigen::Vector2d direction() const { return (to - from).normalized(); }
  Eigen::Vector2d outward() const { return {direction().y(), -direction().x()}; }
};
Edge edgeOf(const Polygon& polygon, std::size_t i);

/// Counter-clockwise, without repeated corners, corners on a straight line, and needles (the outline runs back over
/// itself), all to within a tolerance. Empty where no area is left.
Polygon cleaned(Polygon polygon, double tolerance);

/// With as few corners as keep all of them within a tolerance of the new edges; as it is where that would make it
/// cross itself.
Polygon simplified(const Polygon& polygon, double tolerance);

/// Moved inwards by a distance (outwards where it is negative) with mitred corners: its pieces, the greatest first,
/// counter-clockwise.
std::vector<Polygon> inset(const Polygon& polygon, double distance);

double overlapArea(const Polygon& a, const Polygon& b);

/// What of `a` lies outside of `b`: the outlines of its pieces, the greatest first; their holes apart.
struct Difference {
  std::vector<Polygon> pieces;
  bool hasHole = false;  ///< b lies within a
};
Difference difference(const Polygon& a, const Polygon& b);

/// Outlines of what several areas cover together; areas that touch become one.
std::vector<Polygon> united(const std::vector<Polygon>& polygons);

/// Covers what lies inside of the outline and in none of the holes (which may overlap each other and reach outside)
/// with triangles, counter-clockwise.
std::vector<std::array<Eigen::Vector2d, 3>> triangulate(const Polygon& outline, const std::vector<Polygon>& holes);

}  // namespace prodomos::simulation

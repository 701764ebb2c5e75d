// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

/// Where doors cut walls. A door's own frame: x along its normal, y along the wall, origin in the middle of its
/// opening; its side 0 faces rooms[0] (x < 0), side 1 rooms[1].
namespace prodomos::simulation {

/// The door's hole in one edge of a room's outline.
struct Opening {
  std::size_t edge = 0;
  double from = 0.0;  ///< along the edge from its first corner, metres
  double to = 0.0;
  std::array<double, 2> face_in_door{};  ///< x of the wall's face at y = -width/2 and at +width/2
};

/// None where no wall of that room faces the door: it is not parallel within 20°, or 0.3 m away from where the door's
/// wall ends, or too short.
std::optional<Opening> openingIn(const Polygon& outline, const Door& door, int side);

/// The x at both jambs where the door's tunnel ends on a side: the face of the room's wall, or half the wall's
/// thickness where there is none.
std::array<double, 2> faceOf(const Building& building, const Door& door, int side);

/// What a leaf hangs on.
struct Hinge {
  double y_in_door = 0.0;  ///< the leaf's closed position runs from here towards the other side
  double turn = 1.0;       ///< +1: it opens counter-clockwise, seen from above
};
/// One for a single leaf, two for a double door, none for a doorway.
std::vector<Hinge> hingesOf(const Door& door);
double leafWidthOf(const Door& door);

}  // namespace prodomos::simulation

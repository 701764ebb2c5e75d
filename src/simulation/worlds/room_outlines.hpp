// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include "simulation/surface_tools.hpp"

#include <span>
#include <vector>

namespace prodomos::simulation {

/// The rooms between walls, seen from above: walls as a slice shows them, openings in them closed by convex polygons.
/// What is left is filled on a raster; what meets the outside, is smaller than 1.5 m² or nowhere 0.8 m wide (the inside
/// of a hollow wall) is no room. Outlines follow the walls' faces, are simple, counter-clockwise and disjoint; where a
/// room goes round others, a slit of 0.2 mm (isSlit) joins what is inside with the outline. In ascending order of their
/// lower left corners.
std::vector<Polygon> roomOutlines(std::span<const Segment> walls, std::span<const Polygon> closures);

}  // namespace prodomos::simulation

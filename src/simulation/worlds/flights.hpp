// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include "simulation/surface_tools.hpp"

#include <optional>

namespace prodomos::simulation {

/// A flight as its mesh shows it.
struct Flight {
  Staircase stairs;            ///< foot, direction, width, step depth and height, count
  Eigen::AlignedBox2d steps;   ///< where the treads lie, the topmost at its depth
  Eigen::AlignedBox2d extent;  ///< with a landing that belongs to the mesh
};

/// From the level faces of a connected piece, by height: at least three treads, each above and beside the one before.
/// None where the piece is no straight flight.
std::optional<Flight> flightOf(const Surface& piece);

}  // namespace prodomos::simulation

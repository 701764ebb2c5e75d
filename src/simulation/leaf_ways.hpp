// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace prodomos::simulation {

/// A leaf seen from above, from its hinge to its free edge.
using LeafLine = std::array<Eigen::Vector2d, 2>;

/// The door's leaves as they stand at an angle; none for a doorway.
std::vector<LeafLine> leafLines(const Door& door, double angle);

/// So wide at all times that one would not touch it.
bool standsOpen(const Door& door);

/// The least angle that it ever has, radians.
double leastAngle(const Door& door);

/// The point as the door has it: x along its normal, y along the opening.
Eigen::Vector2d inDoor(const Door& door, const Eigen::Vector2d& point);

/// Is the point between the jambs, and between the faces of the wall or up to `depth` beyond?
bool liesInOpening(const Door& door, const Eigen::Vector2d& point, double depth = 0.0);

/// Of these rooms neither is outside.
bool joinsRooms(const Door& door);

}  // namespace prodomos::simulation

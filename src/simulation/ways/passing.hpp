// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include <Eigen/Core>

#include <array>
#include <vector>

/// What doors mean to those who go through them.
namespace prodomos::simulation {

/// A leaf seen from above, from its hinge to its free edge.
using LeafLine = std::array<Eigen::Vector2d, 2>;

/// The door's leaves as they stand at an angle; none for a doorway, and none for a lift's door, which slides.
std::vector<LeafLine> leafLines(const Building& building, const Door& door, double angle);

/// The least angle that it ever has, radians.
double leastAngle(const Door& door);

/// As wide as it is opened for somebody, radians: at a right angle, or less where a wall stands in its way.
double passingAngle(const Building& building, const Door& door);

/// It joins two rooms and can be opened far enough.
bool canBePassed(const Building& building, const Door& door);

/// Between the jambs and the faces of the wall.
bool liesInOpening(const Door& door, const Eigen::Vector2d& point);

}  // namespace prodomos::simulation

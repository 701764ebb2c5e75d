// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

/// What scene files and furniture need of polygons. Metres.
namespace prodomos::simulation {

/// A straight stretch of a wall, seen from a room that lies to its left.
struct WallStretch {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();

  double length() const { return (to - from).norm(); }
  Eigen::Vector2d along() const { return (to - from).normalized(); }
  /// Unit length, into the room.
  Eigen::Vector2d inward() const { return {-along().y(), along().x()}; }
};

std::vector<WallStretch> wallsOf(const Polygon& outline);

/// Counter-clockwise, without corners that are none.
Polygon tidied(Polygon polygon);

/// Each edge of a counter-clockwise polygon moved inwards.
Polygon insetBy(const Polygon& polygon, double distance);

/// Do the insides of two simple polygons share points?
bool overlap(const Polygon& a, const Polygon& b);

/// Stretches of `room`'s edges that lie on edges of `neighbour`, with it to their right.
std::vector<WallStretch> commonWalls(const Polygon& room, const Polygon& neighbour);

double distanceToSegment(const Eigen::Vector2d& point, const Eigen::Vector2d& a, const Eigen::Vector2d& b);

/// A rectangle on the floor, its x-axis along `heading`.
struct Footprint {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double heading = 0.0;
  Eigen::Vector2d size = Eigen::Vector2d::Zero();

  Polygon corners() const;
  /// 0 within.
  double distanceTo(const Eigen::Vector2d& point) const;
};

Footprint placeOf(const Thing& thing);
/// From its foot to its head.
Footprint placeOf(const Staircase& stairs);

/// Share more than an edge.
bool overlap(const Footprint& a, const Footprint& b);
/// Lies within the outline or touches it, and no corner of the outline lies in it.
bool isWithin(const Polygon& outline, const Footprint& footprint);

}  // namespace prodomos::simulation

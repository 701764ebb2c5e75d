// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pose.hpp"

#include <Eigen/Core>

#include <vector>

namespace prodomos::geometry {

/// Corners, metres; not closed, either way round.
using Polygon = std::vector<Eigen::Vector2d>;

/// m²; positive where the corners go round counter-clockwise. 0 for fewer than three.
double signedArea(const Polygon& polygon);
/// By the even-odd rule.
bool contains(const Polygon& polygon, const Eigen::Vector2d& point);

Polygon transformed(const Pose2& T_a_b, const Polygon& polygon_in_b);
/// In the plane of a, as seen from above.
Polygon transformed(const Pose3& T_a_b, const Polygon& polygon_in_b);

}  // namespace prodomos::geometry

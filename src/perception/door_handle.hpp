// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "perception/rectified_wall.hpp"

#include <algorithm>

namespace prodomos::perception {

/// Where a leaf has its handle (002 §II-D): how strongly colours turn there in a corner (the least eigenvalue of the
/// gradients' moments, Shi and Tomasi 1994).
struct Handle {
  // Where handles are: heights above the floor, and distances from the jamb, metres.
  static constexpr double kLowest = 0.7;
  static constexpr double kHighest = 1.25;
  static constexpr double kNearJamb = 0.06;
  static constexpr double kFarFromJamb = 0.25;

  double left = 0.0;  ///< beside the left jamb; 0: not seen
  double right = 0.0;
  double middle = 0.0;  ///< where two leaves meet
  double leaf = 0.0;    ///< usual on the leaf

  double strongest() const { return std::max({left, right, middle}); }
};

/// Of a leaf between x = `left` and x = `right` in the plane that lies `offset` behind the wall's.
Handle findHandle(const RectifiedWall& wall, double left, double right, double offset);

}  // namespace prodomos::perception

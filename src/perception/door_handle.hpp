// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "perception/door_candidates.hpp"

namespace prodomos::perception {

/// Where a leaf has its handle (002 §II-D): how strongly colours turn there in a corner (the least eigenvalue of the
/// gradients' moments, Shi and Tomasi 1994).
struct Handle {
  double left = 0.0;  ///< beside the left jamb; 0: not seen
  double right = 0.0;
  double middle = 0.0;  ///< where two leaves meet
  double leaf = 0.0;    ///< usual between the sides
};

Handle findHandle(const RectifiedWall& wall, const DoorCandidate& candidate);

}  // namespace prodomos::perception

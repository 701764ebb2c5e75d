// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "perception/scan_segments.hpp"

#include <vector>

namespace prodomos::perception::open_doors {

/// A door that stands open, as a level scan shows it, in the sensor's plane.
struct ScannedDoor {
  Eigen::Vector2d hinge = Eigen::Vector2d::Zero();  ///< the jamb that the leaf hangs at, at the wall's face; where that
                                                    ///< is hidden, the leaf's root
  Eigen::Vector2d jamb = Eigen::Vector2d::Zero();   ///< the other one
  double axisBehind = 0.0;                          ///< metres from the wall's face to the leaf's axis
  double angle = 0.0;                               ///< radians from closed
  double sigma = 0.0;                               ///< metres, of a jamb along the wall
  double evidence = 0.0;                            ///< log-odds

  double width() const { return (jamb - hinge).norm(); }
};

/// A straight thing that hangs at a gap's jamb, free at its other end, and would close the gap: as long as that is
/// wide.
std::vector<ScannedDoor> doorsIn(const std::vector<ScanBeam>& beams, double leastWidth);

}  // namespace prodomos::perception::open_doors

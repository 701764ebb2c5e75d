// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/reading.hpp"

#include <Eigen/Core>

#include <vector>

namespace prodomos::perception {

/// One beam of a level laser, in the sensor's plane.
struct ScanBeam {
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();
  double range = 0.0;  ///< metres; infinite: nothing there

  bool isHit() const;
  Eigen::Vector2d end() const { return range * direction; }
};

/// Without those that say nothing.
std::vector<ScanBeam> beamsOf(const sensors::LaserScan& scan);

/// A straight piece of what neighbouring beams [begin, end) hit.
struct ScanSegment {
  std::size_t begin = 0;
  std::size_t end = 0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();  ///< in the sensor, of the line that fits best
  Eigen::Vector2d last = Eigen::Vector2d::Zero();

  double length() const { return (last - first).norm(); }
  Eigen::Vector2d along() const { return (last - first).normalized(); }
  /// Of a point from its line, metres.
  double offset(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d direction = along();
    return direction.x() * (point - first).y() - direction.y() * (point - first).x();
  }
};

/// Runs of beams on one surface (Borges and Aldon 2004, *Line extraction in 2D range images for mobile robotics*, §3.1:
/// adaptive break points), split where they are farthest from their chord, and fitted by least squares.
std::vector<ScanSegment> segmentsOf(const std::vector<ScanBeam>& beams);

}  // namespace prodomos::perception

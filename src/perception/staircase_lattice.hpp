// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <optional>
#include <span>

namespace prodomos::perception {

/// Sizes of steps and slopes of flights that people can climb; wide, for the steps decide.
inline constexpr double kLeastRise = 0.05;   // metres
inline constexpr double kMostRise = 0.25;    // metres
inline constexpr double kLeastDepth = 0.18;  // metres
inline constexpr double kMostDepth = 0.50;   // metres
inline constexpr double kSteepest = 1.0;     // rise over run; nobody walks up where treads are shorter than risers

/// A point in a flight's frame (x uphill, y to the left, z up; metres), and how far its depth may be off.
struct FlightPoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double sigma = 0.0;  ///< metres
};

enum class StepPart { kRiser, kTread };

/// The part of a profile that is nearest to a point.
struct StepPlace {
  StepPart part = StepPart::kTread;
  int step = 0;
  double distance = 0.0;  ///< metres
};

/// The profile of a straight flight of equal steps, endless: tread k begins at the upper edge of riser k.
struct StepLattice {
  double firstRiser = 0.0;  ///< x of riser 0
  double firstTread = 0.0;  ///< z of tread 0
  double depth = 0.0;       ///< of a tread, metres
  double rise = 0.0;        ///< of a riser, metres

  double riserAt(int step) const { return firstRiser + step * depth; }
  double treadAt(int step) const { return firstTread + step * rise; }
  double slope() const { return rise / depth; }
  /// Metres by which a profile deviates from its middle line, both sides together.
  double amplitude() const { return rise * depth / std::hypot(rise, depth); }
  StepPlace placeOf(double x, double z) const;
};

struct FoundLattice {
  StepLattice lattice;
  double turn = 0.0;  ///< radians, counter-clockwise: of the true uphill direction against the frame's x-axis
  /// Mean distance of the points from the profile, against that from a slope without steps: 0 for steps, 1 for a ramp.
  double roughness = 1.0;
};

/// Steps along points near the slope z = slope * x: a search over sizes and phases, then least squares. None where no
/// size of step fits better than the slope itself. `mayTurn`: the x-axis may be a few degrees off the uphill direction.
std::optional<FoundLattice> findLattice(std::span<const FlightPoint> points, double slope, bool mayTurn = true);

}  // namespace prodomos::perception

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/truth.hpp"
#include "prodomos/geometry/overlap.hpp"

#include <vector>

/// Boxes of what the truth describes in other words.
namespace prodomos::evaluation {

/// Half of a leaf's thickness, metres.
inline constexpr double kHalfLeaf = 0.03;

/// Where a leaf turns.
struct Hinge {
  geometry::Pose2 T_door_hinge;  ///< x-axis: along the closed leaf
  double width = 0.0;            ///< of the leaf
};

/// One a leaf; of a door whose hinge side is not told both that it may have; of a doorway none.
std::vector<Hinge> hingesOf(const TrueDoor& door);

/// Leaves that stand open by that angle. The truth does not tell to which side they open: both.
std::vector<geometry::OrientedBox> leavesAt(const TrueDoor& door, double angle);

/// The steps, each down to the lower floor.
std::vector<geometry::OrientedBox> stepsOf(const TrueStaircase& stairs);

}  // namespace prodomos::evaluation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/sightings.hpp"
#include "prodomos/perception/surfaces.hpp"

#include "perception/staircase_lattice.hpp"

#include <optional>
#include <span>
#include <vector>

namespace prodomos::perception {

/// A cell of the depth grid that may show a step.
struct StairCell {
  std::uint32_t cell = 0;
  Eigen::Vector3d point_in_submap = Eigen::Vector3d::Zero();
  double sigma = 0.0;  ///< metres
};

/// The flight that a lattice tells of, `T_submap_flight` its frame, once its steps are found one by one: enough of them
/// in a row, each as wide as a step, at its place, and all of one size.
std::optional<StaircaseSighting> confirmSteps(const RgbdView& view, const Surfaces& surfaces,
                                              std::span<const StairCell> cells, const FoundLattice& found,
                                              const geometry::Pose3& T_submap_flight);

}  // namespace prodomos::perception

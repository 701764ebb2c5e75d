// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"
#include "prodomos/simulation/navigation.hpp"

#include <Eigen/Core>

#include <vector>

namespace prodomos::simulation {

/// One way of a robot from a storey to another.
struct FloorChange {
  int from = 0;
  int to = 0;
  bool byLift = false;
  std::vector<Eigen::Vector3d> way;  ///< from where it stands on one floor to where on the other; of a lift two points
};

/// All there are, up and down; `grids` by storey.
std::vector<FloorChange> floorChanges(const Building& building, const std::vector<FloorGrid>& grids);

}  // namespace prodomos::simulation

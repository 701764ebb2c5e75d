// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace prodomos::simulation {

/// How one storey is climbed.
struct Climb {
  int stepCount = 17;
  double stepHeight = 0.17;
  double stepDepth = 0.29;
};

/// Flights of a stairwell on a floor at z = 0; of two, the second begins on the landing.
struct StairwellPlan {
  std::vector<Staircase> flights;
  std::optional<Landing> landing;
};

/// Places flights into a room: a straight one where it is long enough, else two with a landing half way, as wide as
/// may be, with 0.9 m free before foot and head, and so that one can walk between the given entrances, foot and head,
/// below as well as above, where the flights leave a hole. None where nothing fits.
std::optional<StairwellPlan> planStairwell(const Polygon& outline, const std::vector<Eigen::Vector2d>& entrances,
                                           const Climb& climb);

}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include "simulation/plans/plan_drawing.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace prodomos::simulation {

/// Adds the doors and passages of one storey where portals stand, `roomOfSpace` naming the rooms that the drawing's
/// spaces became. A portal that finds no wall between its rooms is left out, with a remark.
void placeDoors(const PlanDrawing& drawing, const std::vector<std::optional<int>>& roomOfSpace, std::uint64_t seed,
                Building& building);

}  // namespace prodomos::simulation

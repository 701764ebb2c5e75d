// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include <cstdint>
#include <filesystem>

namespace prodomos::simulation {

struct FloorPlanOptions {
  std::uint64_t seed = 0;  ///< of what a plan does not say: thickness of walls, heights, doors' widths and states
  int storeys = 1;         ///< of this plan, one upon the other
};

/// The building of an XML floor plan (docs/floor-plans.md): rooms with the faces of their walls, doors and passages,
/// stairs and lifts; nothing in its rooms. Ids are "r0.12", "d0.7", "s0.1" (storey, number in the plan) and "l2".
/// A fault of one room or portal is a remark, and the thing is left out. Throws base::FileError where there is no
/// building to be had: not such a file, no scale, a self-crossing room, a portal that joins no room, no door at all;
/// and base::UsageError on fewer than one storey.
Building readFloorPlan(const std::filesystem::path& xml, const FloorPlanOptions& options);

}  // namespace prodomos::simulation

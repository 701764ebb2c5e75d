// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include "simulation/plans/plan_drawing.hpp"

#include <optional>
#include <string>
#include <vector>

namespace prodomos::simulation {

/// The faces of the walls of each drawn space, simple and counter-clockwise, nowhere nearer to each other than half the
/// thickness: outlines are moved inwards by half of it, and where two are drawn over each other the greater one gives
/// way. None where no room is left of a space; a remark then says why. Throws base::FileError, naming `file`, on an
/// outline that crosses itself.
std::vector<std::optional<Polygon>> wallFacesOf(const PlanDrawing& drawing, double wallThickness,
                                                const std::string& file, std::vector<std::string>& remarks);

}  // namespace prodomos::simulation

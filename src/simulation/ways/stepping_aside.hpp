// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"
#include "prodomos/simulation/navigation.hpp"

#include "simulation/ways/driver.hpp"

#include <vector>

namespace prodomos::simulation {

/// Where the robot comes close to someone who walks or stands, that one goes a step round it and back to its way, as
/// far as there is floor: people's ways are drawn before the robot's. `grids` by storey.
void stepAside(const std::vector<DrivenPose>& driven, const std::vector<FloorGrid>& grids, Person& person);

}  // namespace prodomos::simulation

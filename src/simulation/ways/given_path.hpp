// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/tour.hpp"

#include "simulation/ways/driver.hpp"
#include "simulation/ways/explorer.hpp"

#include <string>
#include <vector>

namespace prodomos::simulation {

/// The path's first point, facing the next. Throws one base::UsageError with all points that cannot be stood at, ways
/// between them that are not free, and storeys that nothing leads to.
DrivenPose startOf(const Building& building, const Floors& floors, const std::vector<Stop>& path);

/// From point to point, to other storeys by lift or stairs, then stands. Returns remarks.
std::vector<std::string> driveAlong(const std::vector<Stop>& path, const Floors& floors, Driver& driver);

}  // namespace prodomos::simulation

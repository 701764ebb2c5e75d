// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include <cstdint>

namespace prodomos::simulation {

/// How far the door's leaves open before they meet a wall, radians up to 95°.
double widestAngle(const Building& building, const Door& door);

/// On which side each door's leaf hangs and into which room it opens: mostly the smaller one, and away from
/// stairs; where it has space.
void hangLeaves(std::uint64_t seed, Building& building);

/// Which doors stand ajar or open, for the whole of the recording. Most are closed; those across a corridor mostly
/// stand open; those of lifts are shut.
void setDoorStates(std::uint64_t seed, Building& building);

}  // namespace prodomos::simulation

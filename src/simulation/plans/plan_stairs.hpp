// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include <cstddef>
#include <cstdint>

namespace prodomos::simulation {

/// Places flights in the stairwells of a building whose storeys are alike: `roomsOfStorey` rooms each, their floors
/// `storeyHeight` apart. A single storey has flights that lead up to one that is not modelled (upperStorey 1, rooms[1]
/// kOutside). A stairwell that is too small stays empty, with a remark.
void addStairs(std::uint64_t seed, std::size_t roomsOfStorey, double storeyHeight, Building& building);

}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simulation/worlds/storey_mesh.hpp"

#include <vector>

namespace prodomos::simulation {

/// Finds the flights in the storeys' meshes and joins the storeys by them (docs/worlds.md): a flight up has its way cut
/// through ceiling and floor, and a wall that leaves no way off its landing is opened; a flight down is kept on the
/// lowest storey alone, elsewhere the storey below has one up. Above the highest and below the lowest storey, wells of
/// one storey's height end blind. Ids and rooms of the stairs are not set.
std::vector<Staircase> joinByStairs(std::vector<StoreyMesh>& storeys, std::vector<std::string>& remarks);

}  // namespace prodomos::simulation

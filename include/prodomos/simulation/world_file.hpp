// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include <cstdint>
#include <filesystem>

namespace prodomos::simulation {

struct WorldOptions {
  std::uint64_t seed = 0;  ///< of the doors' states, hinges and sides
  int storeys = 0;         ///< the lowest so many; 0: as in the file
};

/// Is it a Gazebo world (XML: <sdf> with <world>), or a folder that holds one?
bool isWorld(const std::filesystem::path& world);

/// The building of a Gazebo world whose walls, floors and ceilings are meshes beside it, MODEL_visual.dae, as those of
/// the AWS RoboMaker hospital (docs/worlds.md). Of a folder, the world with the fewest storeys that has as many as are
/// wanted. Rooms, doors, stairs and lifts are found in the meshes; models whose meshes are not there become stand-ins;
/// doors get leaves, whose states are drawn by seed. What could not be had is in the remarks. Ids are "r0.12", "d0.7",
/// "s0.1" (storey, number), "l0", "t12" and "p3".
/// Throws base::FileError where there is no building to be had: no world, no floor, no walls, a mesh that is missing,
/// damaged, without a unit or of no sensible size; and base::UsageError on fewer than 0 or more storeys than there are.
Building readWorld(const std::filesystem::path& world, const WorldOptions& options = {});

}  // namespace prodomos::simulation

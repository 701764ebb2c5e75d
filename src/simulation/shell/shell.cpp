// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/shell.hpp"

#include "simulation/shell/shell_parts.hpp"

#include <algorithm>

namespace prodomos::simulation {

std::vector<Surface> shellOf(const Building& building, std::uint64_t seed) {
  const HouseLook look(building, seed);
  const auto isImported = [&](const char* name) {
    const auto wanted = classId(name);
    return std::ranges::any_of(building.imported, [&](const Surface& part) { return part.classId == wanted; });
  };
  std::vector<Surface> surfaces;
  if (building.imported.empty()) {
    for (const auto& level : levelsOf(building)) {
      addRoom(building, level, look, surfaces);
      addRailings(building, level, look, surfaces);
    }
    for (std::size_t door = 0; door < building.doors.size(); ++door) addTunnel(building, door, look, surfaces);
  }
  if (!isImported("door_frame")) {
    for (std::size_t door = 0; door < building.doors.size(); ++door) addFrame(building, door, look, surfaces);
  }
  if (!isImported("stairs")) {
    for (std::size_t i = 0; i < building.stairs.size(); ++i) addFlight(building, i, look, surfaces);
    for (std::size_t i = 0; i < building.landings.size(); ++i) addLanding(building, i, look, surfaces);
  }
  std::erase_if(surfaces, [](const Surface& surface) { return surface.triangles.empty(); });
  return surfaces;
}

}  // namespace prodomos::simulation

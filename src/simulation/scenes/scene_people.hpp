// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include "simulation/scenes/yaml_map.hpp"

#include <cstddef>
#include <vector>

namespace prodomos::simulation {

/// When someone goes through a door.
struct Passage {
  std::size_t door = 0;
  double time = 0.0;
};

/// One person of a scene file, and the doors on its way. The rooms and doors must be read already.
Person readPerson(YamlMap& map, const Building& building, int storey, std::vector<Passage>& passages);

}  // namespace prodomos::simulation

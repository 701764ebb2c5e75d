// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"
#include "prodomos/simulation/floor_plan.hpp"
#include "prodomos/simulation/scene_file.hpp"
#include "prodomos/simulation/simulator.hpp"
#include "prodomos/simulation/world_file.hpp"

#include <fstream>

namespace prodomos::simulation {

namespace {

bool isXml(const std::filesystem::path& path) {
  std::ifstream file(path);
  char first = 0;
  return file >> first && first == '<';
}

}  // namespace

Building openScene(const std::filesystem::path& scene, std::uint64_t seed, int storeys) {
  std::error_code unknown;
  if (!std::filesystem::exists(scene, unknown)) {
    throw base::FileError(base::expectedFound(scene.string(), "a floor plan, a world or a scene file", "no such file"));
  }
  if (isWorld(scene)) return readWorld(scene, {.seed = seed, .storeys = storeys});
  if (isXml(scene)) return readFloorPlan(scene, {.seed = seed, .storeys = storeys == 0 ? 1 : storeys});
  if (isSceneFile(scene)) {
    if (storeys != 0) throw base::UsageError("--storeys: a scene file says itself how many storeys there are");
    return readSceneFile(scene, seed);
  }
  throw base::FileError(base::expectedFound(scene.string(),
                                            "a floor plan (XML with <building>), a Gazebo world (<sdf>) or a scene "
                                            "file (YAML with `scene:`)",
                                            "none of these"));
}

}  // namespace prodomos::simulation

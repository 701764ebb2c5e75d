// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pose.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace prodomos::simulation {

/// A model that a world includes.
struct WorldModel {
  std::string name;   ///< of this one; unique in the world
  std::string model;  ///< "Chair": of the uri model://Chair
  geometry::Pose3 T_world_model = geometry::Pose3::Identity();
};

struct GazeboWorld {
  std::vector<WorldModel> models;  ///< in the file's order
  std::vector<std::string> remarks;
};

/// Is its root <sdf>, with a <world> in it?
bool isGazeboWorld(const std::filesystem::path& path);

/// Throws base::FileError where the file is missing, no XML, no world, or a pose in it is not six numbers.
GazeboWorld readGazeboWorld(const std::filesystem::path& path);

}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/surface.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace prodomos::simulation {

/// What one node of a mesh file shows.
struct MeshPart {
  std::string name;               ///< of the node
  Surface surface;                ///< metres, as the node stands in the file; class and material are not set
  std::filesystem::path texture;  ///< beside the mesh; empty: none
};

/// The parts of a COLLADA file (.dae) that shows a part of a building. Lengths are scaled by the file's <unit>. Its
/// <up_axis> is passed over, as Gazebo does: worlds are built with meshes whose z-axis points up, whatever that says.
/// Throws base::FileError where the file is missing, not COLLADA or without <unit>, where nothing is in it, and where
/// it is smaller than 2 m or larger than 500 m.
std::vector<MeshPart> readMesh(const std::filesystem::path& path);

}  // namespace prodomos::simulation

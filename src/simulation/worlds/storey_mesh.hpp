// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include "simulation/surface_tools.hpp"
#include "simulation/worlds/gazebo_world.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace prodomos::simulation {

/// The meshes of one storey, in the frame `world`: of each class as many surfaces as there are parts.
struct StoreyMesh {
  Storey storey;
  std::vector<Surface> surfaces;

  double floor() const { return storey.floor_z; }
  double ceiling() const { return storey.floor_z + storey.ceilingHeight; }
};

/// Which models of a world are its storeys, and what they look like.
struct StoreyMeshes {
  std::vector<StoreyMesh> storeys;  ///< from below; the lowest floor at z = 0
  std::vector<std::size_t> models;  ///< of the world, that these are made of: their indices
  double lowestFloor = 0.0;         ///< in the world's file
};

/// Reads MODEL_visual.dae of all models that have one in the folder. Parts are told by the end of their nodes' names:
/// "walls", "floor", "ceiling", "stairs", "windows", "doorframes", "handrail", "bumprail", "doorsign". Ceilings hang
/// 2 cm below the next floor. Textures and remarks go to the building. Throws base::FileError where a model whose name
/// ends in _floor, _walls or _ceiling has no mesh, and where there is no floor or a storey has no walls.
StoreyMeshes readStoreyMeshes(const GazeboWorld& world, const std::filesystem::path& path, Building& building);

/// A level cut through all that belongs to the class, `height` above the floor.
std::vector<Segment> sliceOf(const StoreyMesh& mesh, std::string_view className, double height);

/// Does a floor lie at the storey's level at this point?
bool hasFloorAt(const StoreyMesh& mesh, const Eigen::Vector2d& point);

/// To be filled with what is added in the style of that class; images are plain colours in it.
Surface emptySurface(const StoreyMesh& mesh, std::string_view className);

/// A rectangle of floor at the storey's level, looking like the rest of it.
void addFloor(StoreyMesh& mesh, const Eigen::AlignedBox2d& plan);

/// Cuts the box out of all surfaces of these classes.
void cutAway(StoreyMesh& mesh, const Eigen::AlignedBox3d& box, std::initializer_list<std::string_view> classNames);

/// The way from a point in a direction of length one to the nearest segment; infinite where there is none.
double distanceTo(const std::vector<Segment>& segments, const Eigen::Vector2d& from, const Eigen::Vector2d& direction);

}  // namespace prodomos::simulation

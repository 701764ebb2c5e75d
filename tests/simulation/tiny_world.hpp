// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/surface.hpp"

#include "simulation/surface_tools.hpp"
#include "support/temporary_folder.hpp"

#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

/// A house small enough to know by heart, as meshes and a Gazebo world.
namespace prodomos::test {

using Parts = std::vector<std::pair<std::string, simulation::Surface>>;

/// COLLADA, positions only.
inline std::string collada(const Parts& parts, const std::string& unit = R"(<unit meter="1" name="meter"/>)") {
  std::ostringstream text;
  text
      << R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)"
      << unit << "<up_axis>Y_UP</up_axis></asset><library_geometries>";
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto& surface = parts[i].second;
    text << "<geometry id=\"g" << i << "\"><mesh><source id=\"p" << i << "\"><float_array id=\"f" << i << "\" count=\""
         << 3 * surface.vertices.size() << "\">";
    for (const auto& v : surface.vertices) text << v.x() << ' ' << v.y() << ' ' << v.z() << ' ';
    text << "</float_array><technique_common><accessor count=\"" << surface.vertices.size() << "\" source=\"#f" << i
         << R"(" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>)"
         << "</accessor></technique_common></source><vertices id=\"v" << i
         << "\"><input semantic=\"POSITION\" source=\"#p" << i << "\"/></vertices><triangles count=\""
         << surface.triangles.size() << "\"><input offset=\"0\" semantic=\"VERTEX\" source=\"#v" << i << "\"/><p>";
    for (const auto& [a, b, c] : surface.triangles) text << a << ' ' << b << ' ' << c << ' ';
    text << "</p></triangles></mesh></geometry>";
  }
  text << "</library_geometries><library_visual_scenes><visual_scene id=\"s\">";
  for (std::size_t i = 0; i < parts.size(); ++i) {
    text << "<node id=\"n" << i << "\" name=\"" << parts[i].first << "\"><instance_geometry url=\"#g" << i
         << "\"/></node>";
  }
  text << "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";
  return text.str();
}

/// A box from corner to corner.
inline simulation::Surface block(const Eigen::Vector3d& least, const Eigen::Vector3d& most) {
  geometry::Pose3 T_world_box = geometry::Pose3::Identity();
  T_world_box.translation() = (least + most) / 2.0;
  return simulation::boxSurface(T_world_box, most - least, {}, 0, 0);
}

inline simulation::Surface joined(const std::vector<simulation::Surface>& surfaces) {
  simulation::Surface all;
  for (const auto& surface : surfaces) simulation::append(all, surface);
  return all;
}

/// Two jambs and a lintel in the plane x = 0, from y = -0.5 to 0.5 and up to 2.1 m: clear 0.93 x 2.065 m.
inline simulation::Surface frame() {
  constexpr double kBoard = 0.035;
  return joined({block({-0.08, -0.5, 0.0}, {0.08, -0.5 + kBoard, 2.1 - kBoard}),
                 block({-0.08, 0.5 - kBoard, 0.0}, {0.08, 0.5, 2.1 - kBoard}),
                 block({-0.08, -0.5, 2.1 - kBoard}, {0.08, 0.5, 2.1})});
}

/// Risers and treads from the origin along x.
inline simulation::Surface flight(int steps, double depth, double height, double width) {
  simulation::Surface surface;
  for (int i = 0; i < steps; ++i) {
    simulation::addRectangle(surface, {i * depth, width / 2.0, i * height}, {0.0, -width, 0.0}, {0.0, 0.0, height});
    simulation::addRectangle(surface, {i * depth, -width / 2.0, (i + 1) * height}, {depth, 0.0, 0.0},
                             {0.0, width, 0.0});
  }
  return surface;
}

inline simulation::Surface moved(const Eigen::Vector3d& by, simulation::Surface surface) {
  geometry::Pose3 T = geometry::Pose3::Identity();
  T.translation() = by;
  return simulation::transformed(T, std::move(surface));
}

/// Two rooms: x 0 … 4 and 4.12 … 10, y 0 … 3, walls 0.12 m thick, a door frame between them; in the second a flight of
/// 15 steps from (5.5, 2.4) along x to the next storey, 3 m above.
inline Parts tinyWalls() {
  constexpr double kT = 0.12;
  constexpr double kTop = 3.0;
  return {
      {"house_walls_visual", joined({block({-kT, -kT, 0}, {0, 3 + kT, kTop}),
                                     block({10, -kT, 0}, {10 + kT, 3 + kT, kTop}), block({0, -kT, 0}, {10, 0, kTop}),
                                     block({0, 3, 0}, {10, 3 + kT, kTop}), block({4, 0, 0}, {4 + kT, 1, kTop}),
                                     block({4, 2, 0}, {4 + kT, 3, kTop}), block({4, 1, 2.1}, {4 + kT, 2, kTop})})},
      {"house_doorframes_visual", moved({4.06, 1.5, 0.0}, frame())},
      {"house_stairs_visual", moved({5.5, 2.4, 0.0}, flight(15, 0.25, 0.2, 1.0))}};
}

inline simulation::Surface level(double z) {
  simulation::Surface surface;
  simulation::addRectangle(surface, {0.0, 0.0, z}, {10.0, 0.0, 0.0}, {0.0, 3.0, 0.0});
  return surface;
}

inline std::string included(const std::string& model, const std::string& pose) {
  return "<model name=\"" + model + "_1\"><include><uri>model://" + model + "</uri><pose>" + pose +
         "</pose></include></model>\n";
}

inline std::string worldText(const std::string& models) {
  return "<?xml version='1.0'?>\n<sdf version=\"1.6\"><world name=\"w\">\n" + models + "</world></sdf>\n";
}

/// The house's models at that height.
inline std::string tinyStorey(double z) {
  const std::string pose = "0 0 " + std::to_string(z) + " 0 0 0";
  return included("house_floor", pose) + included("house_walls", pose) + included("house_ceiling", pose);
}

/// Writes the meshes and a world of these models beside them; returns the world.
inline std::filesystem::path writeTinyWorld(const TemporaryFolder& folder, const std::string& models,
                                            const std::string& name = "tiny.world") {
  folder.write("house_walls_visual.dae", collada(tinyWalls()));
  folder.write("house_floor_visual.dae", collada({{"house_floor_visual", level(0.0)}}));
  folder.write("house_ceiling_visual.dae", collada({{"house_ceiling_visual", level(3.0)}}));
  return folder.write(name, worldText(models));
}

}  // namespace prodomos::test

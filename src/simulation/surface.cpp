// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/surface.hpp"

#include "prodomos/base/error.hpp"

#include <algorithm>
#include <string>

namespace prodomos::simulation {

const sensors::ClassTable& classTable() {
  static const sensors::ClassTable kTable = [] {
    constexpr std::array kNames = {"unlabeled", "wall",      "floor",    "ceiling", "door",   "door_frame", "window",
                                   "stairs",    "ramp",      "handrail", "person",  "table",  "chair",      "sofa",
                                   "bed",       "cupboard",  "shelf",    "counter", "board",  "poster",     "plant",
                                   "box",       "lamp",      "screen",   "sink",    "toilet", "appliance",  "curtain",
                                   "bin",       "lift_door", "skirting", "sign",    "cart"};
    sensors::ClassTable classes;
    for (std::size_t id = 0; id < kNames.size(); ++id) classes[static_cast<int>(id)] = kNames[id];
    return classes;
  }();
  return kTable;
}

std::uint16_t classId(std::string_view name) {
  const auto entry = std::ranges::find_if(classTable(), [&](const auto& row) { return row.second == name; });
  if (entry == classTable().end()) throw base::Error("there is no class \"" + std::string(name) + "\"");
  return static_cast<std::uint16_t>(entry->first);
}

void addRectangle(Surface& surface, const Eigen::Vector3d& corner, const Eigen::Vector3d& along,
                  const Eigen::Vector3d& up) {
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  const std::array<Eigen::Vector3d, 4> corners{corner, corner + along, corner + along + up, corner + up};
  for (const auto& vertex : corners) surface.vertices.push_back(vertex.cast<float>());
  const auto width = static_cast<float>(along.norm());
  const auto height = static_cast<float>(up.norm());
  surface.textureCoordinates.insert(surface.textureCoordinates.end(),
                                    {{0.0F, 0.0F}, {width, 0.0F}, {width, height}, {0.0F, height}});
  surface.triangles.push_back({first, first + 1, first + 2});
  surface.triangles.push_back({first, first + 2, first + 3});
}

Surface boxSurface(const geometry::Pose3& T_world_box, const Eigen::Vector3d& size, const Material& material,
                   std::uint16_t classId, std::uint16_t instance) {
  Surface box{.material = material, .classId = classId, .instance = instance};
  // Each side: its normal's axis, then the two axes that span it counter-clockwise.
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Eigen::Vector3d normal = Eigen::Vector3d::Zero();
      normal[axis] = sign;
      // Texture runs level along sides and its second coordinate upwards.
      const Eigen::Vector3d up = axis == 2 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
      const Eigen::Vector3d along = up.cross(normal);
      const Eigen::Vector3d alongEdge = along.cwiseAbs().dot(size) * along;
      const Eigen::Vector3d upEdge = up.dot(size) * up;
      const Eigen::Vector3d corner = normal.cwiseProduct(size) / 2.0 - alongEdge / 2.0 - upEdge / 2.0;
      addRectangle(box, corner, alongEdge, upEdge);
    }
  }
  return transformed(T_world_box, std::move(box));
}

void append(Surface& surface, const Surface& part) {
  const auto offset = static_cast<std::uint32_t>(surface.vertices.size());
  const auto addAll = [](auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
  addAll(surface.vertices, part.vertices);
  addAll(surface.textureCoordinates, part.textureCoordinates);
  addAll(surface.normals, part.normals);
  for (const auto& triangle : part.triangles) {
    surface.triangles.push_back({triangle[0] + offset, triangle[1] + offset, triangle[2] + offset});
  }
}

Surface transformed(const geometry::Pose3& T_a_b, Surface surface_in_b) {
  const Eigen::Isometry3f T_single = T_a_b.cast<float>();
  for (auto& vertex : surface_in_b.vertices) vertex = T_single * vertex;
  for (auto& normal : surface_in_b.normals) normal = T_single.linear() * normal;
  return surface_in_b;
}

}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/simulation/building.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <vector>

namespace prodomos::test {

/// A closed box of walls, floor and ceiling around the origin, floor at z = 0.
inline std::vector<simulation::Surface> emptyRoom(const Eigen::Vector3d& size, double infrared = 0.8) {
  using namespace simulation;
  std::vector<Surface> room;
  const auto add = [&](std::string_view kind, sensors::Rgb color, Pattern pattern, const Eigen::Vector3d& corner,
                       const Eigen::Vector3d& along, const Eigen::Vector3d& up) {
    Surface side{.material = {.color = color, .pattern = pattern, .infrared = static_cast<float>(infrared)},
                 .classId = classId(kind)};
    addRectangle(side, corner, along, up);
    room.push_back(side);
  };
  const Eigen::Vector3d half = size / 2.0;
  const Eigen::Vector3d x = size.x() * Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = size.y() * Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = size.z() * Eigen::Vector3d::UnitZ();
  constexpr sensors::Rgb kCream{222, 216, 200};
  add("floor", {140, 142, 138}, Pattern::kSpeckle, {-half.x(), -half.y(), 0.0}, x, y);
  add("ceiling", {235, 235, 232}, Pattern::kTiles, {-half.x(), half.y(), size.z()}, x, -y);
  add("wall", kCream, Pattern::kPlain, {half.x(), half.y(), 0.0}, -y, z);
  add("wall", kCream, Pattern::kPlain, {-half.x(), -half.y(), 0.0}, y, z);
  add("wall", kCream, Pattern::kPlain, {-half.x(), half.y(), 0.0}, x, z);
  add("wall", kCream, Pattern::kPlain, {half.x(), -half.y(), 0.0}, -x, z);
  return room;
}

/// A sphere of that many rings, with smooth normals.
inline simulation::Surface sphere(const Eigen::Vector3d& middle, double radius, int rings) {
  simulation::Surface ball;
  const auto columns = static_cast<std::uint32_t>(2 * rings);
  for (int ring = 0; ring <= rings; ++ring) {
    for (std::uint32_t column = 0; column <= columns; ++column) {
      const double latitude = std::numbers::pi * (static_cast<double>(ring) / rings - 0.5);
      const double longitude = 2.0 * std::numbers::pi * column / columns;
      const Eigen::Vector3d normal(std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                                   std::sin(latitude));
      ball.vertices.push_back((middle + radius * normal).cast<float>());
      ball.normals.push_back(normal.cast<float>());
      ball.textureCoordinates.emplace_back(radius * longitude, radius * latitude);
    }
  }
  for (std::uint32_t ring = 0; ring < static_cast<std::uint32_t>(rings); ++ring) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t a = ring * (columns + 1) + column;
      const std::uint32_t b = a + columns + 1;
      ball.triangles.push_back({a, a + 1, b + 1});
      ball.triangles.push_back({a, b + 1, b});
    }
  }
  return ball;
}

/// A hall with rows of shelves, doors, posters, boards and round plants: every pattern, and a hundred thousand
/// triangles or so.
inline simulation::Building furnishedHall(int plants = 100) {
  using namespace simulation;
  Building hall;
  hall.imported = emptyRoom({40.0, 6.0, 2.8});
  std::uint16_t instance = 0;
  const auto addBox = [&](const Eigen::Vector3d& middle, const Eigen::Vector3d& size, const Material& material,
                          std::string_view kind) {
    const geometry::Pose3 T_world_box = geometry::fromYawPitchRoll(middle, 0.0, 0.0, 0.0);
    hall.imported.push_back(boxSurface(T_world_box, size, material, classId(kind), ++instance));
  };
  const Material wood{.color = {168, 122, 78}, .accent = {120, 80, 46}, .pattern = Pattern::kWood, .gloss = 0.2F};
  const Material steel{.color = {150, 152, 156}, .gloss = 0.6F};
  for (int i = 0; i < 10; ++i) {
    const double x = -18.0 + 4.0 * i;
    const auto seed = static_cast<std::uint32_t>(i);
    addBox({x, 2.98, 1.02}, {0.9, 0.04, 2.04}, wood, "door");
    addBox({x + 0.36, 2.94, 1.0}, {0.12, 0.05, 0.02}, steel, "door");
    addBox({x - 0.49, 2.96, 1.04}, {0.08, 0.1, 2.08}, {.color = {90, 92, 96}}, "door_frame");
    addBox({x + 0.49, 2.96, 1.04}, {0.08, 0.1, 2.08}, {.color = {90, 92, 96}}, "door_frame");
    addBox({x, 2.96, 2.08}, {0.9, 0.1, 0.08}, {.color = {90, 92, 96}}, "door_frame");
    addBox({x + 1.4, 2.99, 1.5}, {0.6, 0.01, 0.85},
           {.color = {230, 228, 210}, .accent = {40, 60, 130}, .pattern = Pattern::kPoster, .seed = seed}, "poster");
    addBox({x, -2.98, 1.5}, {1.6, 0.02, 1.0},
           {.color = {170, 130, 90}, .accent = {90, 60, 40}, .pattern = Pattern::kNoticeboard, .seed = seed}, "board");
    addBox({x + 2.0, -2.98, 1.5}, {1.2, 0.02, 1.2},
           {.color = {150, 190, 235}, .accent = {70, 90, 50}, .pattern = Pattern::kSky, .seed = seed, .infrared = 0.0F},
           "window");
    addBox({x + 2.0, -2.8, 0.45}, {1.0, 0.4, 0.9},
           {.color = {200, 190, 180}, .accent = {60, 50, 40}, .pattern = Pattern::kBooks, .scale = 0.3, .seed = seed},
           "shelf");
    addBox({x, 0.8, 0.4}, {1.4, 0.7, 0.04}, wood, "table");
    for (const double dx : {-0.65, 0.65}) addBox({x + dx, 0.8, 0.19}, {0.04, 0.6, 0.38}, steel, "table");
    addBox({x + 0.3, -0.9, 0.22}, {0.5, 0.5, 0.44},
           {.color = {60, 70, 110}, .accent = {30, 35, 60}, .pattern = Pattern::kFabric, .infrared = 0.3F}, "sofa");
    addBox({x, 0.0, 2.78}, {1.2, 0.3, 0.03}, {.color = {250, 250, 245}}, "lamp");
    hall.lighting.lamps.emplace_back(x, 0.0, 2.6);
  }
  base::Random random(3, "plants");
  for (int i = 0; i < plants; ++i) {
    Surface plant =
        sphere({random.uniform(-19.0, 19.0), random.uniform(-2.2, 2.2), random.uniform(0.2, 0.5)}, 0.15, 16);
    plant.material = {.color = {60, 120, 50}, .accent = {30, 70, 30}, .pattern = Pattern::kCarpet, .scale = 2.0};
    plant.classId = classId("plant");
    plant.instance = ++instance;
    hall.imported.push_back(plant);
  }
  return hall;
}

}  // namespace prodomos::test

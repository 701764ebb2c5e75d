// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/rgbd_view.hpp"
#include "prodomos/simulation/person.hpp"
#include "prodomos/simulation/ray_scene.hpp"
#include "prodomos/simulation/renderer.hpp"

#include "support/simulated_rooms.hpp"

#include <Eigen/Geometry>

#include <utility>
#include <vector>

namespace prodomos::test {

/// A picture of one person in an empty room of 8 m by 6 m, without noise.
struct PersonView {
  sensors::RgbdFrame frame;
  geometry::Pose3 T_world_camera = geometry::Pose3::Identity();
  simulation::PersonState truth;

  perception::RgbdView view() const { return {.frame = frame, .T_submap_camera = T_world_camera}; }
};

/// A camera at that place that looks level along x, then turned about its axis.
inline geometry::Pose3 levelCamera(const Eigen::Vector3d& position, double roll = 0.0) {
  geometry::Pose3 T_world_camera = geometry::Pose3(Eigen::Translation3d(position)) * sensors::cameraAxesInBody();
  T_world_camera.rotate(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()));
  return T_world_camera;
}

inline PersonView lookAt(const simulation::Person& person, double time, const geometry::Pose3& T_world_camera,
                         std::vector<simulation::Surface> things = {}) {
  constexpr std::uint16_t kInstance = 7;
  for (auto& side : emptyRoom({8.0, 6.0, 2.7})) things.push_back(std::move(side));
  for (auto& part : simulation::bodyAt(person, 0.0, time, kInstance)) things.push_back(std::move(part));
  const simulation::RayScene scene(std::move(things));
  const simulation::Lighting lighting{.lamps = {{-2.0, -1.2, 2.6}, {-2.0, 1.2, 2.6}, {2.0, 0.0, 2.6}}};
  const simulation::Renderer renderer(scene, {}, lighting);
  const auto rendering = renderer.render(T_world_camera, 1);
  PersonView view{.T_world_camera = T_world_camera, .truth = simulation::stateOf(person, 0.0, time)};
  view.frame.camera = renderer.camera().intrinsics;
  view.frame.depth = rendering.depth;
  view.frame.color = rendering.color;
  view.frame.labels = sensors::LabelImage{rendering.classes, {}, rendering.instances};
  return view;
}

}  // namespace prodomos::test

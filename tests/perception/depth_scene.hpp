// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/rgbd_view.hpp"
#include "prodomos/simulation/camera_model.hpp"
#include "prodomos/simulation/depth_noise.hpp"
#include "prodomos/simulation/ray_scene.hpp"
#include "prodomos/simulation/renderer.hpp"
#include "prodomos/simulation/surface.hpp"

#include "support/simulated_rooms.hpp"

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace prodomos::test {

/// A scene as a depth camera sees it: boxes in a room of 12 x 12 x 2.8 m around the origin, floor at z = 0, or
/// anything.
class DepthScene {
 public:
  explicit DepthScene(const Eigen::Vector3d& room = {12.0, 12.0, 2.8}) : surfaces_(emptyRoom(room)) {}
  explicit DepthScene(std::vector<simulation::Surface> surfaces) : surfaces_(std::move(surfaces)) {}

  void addBox(const geometry::Pose3& T_world_box, const Eigen::Vector3d& size) {
    rays_.reset();
    surfaces_.push_back(simulation::boxSurface(T_world_box, size, {}, simulation::classId("table"), 1));
  }
  /// A box with its lower front edge's middle at `foot`, reaching `size` ahead of it, to both sides and up.
  void addBlock(const geometry::Pose3& foot, const Eigen::Vector3d& size) {
    addBox(foot * geometry::fromYawPitchRoll({0.5 * size.x(), 0.0, 0.5 * size.z()}, 0.0, 0.0, 0.0), size);
  }

  /// What a camera there measures, with the noise of structured light or none.
  sensors::RgbdFrame look(const geometry::Pose3& T_world_camera, bool noisy = true, std::uint64_t seed = 1) const {
    const simulation::CameraModel camera;
    std::vector<simulation::Ray> rays;
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        const Eigen::Vector3d ray =
            T_world_camera.linear() * simulation::directionThrough(camera, Eigen::Vector2d(x, y));
        rays.push_back({T_world_camera.translation().cast<float>(), ray.cast<float>()});
      }
    }
    std::vector<simulation::Hit> hits(rays.size());
    rayScene().cast(rays, hits);
    simulation::Rendering picture{.depth = {camera.width, camera.height},
                                  .cosine = {camera.width, camera.height},
                                  .infrared = {camera.width, camera.height, 0.8F}};
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (!hits[i]) continue;
      picture.depth.data()[i] = hits[i].distance;
      picture.cosine.data()[i] = std::abs(hits[i].normal.dot(rays[i].direction.normalized()));
    }
    sensors::RgbdFrame frame;
    frame.camera = camera.intrinsics;
    base::Random random(seed, "depth scene");
    frame.depth = noisy ? simulation::noisyDepth(picture, camera, {}, random, 1) : picture.depth;
    return frame;
  }

  const simulation::RayScene& rayScene() const {
    if (!rays_) rays_ = std::make_unique<simulation::RayScene>(surfaces_);
    return *rays_;
  }

 private:
  std::vector<simulation::Surface> surfaces_;
  mutable std::unique_ptr<simulation::RayScene> rays_;
};

/// A camera at `position` that looks along `yaw`, `pitch` downwards (radians).
inline geometry::Pose3 cameraAt(const Eigen::Vector3d& position, double yaw, double pitch = 0.0, double roll = 0.0) {
  return geometry::fromYawPitchRoll(position, yaw, pitch, roll) * sensors::cameraAxesInBody();
}

}  // namespace prodomos::test

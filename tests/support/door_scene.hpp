// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/perception/rgbd_view.hpp"
#include "prodomos/sensors/camera.hpp"
#include "prodomos/simulation/ray_scene.hpp"
#include "prodomos/simulation/renderer.hpp"

#include <string_view>
#include <utility>
#include <vector>

/// A wall in the plane y = 0 of the frame `world`, which is seen from y < 0, with doors and what looks like them.
namespace prodomos::test {

/// A door's opening begins at x = `left`; hung on the left or on the right, as seen from y < 0.
struct DrawnDoor {
  double left = -0.45;
  double width = 0.9;
  double recess = 0.05;  ///< of the leaf behind the wall's face, metres
  bool hingeIsLeft = true;
  int leaves = 1;  ///< 0: one sees into the room behind
  sensors::Rgb color{168, 118, 72};
};

class DoorScene {
 public:
  static constexpr double kHeight = 2.03;     ///< of doors
  static constexpr double kHalfLength = 6.0;  ///< of the wall, x
  static constexpr double kSkirting = 0.08;   ///< height
  static constexpr double kFrame = 0.065;     ///< width of its boards
  static constexpr double kThickness = 0.2;   ///< of the wall

  /// Openings from left to right, apart from each other.
  explicit DoorScene(const std::vector<DrawnDoor>& doors) {
    add({-7.0, -8.0, -0.1}, {7.0, 2.5, 0.0}, {150, 152, 150}, "floor");
    add({-7.0, -8.0, 2.7}, {7.0, 2.5, 2.8}, {236, 236, 232}, "ceiling");
    add({-7.0, 2.3, 0.0}, {7.0, 2.5, 2.7}, {206, 217, 205});
    double x = -kHalfLength;
    for (const auto& door : doors) {
      addWall(x, door.left);
      addDoor(door);
      x = door.left + door.width;
    }
    addWall(x, kHalfLength);
  }

  /// A box between two corners.
  void add(const Eigen::Vector3d& low, const Eigen::Vector3d& high, sensors::Rgb color,
           std::string_view kind = "wall") {
    geometry::Pose3 T_world_box = geometry::Pose3::Identity();
    T_world_box.translation() = 0.5 * (low + high);
    surfaces_.push_back(
        simulation::boxSurface(T_world_box, high - low, {.color = color}, simulation::classId(kind), 0));
  }
  /// A sheet with print on it, flat on the wall.
  void addPoster(double left, double right, double bottom, double top) {
    geometry::Pose3 T_world_box = geometry::Pose3::Identity();
    T_world_box.translation() = Eigen::Vector3d(0.5 * (left + right), -0.005, 0.5 * (bottom + top));
    const simulation::Material print{.color = {230, 228, 210},
                                     .accent = {40, 60, 130},
                                     .pattern = simulation::Pattern::kPoster,
                                     .scale = right - left};
    surfaces_.push_back(simulation::boxSurface(T_world_box, {right - left, 0.01, top - bottom}, print,
                                               simulation::classId("poster"), 0));
  }

  /// What a camera at (x, y), `cameraHeight` above the floor, sees that looks along `yaw` (pi / 2: straight at the
  /// wall). With `noise`, depth is as noisy as that of structured light.
  sensors::RgbdFrame see(double x, double y, double yaw, bool noise = true) const {
    const simulation::RayScene scene(surfaces_);
    simulation::Lighting light;
    for (const double lamp : {-4.0, 0.0, 4.0}) light.lamps.emplace_back(lamp, -1.6, 2.6);
    const simulation::Renderer renderer(scene, {}, light);
    auto rendering = renderer.render(cameraPose(x, y, yaw), 1);
    base::Random random(7, "depth of a test");
    for (int v = 0; noise && v < rendering.depth.height(); ++v) {
      for (int u = 0; u < rendering.depth.width(); ++u) {
        float& depth = rendering.depth(u, v);
        if (depth <= 0.0F) continue;
        const auto range = static_cast<double>(depth);
        depth = range > 6.0 ? 0.0F : static_cast<float>(random.normal(range, sensors::depthSigma(range)));
      }
    }
    return {.T_body_camera = geometry::Pose3::Identity(),
            .camera = simulation::CameraModel{}.intrinsics,
            .depth = rendering.depth,
            .color = rendering.color,
            .labels = std::nullopt};
  }

  static constexpr double cameraHeight() { return 1.2; }
  static geometry::Pose3 cameraPose(double x, double y, double yaw) {
    return geometry::fromYawPitchRoll({x, y, cameraHeight()}, yaw, 0.0, 0.0) * sensors::cameraAxesInBody();
  }

 private:
  static constexpr sensors::Rgb kPaint{226, 222, 210};
  static constexpr sensors::Rgb kDark{96, 98, 102};

  void addWall(double from, double to) {
    add({from, 0.0, 0.0}, {to, kThickness, 2.7}, kPaint);
    add({from + kFrame, -0.012, 0.0}, {to - kFrame, 0.0, kSkirting}, {70, 66, 62}, "skirting");
  }

  void addDoor(const DrawnDoor& door) {
    const double right = door.left + door.width;
    add({door.left, 0.0, kHeight}, {right, kThickness, 2.7}, kPaint);
    add({door.left - kFrame, -0.015, 0.0}, {door.left, 0.0, kHeight}, kDark, "door_frame");
    add({right, -0.015, 0.0}, {right + kFrame, 0.0, kHeight}, kDark, "door_frame");
    add({door.left - kFrame, -0.015, kHeight}, {right + kFrame, 0.0, kHeight + kFrame}, kDark, "door_frame");
    if (door.leaves == 0) return;
    add({door.left, door.recess, 0.0}, {right, door.recess + 0.04, kHeight}, door.color, "door");
    const double middle = 0.5 * (door.left + right);
    if (door.leaves == 2) {
      addHandle(middle - 0.065, -1.0, door.recess);
      addHandle(middle + 0.065, 1.0, door.recess);
      add({middle - 0.008, door.recess - 0.003, 0.0}, {middle + 0.008, door.recess, kHeight}, kDark, "door");
    } else if (door.hingeIsLeft) {
      addHandle(right - 0.065, -1.0, door.recess);
    } else {
      addHandle(door.left + 0.065, 1.0, door.recess);
    }
  }

  /// The lever points along x to `side`.
  void addHandle(double x, double side, double recess) {
    constexpr sensors::Rgb kSteel{208, 210, 214};
    add({x - 0.02, recess - 0.008, 0.9}, {x + 0.02, recess, 1.12}, kSteel, "door");
    const double end = x + side * 0.13;
    add({std::min(x, end), recess - 0.05, 1.04}, {std::max(x, end), recess - 0.034, 1.06}, kSteel, "door");
  }

  std::vector<simulation::Surface> surfaces_;
};

}  // namespace prodomos::test

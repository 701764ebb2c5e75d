// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pose.hpp"
#include "prodomos/simulation/building.hpp"
#include "prodomos/simulation/camera_model.hpp"
#include "prodomos/simulation/ray_scene.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace prodomos::simulation {

/// What an ideal camera sees, all images of one size.
struct Rendering {
  sensors::Image<float> depth;              ///< metres along the camera's z, without noise; 0: nothing there
  sensors::Image<sensors::Rgb> color;       ///< without noise
  sensors::Image<std::uint16_t> classes;    ///< of classTable(); 0: nothing there
  sensors::Image<std::uint16_t> instances;  ///< 0: none
  sensors::Image<float> cosine;             ///< of the angle between ray and surface normal
  /// Light of a depth sensor's projector that comes back, falling off with distance left out: 1 from white paper seen
  /// straight on, far more where something glossy mirrors the projector.
  sensors::Image<float> infrared;
};

/// How light becomes a picture.
struct Exposure {
  double target = 0.28;      ///< mean of all pixels, linear, that the camera tries to reach
  double least = 0.4;        ///< gain
  double most = 3.0;         ///< gain
  double vignetting = 0.22;  ///< share of light lost in the corners
};

/// Draws pictures of a scene that outlives it. Light comes from the lamps near by, with shadows, and from all sides,
/// less where something stands close. Neither lens blur nor noise: see depth_noise.hpp and color_noise.hpp.
class Renderer {
 public:
  /// `textures` are those that Material::texture names.
  Renderer(const RayScene& scene, const std::vector<sensors::Image<sensors::Rgb>>& textures, Lighting lighting,
           CameraModel camera = {}, Exposure exposure = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  const CameraModel& camera() const;

  /// Camera axes: x right, y down, z ahead. The picture is the same for any number of threads; 0: as many as the
  /// machine has.
  Rendering render(const geometry::Pose3& T_world_camera, int threads = 0) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/surface.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace prodomos::simulation {

/// Frame `world`, metres. The direction may have any length but zero: distances are counted in it.
struct Ray {
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();
  Eigen::Vector3f direction = Eigen::Vector3f::UnitX();
  float maxDistance = std::numeric_limits<float>::infinity();
};

/// What a ray meets first.
struct Hit {
  float distance = std::numeric_limits<float>::infinity();  ///< in lengths of the ray's direction
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();         ///< unit, on the ray's side; smooth where the surface is
  Eigen::Vector2f textureCoordinates = Eigen::Vector2f::Zero();
  std::uint32_t triangle = 0;
  const Surface* surface = nullptr;  ///< of the scene; null: nothing was met

  explicit operator bool() const { return surface != nullptr; }
};

/// Whether neighbours in a row of rays run close together, as those of an image do, or anyhow. It is a matter of speed
/// alone.
enum class RayOrder { kCoherent, kAny };

/// Surfaces made ready to be met by rays, from both sides and without cracks. Asking is safe from many threads.
class RayScene {
 public:
  /// `moving` are those that move() may change. Throws base::Error where a surface's parts do not fit each other.
  explicit RayScene(std::vector<Surface> fixed, std::vector<Surface> moving = {});
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  /// New vertices and normals of moving surface `index`; its triangles stay. Takes effect with commit(). Throws
  /// base::Error where the numbers of vertices or triangles differ.
  void move(std::size_t index, const Surface& surface);
  void commit();

  const std::vector<Surface>& fixed() const;
  const std::vector<Surface>& moving() const;

  Hit cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
           double maxDistance = std::numeric_limits<double>::infinity()) const;
  bool isOccluded(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double maxDistance) const;

  /// Many at once, the same as one by one. `hits` and `occluded` are as long as `rays`.
  void cast(std::span<const Ray> rays, std::span<Hit> hits, RayOrder order = RayOrder::kCoherent) const;
  void areOccluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded,
                   RayOrder order = RayOrder::kCoherent) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prodomos::simulation

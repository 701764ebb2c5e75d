// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/bytes.hpp"
#include "prodomos/sensors/camera.hpp"

#include <optional>
#include <vector>

namespace prodomos::sensors {

/// A depth image thinned to one value for each block of pixels: the mean of what lies near the block's centre in
/// depth. 0: not known.
class DepthGrid {
 public:
  static constexpr int kBlock = 4;  ///< pixels

  struct Cell {
    float depth;                      ///< metres
    float rayX, rayY;                 ///< of the block's centre
    float normalX, normalY, normalZ;  ///< in the camera, towards it; all 0: not known
  };

  DepthGrid() = default;
  /// Takes `movers` as not known, and so what lies further than `maxDepth` metres. `earlier`: a grid whose rays are
  /// taken over where its camera is the same; may be null.
  DepthGrid(const Camera& camera, const Image<float>& depth, const Mask* movers, double maxDepth,
            const DepthGrid* earlier);

  const Camera& camera() const { return camera_; }
  int width() const { return width_; }
  int height() const { return height_; }
  const Cell& at(int x, int y) const { return cells_[index(x, y)]; }
  std::size_t known() const { return known_; }

  /// The cell that a point in the camera falls into; none outside of the image, behind it, or where depth is not known.
  const Cell* cellAt(const Eigen::Vector3d& point_in_camera) const;

  /// Planes through the inverse depths of each cell's neighbourhood: 1/z is linear in the image on a plane.
  void computeNormals();

  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  void resize(const Camera& camera, const DepthGrid* earlier);

  Camera camera_;
  int width_ = 0;
  int height_ = 0;
  std::size_t known_ = 0;
  std::vector<Cell> cells_;
};

inline Eigen::Vector3d pointOf(const DepthGrid::Cell& cell) {
  const double depth = static_cast<double>(cell.depth);
  return {static_cast<double>(cell.rayX) * depth, static_cast<double>(cell.rayY) * depth, depth};
}
inline Eigen::Vector3d normalOf(const DepthGrid::Cell& cell) {
  return {static_cast<double>(cell.normalX), static_cast<double>(cell.normalY), static_cast<double>(cell.normalZ)};
}

}  // namespace prodomos::sensors

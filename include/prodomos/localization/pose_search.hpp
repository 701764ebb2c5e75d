// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/grid_index.hpp"
#include "prodomos/geometry/pose.hpp"
#include "prodomos/map/surface_layer.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace prodomos::localization {

/// Where a search looks: half widths around a centre.
struct SearchWindow {
  geometry::Pose2 centre;
  double reach = 0.0;  ///< metres, in x and in y
  double turn = 0.0;   ///< radians, pi for all directions
};

/// How near a surface is, seen from every cell, at several resolutions: level k holds the greatest value of 2^k x 2^k
/// cells. What poses are searched on.
class LikelihoodField {
 public:
  static constexpr int kMost = 255;  ///< on the surface

  LikelihoodField(const map::SurfaceLayer& surface, double resolution, int levels);

  double resolution() const { return resolution_; }
  int levels() const { return static_cast<int>(levels_.size()); }
  /// The greatest value in the square of 2^level cells that begins at this cell; 0 outside.
  int at(int level, int x, int y) const {
    const auto& raster = levels_[static_cast<std::size_t>(level)];
    const geometry::CellIndex cell{x, y};
    return raster.box.contains(cell) ? raster.values[static_cast<std::size_t>(y - raster.box.first.y) *
                                                         static_cast<std::size_t>(raster.box.width()) +
                                                     static_cast<std::size_t>(x - raster.box.first.x)]
                                     : 0;
  }

 private:
  struct Raster {
    geometry::CellBox box;
    std::vector<std::uint8_t> values;
  };
  static Raster coarser(const Raster& finer, int width);

  double resolution_;
  std::vector<Raster> levels_;
};

struct FoundPose {
  geometry::Pose2 T_map_body;
  double score = 0.0;  ///< mean likelihood of the points, 0 … 1
};

/// The best pose of the window on the field, to its resolution, by branch and bound: what exhaustive search would find.
/// None where no pose has at least `leastScore`. Poses nearer to `apart` than `margin` (metres, and as many radians)
/// are left out.
std::optional<FoundPose> searchPose(std::span<const Eigen::Vector2d> points_in_body, const LikelihoodField& field,
                                    const SearchWindow& window, double leastScore,
                                    const std::optional<geometry::Pose2>& apart = std::nullopt, double margin = 0.0);

}  // namespace prodomos::localization

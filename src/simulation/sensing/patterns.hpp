// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/surface.hpp"

#include <Eigen/Core>

#include <vector>

namespace prodomos::simulation {

/// Colours as light, linear, 0 … 1.
Eigen::Vector3f linearColor(sensors::Rgb color);
/// Clipped to 0 … 1.
sensors::Rgb encodedColor(const Eigen::Vector3f& linear);

/// A texture and its halves, quarters, …, so that far ones do not flicker.
class MipMap {
 public:
  explicit MipMap(const sensors::Image<sensors::Rgb>& image);

  /// Coordinates 0 … 1 repeat, the second one runs upwards. `footprint`: of a pixel, in them.
  Eigen::Vector3f sample(const Eigen::Vector2f& coordinates, float footprint) const;

 private:
  std::vector<sensors::Image<sensors::Rgb>> levels_;
};

/// Where a pattern is looked at.
struct PatternSample {
  Eigen::Vector2f point;   ///< texture coordinates, metres
  Eigen::Vector2f extent;  ///< the greatest of its surface: how large a poster is
  float footprint = 0.0F;  ///< of a pixel, metres: what is finer is averaged
};

/// The linear colour of any pattern but kImage. `scale` is, in metres: of tiles their edge, of wood the width of a
/// board, of books the height of a shelf, of speckles, carpet and fabric 100 times the size of a grain.
Eigen::Vector3f patternColor(const Material& material, const PatternSample& sample);

}  // namespace prodomos::simulation

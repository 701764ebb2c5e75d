// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"
#include "prodomos/simulation/ray_scene.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace prodomos::simulation {

/// Light that arrives at a point.
struct Light {
  /// Sum over the lamps that are not in shadow: towards the lamp, as long as the lamp is bright there. Its product
  /// with a normal is the light on that surface.
  Eigen::Vector3f lamps = Eigen::Vector3f::Zero();
  float openness = 1.0F;  ///< share of the directions in which nothing stands close
};

/// A point of a surface.
struct LitPoint {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit
};

/// The light in a picture, taken at every fourth pixel and read in between from the samples on the same surface. Lamps
/// are large, so their shadows are soft anyway, and all lamps near by can throw one at a fraction of the rays.
class LightField {
 public:
  /// `seenAt(x, y)` tells what a pixel shows, if anything.
  LightField(const RayScene& scene, const std::vector<Eigen::Vector3d>& lamps, int width, int height,
             const std::function<std::optional<LitPoint>(int, int)>& seenAt, int threads);

  /// At a point that pixel (x, y) or a part of it shows.
  Light at(float x, float y, const LitPoint& place) const;

 private:
  struct Sample {
    LitPoint place;
    bool isEmpty = true;
    Light light;
  };

  std::vector<Eigen::Vector3f> lampsInReach(const std::vector<Eigen::Vector3d>& lamps) const;
  void lightRow(const RayScene& scene, const std::vector<Eigen::Vector3f>& lamps, int row);
  void closeRow(const RayScene& scene, int row);
  void smoothRow(int row, std::vector<Sample>& smoothed) const;
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }
  Sample& sample(int column, int row) { return samples_[index(column, row)]; }
  const Sample& sample(int column, int row) const { return samples_[index(column, row)]; }

  int columns_ = 0;
  int rows_ = 0;
  std::vector<Sample> samples_;
};

}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pose.hpp"
#include "prodomos/map/surface_layer.hpp"

#include <array>
#include <limits>
#include <vector>

namespace prodomos::localization {

/// What the surroundings of a viewpoint look like, whatever way one looks: the spectrum of the distances to the nearest
/// surface, all around.
struct PlaceSignature {
  static constexpr std::size_t kFrequencies = 12;
  std::array<float, kFrequencies> magnitudes{};  ///< metres; the first is the mean distance
};

/// One for each viewpoint of the layer; none where it has no surface.
std::vector<PlaceSignature> placeSignatures(const map::SurfaceLayer& surface);

/// The two viewpoints, one of either layer, that look the most alike.
struct Likeness {
  double difference = std::numeric_limits<double>::infinity();  ///< metres; 0: the same; infinite where there are none
  std::size_t from = 0;
  std::size_t to = 0;
};
Likeness mostAlike(const std::vector<PlaceSignature>& from, const std::vector<PlaceSignature>& to);

/// How the layers lie to each other where the two viewpoints are one, turned so that their surroundings agree best.
geometry::Pose2 alignViewpoints(const map::SurfaceLayer& from, const map::SurfaceLayer& to, const Likeness& likeness);

}  // namespace prodomos::localization

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/surface_layer.hpp"

#include <array>
#include <vector>

namespace prodomos::localization {

/// What the surroundings of a viewpoint look like, whatever way one looks: the spectrum of the distances to the nearest
/// surface, all around.
struct PlaceSignature {
  static constexpr int kFrequencies = 12;
  std::array<float, kFrequencies> magnitudes{};  ///< metres; the first is the mean distance
};

/// One for each viewpoint of the layer.
std::vector<PlaceSignature> placeSignatures(const map::SurfaceLayer& surface);

/// The least distance between any of the one's and any of the other's: 0 for the same place; infinite where either has
/// none.
double dissimilarity(const std::vector<PlaceSignature>& a, const std::vector<PlaceSignature>& b);

}  // namespace prodomos::localization

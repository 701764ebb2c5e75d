// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/surface.hpp"

#include <cstdint>

namespace prodomos::simulation {

enum class Top { kTShirt, kShirt, kSweater, kJacket };
enum class Hair { kShort, kFull, kLong, kPonytail, kShaved };

/// What a person looks like, other than its height.
struct Look {
  bool female = false;
  double girth = 1.0;  ///< width and depth of the trunk and the limbs
  Top top = Top::kTShirt;
  Hair hair = Hair::kShort;

  Material skinMaterial;
  Material hairMaterial;
  Material topMaterial;
  Material innerMaterial;  ///< of collar, placket, what shows in an open jacket
  Material trousersMaterial;
  Material beltMaterial;
  Material shoeMaterial;
  Material soleMaterial;
};

Look lookOf(std::uint64_t seed);

}  // namespace prodomos::simulation

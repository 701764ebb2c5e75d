// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/surface.hpp"

#include "simulation/people/look.hpp"
#include "simulation/people/posture.hpp"

#include <vector>

namespace prodomos::simulation {

/// Surfaces in the posture's frame, without class and instance. Lengths inside are metres of a person of this height.
inline constexpr double kModelHeight = 1.75;
std::vector<Surface> bodyOf(const Posture& posture, const Look& look, double height);

/// Skin, hair and face of the head in its own frame, for a person of kModelHeight; each in a surface of its own.
struct Head {
  Surface skin;
  Surface hair;  ///< and brows
  Surface lips;
  Surface eyes;  ///< the whites
  Surface irises;
};
Head headOf(const Look& look);

}  // namespace prodomos::simulation

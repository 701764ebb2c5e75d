// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/simulation/surface.hpp"

#include <cstdint>
#include <string_view>

namespace prodomos::simulation {

/// Materials of one thing, by seed: those of furniture alike in a group of things, those of posters, books and plants
/// each thing's own.
class FurnitureLook {
 public:
  FurnitureLook(std::uint64_t seed, std::string_view group, std::string_view thing);

  Material wood;     ///< or lacquer
  Material paint;    ///< of metal furniture
  Material metal;    ///< of legs and handles: bright or black
  Material cloth;    ///< some of it dark: depth sensors lose it
  Material cushion;  ///< of the same colour, lighter

  static Material plain(sensors::Rgb color, float gloss = 0.0F, float infrared = 0.8F);
  static Material porcelain();
  static Material chrome();
  static Material darkGlass();
  static Material glass();
  Material patterned(Pattern pattern, sensors::Rgb color, sensors::Rgb accent, double scale);
  Material poster();
  Material leaves();

  /// For choices that the group shares.
  base::Random& shared() { return shared_; }
  base::Random& own() { return own_; }

 private:
  base::Random shared_;
  base::Random own_;
};

}  // namespace prodomos::simulation

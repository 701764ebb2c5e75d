// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/prediction/surroundings.hpp"

#include <cstdint>

namespace prodomos::prediction {

/// What one comes to first through an opening at the origin of `here`: no farther than 5 m ahead and 4 m to either
/// side, through no known wall and no room that is taken.
struct SpaceBehind {
  geometry::CellMap<std::uint8_t> cells;  ///< of Surroundings::kCell
  double unseen = 0.0;                    ///< m²
  double seen = 0.0;                      ///< m² of free floor
};

SpaceBehind spaceBehind(const Surroundings& around, double width);

}  // namespace prodomos::prediction

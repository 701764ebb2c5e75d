// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/image.hpp"

#include "perception/open_door_leaf.hpp"
#include "perception/open_door_profile.hpp"
#include "perception/open_door_swung.hpp"

#include <optional>
#include <vector>

namespace prodomos::perception::open_doors {

/// What is told of a gap, to be drawn.
struct DrawnGap {
  Gap gap;
  std::optional<Leaf> leftLeaf;
  std::optional<Leaf> rightLeaf;
  double leafWidth = 0.0;  ///< metres
  bool accepted = false;
};

/// The wall as seen straight on, by the depth behind it (grey: wall, blue to green: behind it, red: before it), below
/// it its strips, and what is seen from above with the gaps (green: accepted, else orange) and the leaves.
sensors::Image<sensors::Rgb> drawProfile(const WallProfile& profile, const std::vector<Spot>& spots,
                                         const std::vector<DrawnGap>& gaps, const std::vector<SwungLeaf>& swung);

}  // namespace prodomos::perception::open_doors

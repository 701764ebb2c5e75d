// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "perception/open_door_leaf.hpp"
#include "perception/open_door_profile.hpp"

#include <optional>

namespace prodomos::perception::open_doors {

/// A leaf that stands out from a wall towards the observer, seen by itself: what it opens may be hidden.
struct SwungLeaf {
  Hinge hinge;         ///< in the wall's frame
  double angle = 0.0;  ///< radians from closed
  double top = 0.0;    ///< metres above the floor
};

/// `leaf`: the profile of the patch that may be one. None where it does not end as leaves do, or does not meet the
/// wall.
std::optional<SwungLeaf> findSwungLeaf(const WallProfile& wall, const WallProfile& leaf);

}  // namespace prodomos::perception::open_doors

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/id.hpp"
#include "prodomos/base/time.hpp"
#include "prodomos/geometry/pose.hpp"
#include "prodomos/map/records.hpp"

#include <vector>

namespace prodomos::prediction {

/// A piece of a person's way that was watched within one sub-map without a break.
struct Walk {
  struct State {
    base::Time time{};
    geometry::Pose2 T_submap_person;                               ///< the x-axis is where the torso points
    Eigen::Vector2d velocity_in_submap = Eigen::Vector2d::Zero();  ///< m/s
  };

  std::vector<State> states;  ///< ascending in time
  int dominantSide = 0;       ///< -1 left, +1 right, 0 not known
  bool entered = false;       ///< before it, the person was out of sight
  bool left = false;          ///< after it, likewise
};

/// So long without a state, and the person was out of sight.
inline constexpr base::Duration kBreak = std::chrono::seconds(1);

/// Of a person's track, in that sub-map. No walk leads farther than 8 m
/// from its beginning: it is continued by the next. `isOver`: the person was out of sight after the last state.
std::vector<Walk> walksOf(const map::Track& track, base::SubMapId submap, int dominantSide, bool isOver);

/// m/s at the beginning or the end of the walk, over its first or last second; of a single state as told.
Eigen::Vector2d paceAtBeginning(const Walk& walk);
Eigen::Vector2d paceAtEnd(const Walk& walk);

}  // namespace prodomos::prediction

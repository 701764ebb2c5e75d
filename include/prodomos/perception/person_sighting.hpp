// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/time.hpp"

#include <Eigen/Core>

#include <array>
#include <optional>

namespace prodomos::perception {

inline constexpr int kJointCount = 14;  ///< in the order of docs/people.md

/// Colours of the clothes: shares of the torso's pixels, all 0 where not known.
using Appearance = std::array<float, 24>;

/// A person as one reading shows it.
struct PersonSighting {
  base::Time time{};
  Eigen::Vector3d position_in_submap = Eigen::Vector3d::Zero();  ///< below the middle of the body, on the floor, metres
  double positionSigma = 0.0;                                    ///< metres, in the plane
  std::optional<double> heading;                                 ///< of the torso in the sub-map, radians
  double headingSigma = 0.0;                                     ///< radians, front and back not mistaken
  double facing = 0.0;    ///< log-odds of the heading against its opposite; 0: front and back look alike
  double score = 0.0;     ///< 0 … 1
  bool mustMove = false;  ///< may as well be furniture, until it moves
  std::array<std::optional<Eigen::Vector3d>, kJointCount> joints_in_submap{};
  Appearance appearance{};
};

}  // namespace prodomos::perception

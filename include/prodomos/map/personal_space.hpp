// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pose.hpp"
#include "prodomos/geometry/skew_normal.hpp"

#include <cmath>

namespace prodomos::map {

/// f_h of 002 eq. (5): the space that a person keeps to itself, wider on the side that is not the dominant one.
/// `sigma` in metres; `skew` is |α|. The person's x-axis is where the torso points.
inline geometry::SkewNormal personalSpace(const geometry::Pose2& T_here_person, int dominantSide, double sigma,
                                          double skew) {
  const Eigen::Vector2d left(-std::sin(T_here_person.theta), std::cos(T_here_person.theta));
  return {{T_here_person.x, T_here_person.y}, sigma, skew * dominantSide * left};
}

}  // namespace prodomos::map

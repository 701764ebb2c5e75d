// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/evaluation/timed_poses.hpp"

#include <cmath>

namespace prodomos::test {

inline base::Time at(double seconds) {
  return base::Time{} + base::fromSeconds(1000.0 + seconds);
}

/// A robot that winds its way through 3D, a pose every tenth of a second.
inline std::vector<evaluation::TimedPose> windingWay(int count) {
  std::vector<evaluation::TimedPose> way;
  for (int i = 0; i < count; ++i) {
    const double s = 0.1 * i;
    way.push_back({at(s), geometry::fromYawPitchRoll({2.0 * s, std::sin(s), 0.3 * std::cos(2.0 * s)}, 0.7 * s,
                                                     0.2 * std::sin(s), 0.1 * std::cos(s))});
  }
  return way;
}

/// The same way in another frame: T_b_a moves every pose.
inline std::vector<evaluation::TimedPose> moved(std::vector<evaluation::TimedPose> way, const geometry::Pose3& T_b_a) {
  for (auto& pose : way) pose.pose = T_b_a * pose.pose;
  return way;
}

inline geometry::Pose3 somewhereElse() {
  return geometry::fromYawPitchRoll({-31.0, 4.5, 7.0}, 2.5, -0.4, 1.1);
}

/// A little off, by so many metres and radians a component.
inline geometry::Pose3 smallMove(base::Random& random, double metres, double radians) {
  const auto draw = [&](double scale) { return random.uniform(-scale, scale); };
  const Eigen::Vector3d shift(draw(metres), draw(metres), draw(metres));
  return geometry::fromYawPitchRoll(shift, draw(radians), draw(radians), draw(radians));
}

}  // namespace prodomos::test

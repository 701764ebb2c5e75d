// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/geometry/pose.hpp"

namespace prodomos::simulation {

/// How wheel odometry errs: by a share of its own for each robot, and by noise that grows with the way.
struct WheelModel {
  double scaleSigma = 0.01;             ///< of distances, one factor a log
  double turnScaleSigma = 0.01;         ///< of turns, one factor a log
  double driftSigma = 0.003;            ///< heading gained on straight ways, radians a metre, one value a log
  double distanceNoise = 0.01;          ///< standard deviation after a metre, metres; grows with its square root
  double headingNoisePerMeter = 0.01;   ///< radians after a metre
  double headingNoisePerRadian = 0.02;  ///< radians after a radian
};

/// What wheels believe of a way. They feel no height: on stairs they are carried, in a lift they stand.
class Wheels {
 public:
  Wheels(const WheelModel& model, std::uint64_t seed);

  /// The pose in the odometry's frame, which begins at the first call's body, after moving on to that true pose.
  geometry::Pose2 moveTo(const geometry::Pose3& T_world_body);

 private:
  WheelModel model_;
  base::Random random_;
  double scale_;
  double turnScale_;
  double drift_;
  bool hasMoved_ = false;
  geometry::Pose2 T_world_body_;
  geometry::Pose2 T_odom_body_;
};

}  // namespace prodomos::simulation

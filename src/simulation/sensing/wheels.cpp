// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/wheels.hpp"

#include <cmath>

namespace prodomos::simulation {

Wheels::Wheels(const WheelModel& model, std::uint64_t seed)
    : model_(model),
      random_(seed, "wheels"),
      scale_(random_.normal(1.0, model.scaleSigma)),
      turnScale_(random_.normal(1.0, model.turnScaleSigma)),
      drift_(random_.normal(0.0, model.driftSigma)) {}

geometry::Pose2 Wheels::moveTo(const geometry::Pose3& T_world_body) {
  const auto now = geometry::toPose2(T_world_body);
  if (hasMoved_ && now != T_world_body_) {
    const auto step = inverse(T_world_body_) * now;
    const double distance = std::hypot(step.x, step.y);
    const double along = random_.normal(scale_, distance > 0.0 ? model_.distanceNoise / std::sqrt(distance) : 0.0);
    const double turn = geometry::normalizeAngle(step.theta) * turnScale_ + drift_ * distance +
                        random_.normal(0.0, model_.headingNoisePerMeter * std::sqrt(distance)) +
                        random_.normal(0.0, model_.headingNoisePerRadian * std::sqrt(std::abs(step.theta)));
    T_odom_body_ = T_odom_body_ * geometry::Pose2{along * step.x, along * step.y, turn};
  }
  hasMoved_ = true;
  T_world_body_ = now;
  return T_odom_body_;
}

}  // namespace prodomos::simulation

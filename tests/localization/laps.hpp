// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "localization/random_graph.hpp"

#include <numbers>

namespace prodomos::test {

/// A robot drives rounds of a corridor and closes loops with the rounds before; some loops lead elsewhere.
struct Laps {
  int laps = 4;
  int posesPerLap = 50;
  double trueLoops = 0.5;   ///< per pose from the second round on
  double falseLoops = 0.0;  ///< share of all loops
  bool isHonest = true;     ///< odometry drifts as its information says; else by 1 % of scale and half a degree a metre
  std::uint32_t seed = 1;
};

struct LapGraph {
  localization::PoseGraph graph;  ///< as odometry has it
  std::vector<geometry::Pose3> truth;
  std::vector<bool> isFalse;  ///< of each constraint
};

inline LapGraph driveLaps(const Laps& laps) {
  using geometry::Pose3;
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  const Vector6 stepSigma = (Vector6() << 0.02, 0.02, 0.005, 0.002, 0.002, 0.01).finished();
  const Vector6 loopSigma = (Vector6() << 0.03, 0.03, 0.03, 0.01, 0.01, 0.01).finished();
  Dice dice(laps.seed);
  LapGraph drive;
  const int poses = laps.laps * laps.posesPerLap;
  for (int i = 0; i < poses; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / laps.posesPerLap;
    drive.truth.push_back(geometry::fromYawPitchRoll({8.0 * std::cos(angle), 5.0 * std::sin(angle), 0.0},
                                                     angle + std::numbers::pi / 2.0, 0.0, 0.0));
  }
  const auto truth = [&](int i) { return drive.truth[static_cast<std::size_t>(i)]; };
  const auto measure = [&](int from, int to, const Pose3& T_from_to, const Vector6& sigma, bool isLoop, bool isFalse) {
    const Vector6 deviation = sigma.cwiseProduct(normalVector<Pose3>(dice));
    drive.graph.constraints.push_back({.from = from,
                                       .to = to,
                                       .T_from_to = T_from_to * motion<Pose3>(deviation),
                                       .information = sigma.cwiseAbs2().cwiseInverse().asDiagonal(),
                                       .isDoubtful = isLoop});
    drive.isFalse.push_back(isFalse);
  };
  for (int i = 0; i < poses; ++i) {
    drive.graph.vertices.push_back({.id = i, .pose = truth(0)});
    if (i == 0) continue;
    Pose3 step = truth(i - 1).inverse() * truth(i);
    if (!laps.isHonest) {
      const double length = step.translation().norm();
      step.translation() *= 1.01;
      step = step * geometry::fromYawPitchRoll({0, 0, 0}, length * 0.5 * std::numbers::pi / 180.0, 0.0, 0.0);
    }
    measure(i - 1, i, step, stepSigma, false, false);
  }
  for (int i = laps.posesPerLap; i < poses; ++i) {
    if (dice.uniform() >= laps.trueLoops) continue;
    // To about the same place of an earlier round; a false one to any earlier pose, as if it were this place.
    const int earlier = i % laps.posesPerLap +
                        laps.posesPerLap * static_cast<int>(dice.below(static_cast<std::size_t>(i / laps.posesPerLap)));
    measure(earlier, i, truth(earlier).inverse() * truth(i), loopSigma, true, false);
    while (laps.falseLoops > 0.0 && dice.uniform() < laps.falseLoops) {
      const int other = static_cast<int>(dice.below(static_cast<std::size_t>(i - 10)));
      const Vector6 nearby = (Vector6() << 0.5, 0.5, 0.0, 0.0, 0.0, 0.3).finished();
      measure(other, i, motion<Pose3>(nearby.cwiseProduct(normalVector<Pose3>(dice))), loopSigma, true, true);
    }
  }
  placeBySpanningTree(drive.graph);
  return drive;
}

/// Root of the mean squared distance from the truth, metres; the first pose is that of the truth.
inline double rmse(const LapGraph& drive) {
  double sum = 0.0;
  for (std::size_t i = 0; i < drive.truth.size(); ++i) {
    sum += (drive.graph.vertices[i].pose.translation() - drive.truth[i].translation()).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(drive.truth.size()));
}

/// The same drive without its false loops.
inline LapGraph withoutFalseLoops(LapGraph drive) {
  auto& constraints = drive.graph.constraints;
  std::vector<localization::PoseConstraint> good;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    if (!drive.isFalse[i]) good.push_back(constraints[i]);
  }
  constraints = good;
  drive.isFalse.assign(good.size(), false);
  return drive;
}

}  // namespace prodomos::test

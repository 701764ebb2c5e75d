// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "localization/chi_square.hpp"
#include "localization/descent.hpp"
#include "localization/pose_problem.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <vector>

namespace prodomos::localization {

template <typename Pose>
std::vector<std::size_t> doubtfulOf(const Graph<Pose>& graph) {
  std::vector<std::size_t> doubtful;
  for (std::size_t i = 0; i < graph.constraints.size(); ++i) {
    if (graph.constraints[i].isDoubtful) doubtful.push_back(i);
  }
  return doubtful;
}

/// Decides which doubtful constraints to keep: those that make the sum of chi² and of `bound` for each that is left out
/// least (truncated least squares). First all at once by graduated non-convexity (Yang et al., RA-L 2020): with weights
/// that fall with the error, gently, then ever more sharply. A constraint may have a small error there just because it
/// bends all the others, so that afterwards each is tested by what chi² would gain without it, or lose with it.
template <typename Pose>
class Doubts {
 public:
  Doubts(PoseProblem<Pose>& problem, Descent<Pose>& descent, const std::vector<std::size_t>& doubtful,
         const OptimizerConfig& config)
      : problem_(problem),
        descent_(descent),
        doubtful_(doubtful),
        bound_(chiSquareBound(kDegreesOfFreedom<Pose>, config.rejectedTrueLoops)),
        isIncremental_(config.isIncremental) {}

  /// Weights of 1 or of next to nothing.
  void settle(std::vector<double>& weights) {
    isIncremental_ ? keepWhatFits(weights) : graduate(weights);
    std::vector<bool> wasReadmitted(weights.size(), false);
    for (std::size_t round = 0; round < doubtful_.size() + kSpareRounds; ++round) {
      descent_.run(weights, kStepsBetween);
      if (!exchange(weights, wasReadmitted)) return;
    }
  }

 private:
  /// Not zero: poses that rejected constraints alone hold must not float.
  static constexpr double kTether = 1e-9;
  static constexpr double kSharpening = 1.4;
  static constexpr int kStepsBetween = 2;
  static constexpr std::size_t kSpareRounds = 5;

  void keepWhatFits(std::vector<double>& weights) const {
    const auto errors = problem_.errors(problem_.states());
    for (const auto i : doubtful_) weights[i] = errors[i] <= bound_ ? 1.0 : kTether;
  }

  void graduate(std::vector<double>& weights) {
    auto errors = problem_.errors(problem_.states());
    double greatest = 0.0;
    for (const auto i : doubtful_) greatest = std::max(greatest, errors[i]);
    if (greatest <= bound_) return;
    bool isSharp = false;
    for (double mu = bound_ / (2.0 * greatest - bound_); !isSharp; mu *= kSharpening) {
      isSharp = true;
      for (const auto i : doubtful_) {
        weights[i] = weightOf(errors[i], mu);
        if (weights[i] > kTether && weights[i] < 1.0) isSharp = false;
      }
      descent_.run(weights, 1);
      errors = problem_.errors(problem_.states());
    }
  }

  double weightOf(double error, double mu) const {
    if (error >= (mu + 1.0) / mu * bound_) return kTether;
    if (error <= mu / (mu + 1.0) * bound_) return 1.0;
    return std::max(kTether, std::sqrt(bound_ * mu * (mu + 1.0) / error) - mu);
  }

  /// Rejects the worst that is kept, readmits those that fit. False where all stays.
  bool exchange(std::vector<double>& weights, std::vector<bool>& wasReadmitted) {
    if (!descent_.factorize(weights)) return false;
    const auto inverse = descent_.cholesky().inverseBlocks();
    std::size_t worst = weights.size();
    double worstCost = bound_;
    bool isChanged = false;
    for (const auto i : doubtful_) {
      const bool isKept = weights[i] == 1.0;
      const double cost = problem_.costOf(i, inverse, isKept);
      if (isKept && cost > worstCost) {
        worst = i;
        worstCost = cost;
      } else if (!isKept && cost <= bound_ && !wasReadmitted[i]) {
        weights[i] = 1.0;
        wasReadmitted[i] = isChanged = true;
      }
    }
    if (worst == weights.size()) return isChanged;
    weights[worst] = kTether;
    return true;
  }

  PoseProblem<Pose>& problem_;
  Descent<Pose>& descent_;
  const std::vector<std::size_t>& doubtful_;
  double bound_;
  bool isIncremental_;
};

}  // namespace prodomos::localization

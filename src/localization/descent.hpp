// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "localization/block_cholesky.hpp"
#include "localization/pose_problem.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <utility>

namespace prodomos::localization {

/// Gauss and Newton's steps, with Levenberg and Marquardt's damping only where one does not lead down. Near the end the
/// equations hardly change from step to step: their factors, which take most of the time, are kept.
template <typename Pose>
class Descent {
 public:
  Descent(PoseProblem<Pose>& problem, std::shared_ptr<const Elimination> elimination, const OptimizerConfig& config)
      : problem_(problem), config_(config), cholesky_(std::move(elimination)) {}

  /// Moves the problem's states for so many steps, or until chi² hardly falls any more: true.
  bool run(std::span<const double> weights, int steps) {
    if (problem_.unknowns() == 0) return true;
    double chi2 = problem_.linearize(weights);
    double gain = std::numeric_limits<double>::infinity();  // that the last step was to bring
    bool isFactorized = false;
    while (steps-- > 0) {
      ++iterations_;
      if (!isFactorized && !cholesky_.factorize(problem_.matrix(), damping_)) {
        if (!damp()) return true;
        continue;
      }
      Eigen::VectorXd motion = -problem_.gradient();
      cholesky_.solve(motion);
      const double lastGain = std::exchange(gain, -problem_.gradient().dot(motion));
      const bool isLast = gain <= config_.tolerance * chi2;
      auto states = problem_.moved(motion);
      const bool leadsDown = problem_.chi2(states, weights) < chi2;
      if (leadsDown) {
        damping_ = damping_ > kLeastDamping ? 0.1 * damping_ : 0.0;
        problem_.setStates(std::move(states));
      }
      if (isLast) return true;
      if (leadsDown) {
        const bool isSlow = isFactorized && gain > kSlow * lastGain;
        isFactorized = damping_ == 0.0 && gain < kNear * chi2 && !isSlow;
        chi2 = problem_.linearize(weights);
      } else {
        // With factors of an earlier step it is these that are wrong, not the step's length.
        if (!isFactorized && !damp()) return true;
        isFactorized = false;
      }
    }
    return false;
  }

  int iterations() const { return iterations_; }
  /// Of the last step's equations.
  const BlockCholesky<kDegreesOfFreedom<Pose>>& cholesky() const { return cholesky_; }
  /// Of the equations where the states are now. False where they leave something free.
  bool factorize(std::span<const double> weights) {
    problem_.linearize(weights);
    return cholesky_.factorize(problem_.matrix());
  }

 private:
  static constexpr double kLeastDamping = 1e-6;
  static constexpr double kMostDamping = 1e12;
  static constexpr double kNear = 0.1;  ///< factors are kept after a step that took no more than this share off chi²
  static constexpr double kSlow = 0.2;  ///< and as long as each step brings no more than this share of the one before

  /// False where no step is short enough.
  bool damp() {
    damping_ = std::max(kLeastDamping, 10.0 * damping_);
    if (damping_ <= kMostDamping) return true;
    damping_ = 0.0;
    return false;
  }

  PoseProblem<Pose>& problem_;
  const OptimizerConfig& config_;
  BlockCholesky<kDegreesOfFreedom<Pose>> cholesky_;
  double damping_ = 0.0;
  int iterations_ = 0;
};

}  // namespace prodomos::localization

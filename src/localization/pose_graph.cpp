// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/pose_graph.hpp"

#include "localization/pose_problem.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace prodomos::localization {

namespace {

/// Gauss and Newton's steps, with Levenberg and Marquardt's damping only where one does not lead down.
template <typename Pose>
class Descent {
 public:
  Descent(PoseProblem<Pose>& problem, const OptimizerConfig& config)
      : problem_(problem), config_(config), cholesky_(problem.unknowns(), problem.places()) {}

  int iterations() const { return iterations_; }

  /// Until chi² does not fall any more, or for so many steps; the first is false where it ran out of them.
  bool run(std::span<const double> weights, int steps) {
    if (problem_.unknowns() == 0) return true;
    double chi2 = problem_.linearize(weights);
    for (; steps > 0; --steps, ++iterations_) {
      if (!cholesky_.factorize(problem_.matrix(), damping_)) {
        damping_ = std::max(kLeastDamping, 10.0 * damping_);
        continue;
      }
      Eigen::VectorXd motion = -problem_.gradient();
      cholesky_.solve(motion);
      const double expected = -problem_.gradient().dot(motion);
      auto states = problem_.moved(motion);
      const double reached = problem_.chi2(states, weights);
      const bool isSmall = expected <= config_.tolerance * chi2;
      if (reached < chi2) {
        problem_.setStates(std::move(states));
        damping_ = damping_ > kLeastDamping ? 0.1 * damping_ : 0.0;
      } else {
        damping_ = std::max(kLeastDamping, 10.0 * damping_);
      }
      if (isSmall || damping_ > kMostDamping) {
        ++iterations_;
        return true;
      }
      if (reached < chi2) chi2 = problem_.linearize(weights);
    }
    return false;
  }

 private:
  static constexpr double kLeastDamping = 1e-6;
  static constexpr double kMostDamping = 1e12;

  PoseProblem<Pose>& problem_;
  const OptimizerConfig& config_;
  BlockCholesky<kDegreesOfFreedom<Pose>> cholesky_;
  double damping_ = 0.0;
  int iterations_ = 0;
};

}  // namespace

template <typename Pose>
OptimizationReport optimize(Graph<Pose>& graph, const OptimizerConfig& config) {
  const auto begin = std::chrono::steady_clock::now();
  PoseProblem<Pose> problem(graph);
  OptimizationReport report;
  report.weights.assign(graph.constraints.size(), 1.0);
  report.chi2Before = problem.chi2(problem.states(), report.weights);
  Descent<Pose> descent(problem, config);
  report.converged = descent.run(report.weights, config.maxIterations);
  report.iterations = descent.iterations();
  report.chi2After = problem.chi2(problem.states(), report.weights);
  problem.writePoses(graph);
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return report;
}

template <typename Pose>
double chi2(const Graph<Pose>& graph) {
  const PoseProblem<Pose> problem(graph);
  return problem.chi2(problem.states(), std::vector<double>(graph.constraints.size(), 1.0));
}

template OptimizationReport optimize(PlanarPoseGraph& graph, const OptimizerConfig& config);
template OptimizationReport optimize(PoseGraph& graph, const OptimizerConfig& config);
template double chi2(const PlanarPoseGraph& graph);
template double chi2(const PoseGraph& graph);

}  // namespace prodomos::localization

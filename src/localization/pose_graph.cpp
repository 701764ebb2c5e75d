// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/pose_graph.hpp"

#include "localization/descent.hpp"
#include "localization/doubts.hpp"
#include "localization/pose_problem.hpp"
#include "localization/rotation_start.hpp"

#include <algorithm>
#include <chrono>

namespace prodomos::localization {

namespace {
/// Times the chi² that noise alone makes: steps from such a start lead astray before they lead home.
constexpr double kFarOff = 10.0;
}  // namespace

template <typename Pose>
OptimizationReport optimize(Graph<Pose>& graph, const OptimizerConfig& config) {
  const auto begin = std::chrono::steady_clock::now();
  PoseProblem<Pose> problem(graph);
  const auto elimination = problem.findElimination();
  Descent<Pose> descent(problem, elimination, config);
  std::vector<double> weights(graph.constraints.size(), 1.0);
  OptimizationReport report{.chi2Before = problem.chi2(problem.states(), weights)};

  const auto doubtful = doubtfulOf(graph);
  const auto degrees = static_cast<double>(graph.constraints.size() * kDegreesOfFreedom<Pose>);
  if (doubtful.empty() && report.chi2Before > kFarOff * degrees) {
    auto states = statesByRotations(problem, elimination);
    if (problem.chi2(states, weights) < report.chi2Before) problem.setStates(std::move(states));
  }
  if (!doubtful.empty()) Doubts<Pose>(problem, descent, doubtful, config).settle(weights);
  report.converged = descent.run(weights, config.maxIterations);

  for (const auto i : doubtful) weights[i] = weights[i] < 0.5 ? 0.0 : 1.0;
  report.iterations = descent.iterations();
  report.chi2After = problem.chi2(problem.states(), weights);
  report.weights = std::move(weights);
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

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"
#include "prodomos/localization/pose_graph.hpp"

#include "localization/pose_problem.hpp"

#include <algorithm>
#include <array>

namespace prodomos::localization {

template <typename Pose>
struct Covariances<Pose>::Impl {
  static constexpr int kDimension = kDegreesOfFreedom<Pose>;

  explicit Impl(const Graph<Pose>& graph) : problem(graph), cholesky(problem.findElimination()) {
    problem.linearize(std::vector<double>(graph.constraints.size(), 1.0));
    if (!cholesky.factorize(problem.matrix())) {
      throw base::Error(base::expectedFound("covariance of a pose graph",
                                            "constraints that hold each pose in all directions",
                                            "some that leave it free"));
    }
  }

  PoseProblem<Pose> problem;
  BlockCholesky<kDimension> cholesky;
  std::vector<MotionMatrix<Pose>> marginals;
};

template <typename Pose>
Covariances<Pose>::Covariances(const Graph<Pose>& graph) : impl_(std::make_unique<Impl>(graph)) {}
template <typename Pose>
Covariances<Pose>::~Covariances() = default;
template <typename Pose>
Covariances<Pose>::Covariances(Covariances&&) noexcept = default;
template <typename Pose>
Covariances<Pose>& Covariances<Pose>::operator=(Covariances&&) noexcept = default;

template <typename Pose>
MotionMatrix<Pose> Covariances<Pose>::of(std::int64_t id) {
  const int unknown = impl_->problem.unknownOf(impl_->problem.index().at(id));
  if (unknown < 0) return MotionMatrix<Pose>::Zero();
  if (impl_->marginals.empty()) impl_->marginals = impl_->cholesky.inverseBlocks().diagonal;
  return impl_->marginals[static_cast<std::size_t>(unknown)];
}

template <typename Pose>
MotionMatrix<Pose> Covariances<Pose>::relative(std::int64_t from, std::int64_t to) const {
  constexpr int kD = Impl::kDimension;
  auto& problem = impl_->problem;
  const std::array vertices = {problem.index().at(from), problem.index().at(to)};
  const auto& states = problem.states();
  // How the pose of `to` in `from` deviates as either moves: the error of a measurement that is met exactly.
  LinearizedError<kD> linear;
  const auto measured = PoseSpace<Pose>::between(states[vertices[0]], states[vertices[1]]);
  PoseSpace<Pose>::linearize(states[vertices[0]], states[vertices[1]], measured, linear);
  const std::array motions = {linear.byFrom, linear.byTo};

  // J H^-1 J^T, a column of H^-1 J^T at a time.
  MotionMatrix<Pose> covariance = MotionMatrix<Pose>::Zero();
  Eigen::VectorXd column(static_cast<Eigen::Index>(problem.unknowns()) * kD);
  for (int axis = 0; axis < kD; ++axis) {
    column.setZero();
    for (std::size_t end = 0; end < 2; ++end) {
      const int unknown = problem.unknownOf(vertices[end]);
      if (unknown >= 0) column.template segment<kD>(unknown * kD) += motions[end].row(axis).transpose();
    }
    impl_->cholesky.solve(column);
    for (std::size_t end = 0; end < 2; ++end) {
      const int unknown = problem.unknownOf(vertices[end]);
      if (unknown >= 0) covariance.col(axis) += motions[end] * column.template segment<kD>(unknown * kD);
    }
  }
  return 0.5 * (covariance + covariance.transpose());
}

template class Covariances<geometry::Pose2>;
template class Covariances<geometry::Pose3>;

std::vector<MotionMatrix<geometry::Pose3>> covariances(const PoseGraph& graph, std::span<const std::int64_t> ids) {
  Covariances all(graph);
  std::vector<MotionMatrix<geometry::Pose3>> result(ids.size());
  std::ranges::transform(ids, result.begin(), [&](std::int64_t id) { return all.of(id); });
  return result;
}

MotionMatrix<geometry::Pose3> relativeCovariance(const PoseGraph& graph, std::int64_t from, std::int64_t to) {
  return Covariances(graph).relative(from, to);
}

}  // namespace prodomos::localization

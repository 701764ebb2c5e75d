// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "localization/pose_problem.hpp"

#include "prodomos/base/error.hpp"

#include "localization/graph_index.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <string>

namespace prodomos::localization {

namespace {

using geometry::isFinite;

bool isFinite(const geometry::Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.theta);
}

template <typename Pose>
std::string nameOf(const Constraint<Pose>& constraint) {
  return "constraint from vertex " + std::to_string(constraint.from) + " to " + std::to_string(constraint.to);
}

template <typename Matrix>
bool isInformation(const Matrix& matrix) {
  if (!matrix.allFinite() || !matrix.isApprox(matrix.transpose(), 1e-9)) return false;
  if (Eigen::LLT<Matrix>(matrix).info() == Eigen::Success) return true;
  // Nothing may be known in some directions.
  const Eigen::LDLT<Matrix> factors(matrix);
  return factors.info() == Eigen::Success && factors.vectorD().minCoeff() >= -1e-9 * matrix.diagonal().maxCoeff();
}

template <typename Pose>
void check(const Graph<Pose>& graph) {
  for (const auto& vertex : graph.vertices) {
    if (isFinite(vertex.pose)) continue;
    throw base::Error(base::expectedFound("vertex " + std::to_string(vertex.id), "finite numbers", "NaN or infinity"));
  }
  for (const auto& constraint : graph.constraints) {
    if (constraint.from == constraint.to) {
      throw base::Error(base::expectedFound(nameOf(constraint), "two vertices", "one"));
    }
    if (!isFinite(constraint.T_from_to)) {
      throw base::Error(base::expectedFound(nameOf(constraint), "a finite measurement", "NaN or infinity"));
    }
    if (!isInformation(constraint.information)) {
      throw base::Error(
          base::expectedFound(nameOf(constraint), "a symmetric, positive semi-definite information matrix", "another"));
    }
  }
}

}  // namespace

template <typename Pose>
PoseProblem<Pose>::PoseProblem(const Graph<Pose>& graph) : index_(graph) {
  check(graph);
  const auto isFixed = anchored(graph, index_);
  unknownOf_.resize(graph.vertices.size(), -1);
  states_.reserve(graph.vertices.size());
  for (std::size_t i = 0; i < graph.vertices.size(); ++i) {
    states_.push_back(Space::stateOf(graph.vertices[i].pose));
    if (!isFixed[i]) unknownOf_[i] = unknowns_++;
  }
  measurements_.reserve(graph.constraints.size());
  for (std::size_t i = 0; i < graph.constraints.size(); ++i) {
    const auto& constraint = graph.constraints[i];
    const auto [from, to] = index_.ends(i);
    measurements_.push_back({.from = from,
                             .to = to,
                             .measured = Space::stateOf(constraint.T_from_to),
                             .information = constraint.information});
  }
  findPlaces();
  gradient_.resize(static_cast<Eigen::Index>(unknowns_) * kDimension);
}

template <typename Pose>
void PoseProblem<Pose>::findPlaces() {
  struct Tie {
    BlockPlace place;
    std::size_t measurement;
  };
  std::vector<Tie> ties;
  ties.reserve(measurements_.size());
  for (std::size_t i = 0; i < measurements_.size(); ++i) {
    const int from = unknownOf_[measurements_[i].from];
    const int to = unknownOf_[measurements_[i].to];
    if (from < 0 || to < 0) continue;
    measurements_[i].isTransposed = from < to;
    ties.push_back({{std::max(from, to), std::min(from, to)}, i});
  }
  std::ranges::sort(ties, {},
                    [](const Tie& tie) { return std::tuple(tie.place.column, tie.place.row, tie.measurement); });
  auto& places = equations_.places;
  for (const auto& tie : ties) {
    if (places.empty() || places.back().row != tie.place.row || places.back().column != tie.place.column) {
      places.push_back(tie.place);
    }
    measurements_[tie.measurement].place = static_cast<int>(places.size()) - 1;
  }
  equations_.diagonal.resize(static_cast<std::size_t>(unknowns_));
  equations_.offDiagonal.resize(places.size());
}

template <typename Pose>
double PoseProblem<Pose>::chi2(const std::vector<State>& states, std::span<const double> weights) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < measurements_.size(); ++i) {
    if (weights[i] > 0.0) sum += weights[i] * error(measurements_[i], states);
  }
  return sum;
}

template <typename Pose>
std::vector<double> PoseProblem<Pose>::errors(const std::vector<State>& states) const {
  std::vector<double> errors(measurements_.size());
  std::ranges::transform(measurements_, errors.begin(), [&](const auto& m) { return error(m, states); });
  return errors;
}

template <typename Pose>
double PoseProblem<Pose>::error(const Measurement& measurement, const std::vector<State>& states) const {
  const auto deviation = Space::error(states[measurement.from], states[measurement.to], measurement.measured);
  return deviation.dot(measurement.information * deviation);
}

template <typename Pose>
double PoseProblem<Pose>::costOf(std::size_t constraint, const BlockMatrix<kDimension>& inverse, bool isCounted) const {
  const auto& measurement = measurements_[constraint];
  LinearizedError<kDimension> linear;
  Space::linearize(states_[measurement.from], states_[measurement.to], measurement.measured, linear);
  const int from = unknownOf_[measurement.from];
  const int to = unknownOf_[measurement.to];
  // Covariance of what the poses say of the error, the constraint's own say included where it counts.
  Matrix known = Matrix::Zero();
  if (from >= 0) known += linear.byFrom * inverse.diagonal[static_cast<std::size_t>(from)] * linear.byFrom.transpose();
  if (to >= 0) known += linear.byTo * inverse.diagonal[static_cast<std::size_t>(to)] * linear.byTo.transpose();
  if (measurement.place >= 0) {
    const auto& block = inverse.offDiagonal[static_cast<std::size_t>(measurement.place)];
    const Matrix fromTo = measurement.isTransposed ? Matrix(block.transpose()) : block;
    const Matrix cross = linear.byFrom * fromTo * linear.byTo.transpose();
    known += cross + cross.transpose();
  }
  const Matrix& information = measurement.information;
  const typename Space::Motion pull = information * linear.error;
  const Matrix ofItself = information * known * information;
  const Eigen::LLT<Matrix> redundancy(isCounted ? Matrix(information - ofItself) : Matrix(information + ofItself));
  // What nothing else is known of cannot be contradicted.
  return redundancy.info() == Eigen::Success ? pull.dot(redundancy.solve(pull)) : 0.0;
}

template <typename Pose>
double PoseProblem<Pose>::linearize(std::span<const double> weights) {
  for (auto& block : equations_.diagonal) block.setZero();
  for (auto& block : equations_.offDiagonal) block.setZero();
  gradient_.setZero();
  double chi2 = 0.0;
  LinearizedError<kDimension> linear;
  for (std::size_t i = 0; i < measurements_.size(); ++i) {
    const auto& measurement = measurements_[i];
    if (weights[i] == 0.0) continue;
    Space::linearize(states_[measurement.from], states_[measurement.to], measurement.measured, linear);
    const Matrix information = weights[i] * measurement.information;
    const typename Space::Motion pull = information * linear.error;
    chi2 += linear.error.dot(pull);
    const int from = unknownOf_[measurement.from];
    const int to = unknownOf_[measurement.to];
    const Matrix byTo = information * linear.byTo;
    if (to >= 0) {
      gradient_.template segment<kDimension>(to * kDimension).noalias() += linear.byTo.transpose() * pull;
      equations_.diagonal[static_cast<std::size_t>(to)].noalias() += linear.byTo.transpose() * byTo;
    }
    if (from < 0) continue;
    gradient_.template segment<kDimension>(from * kDimension).noalias() += linear.byFrom.transpose() * pull;
    const Matrix byFrom = information * linear.byFrom;
    equations_.diagonal[static_cast<std::size_t>(from)].noalias() += linear.byFrom.transpose() * byFrom;
    if (measurement.place < 0) continue;
    auto& block = equations_.offDiagonal[static_cast<std::size_t>(measurement.place)];
    if (measurement.isTransposed) {
      block.noalias() += byTo.transpose() * linear.byFrom;
    } else {
      block.noalias() += linear.byFrom.transpose() * byTo;
    }
  }
  return chi2;
}

template <typename Pose>
auto PoseProblem<Pose>::moved(const Eigen::VectorXd& motion) const -> std::vector<State> {
  auto states = states_;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (unknownOf_[i] < 0) continue;
    states[i] = Space::moved(states[i], motion.template segment<kDimension>(unknownOf_[i] * kDimension));
  }
  return states;
}

template <typename Pose>
void PoseProblem<Pose>::writePoses(Graph<Pose>& graph) const {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (unknownOf_[i] >= 0) graph.vertices[i].pose = Space::poseOf(states_[i]);
  }
}

template class PoseProblem<geometry::Pose2>;
template class PoseProblem<geometry::Pose3>;

}  // namespace prodomos::localization

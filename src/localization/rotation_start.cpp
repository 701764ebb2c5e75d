// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "localization/rotation_start.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace prodomos::localization {

namespace {

/// Of the matrices that only turn, the one nearest to it.
template <int N>
Eigen::Matrix<double, N, N> nearestRotation(const Eigen::Matrix<double, N, N>& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix<double, N, N>> parts(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix<double, N, N> u = parts.matrixU();
  if ((u * parts.matrixV().transpose()).determinant() < 0.0) u.col(N - 1) *= -1.0;
  return u * parts.matrixV().transpose();
}

/// Least squares over unknowns of N rows and C columns each, of residuals x_to - A x_from - b.
template <int N, int C>
class LinearGraph {
 public:
  using Block = Eigen::Matrix<double, N, N>;
  using Value = Eigen::Matrix<double, N, C>;

  LinearGraph(int unknowns, const std::vector<BlockPlace>& places)
      : sides_(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(unknowns) * N, C)) {
    equations_.places = places;
    equations_.diagonal.assign(static_cast<std::size_t>(unknowns), Block::Zero());
    equations_.offDiagonal.assign(places.size(), Block::Zero());
  }

  /// `known` holds the values of vertices that are no unknowns.
  template <typename Measurement>
  void add(const Measurement& measurement, int from, int to, const Block& weight, const Block& map, const Value& offset,
           const std::vector<Value>& known) {
    const Block pull = map.transpose() * weight;
    if (to >= 0) {
      equations_.diagonal[static_cast<std::size_t>(to)] += weight;
      side(to) += weight * offset;
      if (from < 0) side(to) += weight * map * known[measurement.from];
    }
    if (from >= 0) {
      equations_.diagonal[static_cast<std::size_t>(from)] += pull * map;
      side(from) -= pull * offset;
      if (to < 0) side(from) += pull * known[measurement.to];
    }
    if (measurement.place < 0) return;
    auto& block = equations_.offDiagonal[static_cast<std::size_t>(measurement.place)];
    if (measurement.isTransposed) {
      block -= pull.transpose();
    } else {
      block -= pull;
    }
  }

  /// False where the measurements leave something free.
  bool solve(BlockCholesky<N>& cholesky) {
    if (!cholesky.factorize(equations_)) return false;
    for (int column = 0; column < C; ++column) {
      Eigen::VectorXd x = sides_.col(column);
      cholesky.solve(x);
      sides_.col(column) = x;
    }
    return true;
  }

  Value value(int unknown) const { return sides_.template middleRows<N>(unknown * N); }

 private:
  auto side(int unknown) { return sides_.template middleRows<N>(unknown * N); }

  BlockMatrix<N> equations_;
  Eigen::MatrixXd sides_;
};

}  // namespace

template <typename Pose>
std::vector<typename PoseProblem<Pose>::State> statesByRotations(
    const PoseProblem<Pose>& problem, const std::shared_ptr<const Elimination>& elimination) {
  using Space = PoseSpace<Pose>;
  constexpr int kAxes = Space::kAxes;
  constexpr int kAngles = kDegreesOfFreedom<Pose> - kAxes;
  using Block = Eigen::Matrix<double, kAxes, kAxes>;
  using Vector = Eigen::Matrix<double, kAxes, 1>;

  auto states = problem.states();
  std::vector<Block> transposed;  // of the rotations: R_to^T = R_measured^T R_from^T
  std::vector<Vector> positions;
  for (const auto& state : states) {
    transposed.push_back(Space::rotationOf(state).transpose());
    positions.push_back(state.translation);
  }
  BlockCholesky<kAxes> cholesky(elimination);

  LinearGraph<kAxes, kAxes> rotations(problem.unknowns(), problem.places());
  for (const auto& m : problem.measurements()) {
    const double weight = m.information.template bottomRightCorner<kAngles, kAngles>().trace() / kAngles;
    rotations.add(m, problem.unknownOf(m.from), problem.unknownOf(m.to), weight * Block::Identity(),
                  Space::rotationOf(m.measured).transpose(), Block::Zero(), transposed);
  }
  if (!rotations.solve(cholesky)) return states;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const int unknown = problem.unknownOf(i);
    if (unknown >= 0) transposed[i] = nearestRotation<kAxes>(rotations.value(unknown));
  }

  LinearGraph<kAxes, 1> shifts(problem.unknowns(), problem.places());
  for (const auto& m : problem.measurements()) {
    const Block R_map_from = transposed[m.from].transpose();
    const Block R_measured_map = (R_map_from * Space::rotationOf(m.measured)).transpose();
    const Block weight =
        R_measured_map.transpose() * m.information.template topLeftCorner<kAxes, kAxes>() * R_measured_map;
    shifts.add(m, problem.unknownOf(m.from), problem.unknownOf(m.to), weight, Block::Identity(),
               R_map_from * m.measured.translation, positions);
  }
  if (!shifts.solve(cholesky)) return states;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const int unknown = problem.unknownOf(i);
    if (unknown >= 0) states[i] = Space::stateOf(transposed[i].transpose(), shifts.value(unknown));
  }
  return states;
}

template std::vector<PoseProblem<geometry::Pose2>::State> statesByRotations(const PoseProblem<geometry::Pose2>&,
                                                                            const std::shared_ptr<const Elimination>&);
template std::vector<PoseProblem<geometry::Pose3>::State> statesByRotations(const PoseProblem<geometry::Pose3>&,
                                                                            const std::shared_ptr<const Elimination>&);

}  // namespace prodomos::localization

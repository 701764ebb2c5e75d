// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/localization/pose_graph.hpp"

#include "localization/block_cholesky.hpp"
#include "localization/graph_index.hpp"
#include "localization/pose_space.hpp"

#include <memory>
#include <span>
#include <vector>

namespace prodomos::localization {

/// A pose graph in the form that is quick to compute with. Free vertices are numbered from 0, as unknowns.
template <typename Pose>
class PoseProblem {
 public:
  static constexpr int kDimension = kDegreesOfFreedom<Pose>;
  using Space = PoseSpace<Pose>;
  using State = typename Space::State;
  using Matrix = MotionMatrix<Pose>;

  struct Measurement {
    std::size_t from = 0;
    std::size_t to = 0;
    State measured;
    Matrix information;
    int place = -1;  ///< of the equations' block that ties its ends; -1 where one is fixed
    bool isTransposed = false;
  };

  /// Throws base::Error where the graph is not well formed; see optimize().
  explicit PoseProblem(const Graph<Pose>& graph);

  int unknowns() const { return unknowns_; }
  const std::vector<State>& states() const { return states_; }
  /// Where the equations have blocks off the diagonal: one for each pair of free vertices that constraints tie.
  const std::vector<BlockPlace>& places() const { return equations_.places; }
  /// Of the equations' blocks; takes as long as a step or two.
  std::shared_ptr<const Elimination> findElimination() const {
    return std::make_shared<const Elimination>(unknowns_, equations_.places);
  }
  /// -1 for a fixed vertex.
  int unknownOf(std::size_t vertex) const { return unknownOf_[vertex]; }
  const std::vector<Measurement>& measurements() const { return measurements_; }
  const GraphIndex& index() const { return index_; }

  double chi2(const std::vector<State>& states, std::span<const double> weights) const;
  /// e^T information e of each constraint.
  std::vector<double> errors(const std::vector<State>& states) const;

  /// By how much chi² would be less without a constraint that counts in full, or more with one that does not count;
  /// `inverse` is that of the equations where the states are.
  double costOf(std::size_t constraint, const BlockMatrix<kDimension>& inverse, bool isCounted) const;

  /// The normal equations of all constraints where the states are, `matrix` * motion = -gradient. Returns chi².
  double linearize(std::span<const double> weights);
  const BlockMatrix<kDimension>& matrix() const { return equations_; }
  const Eigen::VectorXd& gradient() const { return gradient_; }

  std::vector<State> moved(const Eigen::VectorXd& motion) const;
  void setStates(std::vector<State> states) { states_ = std::move(states); }
  /// Of the free vertices.
  void writePoses(Graph<Pose>& graph) const;

 private:
  void findPlaces();
  double error(const Measurement& measurement, const std::vector<State>& states) const;

  GraphIndex index_;
  std::vector<State> states_;
  std::vector<int> unknownOf_;
  std::vector<Measurement> measurements_;
  int unknowns_ = 0;
  BlockMatrix<kDimension> equations_;
  Eigen::VectorXd gradient_;
};

extern template class PoseProblem<geometry::Pose2>;
extern template class PoseProblem<geometry::Pose3>;

}  // namespace prodomos::localization

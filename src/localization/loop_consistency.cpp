// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/loop_consistency.hpp"

#include "localization/chi_square.hpp"
#include "localization/largest_clique.hpp"
#include "localization/spanning_tree.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>

namespace prodomos::localization {

namespace {

using geometry::Pose3;
using Matrix6 = MotionMatrix<Pose3>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

Eigen::Matrix3d cross(const Eigen::Vector3d& v) {
  return (Eigen::Matrix3d() << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0).finished();
}

/// Carries motions in b's axes into a's.
Matrix6 adjoint(const Pose3& T_a_b) {
  Matrix6 result = Matrix6::Zero();
  result.topLeftCorner<3, 3>() = T_a_b.linear();
  result.bottomRightCorner<3, 3>() = T_a_b.linear();
  result.topRightCorner<3, 3>() = cross(T_a_b.translation()) * T_a_b.linear();
  return result;
}

Matrix6 carried(const Pose3& T_a_b, const Matrix6& covariance_in_b) {
  const Matrix6 map = adjoint(T_a_b);
  return map * covariance_in_b * map.transpose();
}

/// The steady motion that leads to `pose` in unit time. Unlike (translation, rotation vector) it is carried by the
/// adjoint exactly, however far the axes are away: large maps have long levers.
Vector6 twistOf(const Pose3& pose) {
  const Eigen::AngleAxisd turn(pose.linear());
  const double angle = turn.angle();
  const Eigen::Vector3d vector = angle * turn.axis();
  const double square =
      angle < 1e-4 ? 1.0 / 12.0 : 1.0 / (angle * angle) - (1.0 + std::cos(angle)) / (2.0 * angle * std::sin(angle));
  const Eigen::Matrix3d across = cross(vector);
  Vector6 twist;
  twist.head<3>() =
      pose.translation() - 0.5 * across * pose.translation() + square * across * across * pose.translation();
  twist.tail<3>() = vector;
  return twist;
}

/// Poses along the trusted way, and how uncertain it is, both seen from the first vertex of each part. In those axes
/// covariances of successive stretches simply add up.
struct TrustedWay {
  explicit TrustedWay(const PoseGraph& graph) : tree(graph), poses(graph.vertices.size()), covariances(poses.size()) {
    for (const std::size_t vertex : tree.order()) {
      const auto& step = tree.stepTo(vertex);
      if (!step) {
        poses[vertex] = Pose3::Identity();
        covariances[vertex].setZero();
        continue;
      }
      const auto& constraint = graph.constraints[step->constraint];
      const Pose3& T_from_to = constraint.T_from_to;
      poses[vertex] = poses[step->before] * (step->isForward ? T_from_to : T_from_to.inverse());
      // The deviation is in the axes of `to`, whichever way it is gone.
      const auto& to = step->isForward ? poses[vertex] : poses[step->before];
      covariances[vertex] = covariances[step->before] + carried(to, constraint.information.inverse());
    }
  }

  /// Of the way between two vertices of one part.
  Matrix6 between(std::size_t a, std::size_t b) const {
    return covariances[a] + covariances[b] - 2.0 * covariances[tree.meeting(a, b)];
  }

  SpanningTree tree;
  std::vector<Pose3> poses;
  std::vector<Matrix6> covariances;
};

struct Loop {
  std::size_t constraint = 0;
  std::size_t from = 0;
  std::size_t to = 0;
  Pose3 correction;    ///< where the loop would move the way at `to`: the same for all loops, were the way exact
  Matrix6 covariance;  ///< of the loop, from the first vertex
};

std::vector<Loop> loopsOf(const PoseGraph& graph, const TrustedWay& way) {
  std::vector<Loop> loops;
  for (std::size_t i = 0; i < graph.constraints.size(); ++i) {
    const auto& constraint = graph.constraints[i];
    if (!constraint.isDoubtful) continue;
    const auto [from, to] = way.tree.index().ends(i);
    loops.push_back({.constraint = i,
                     .from = from,
                     .to = to,
                     .correction = way.poses[from] * constraint.T_from_to * way.poses[to].inverse(),
                     .covariance = carried(way.poses[to], constraint.information.inverse())});
  }
  return loops;
}

bool isComparable(const Loop& a, const Loop& b, const SpanningTree& tree) {
  return tree.part(a.from) == tree.part(b.from) && tree.part(a.to) == tree.part(b.to);
}

bool agree(const Loop& a, const Loop& b, const TrustedWay& way, double bound) {
  // a, the way from a's end to b's, b back, and the way home.
  const Vector6 gap = twistOf(a.correction * b.correction.inverse());
  const Matrix6 ends = way.between(a.to, b.to) + a.covariance + b.covariance;
  const Matrix6 covariance = way.between(a.from, b.from) + carried(a.correction, ends);
  return gap.dot(covariance.ldlt().solve(gap)) <= bound;
}

}  // namespace

std::vector<std::size_t> consistentLoops(const PoseGraph& graph, const ConsistencyConfig& config) {
  const TrustedWay way(graph);
  const auto loops = loopsOf(graph, way);
  const double bound = chiSquareBound(kDegreesOfFreedom<Pose3>, config.rejectedTruePairs);
  Agreement agreement(loops.size());
  for (std::size_t a = 0; a < loops.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      // Loops between other parts of the graph say nothing about each other.
      if (!isComparable(loops[a], loops[b], way.tree) || agree(loops[a], loops[b], way, bound)) agreement.set(a, b);
    }
  }
  auto largest = largestClique(agreement);
  std::ranges::transform(largest, largest.begin(), [&](std::size_t loop) { return loops[loop].constraint; });
  return largest;
}

}  // namespace prodomos::localization

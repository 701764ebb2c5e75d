// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pose.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

/// Refinement of poses that constraints tie together: graphs of SE(3), as our maps have them, and of SE(2), as files of
/// laser benchmarks have them. Both are told apart by their type of pose, and are solved by the same code.
namespace prodomos::localization {

/// A small motion of a pose in its own axes: translation in metres, then rotation in radians (3D: a rotation vector).
template <typename Pose>
inline constexpr int kDegreesOfFreedom = 6;
template <>
inline constexpr int kDegreesOfFreedom<geometry::Pose2> = 3;

/// Covariance or information of such a motion.
template <typename Pose>
using MotionMatrix = Eigen::Matrix<double, kDegreesOfFreedom<Pose>, kDegreesOfFreedom<Pose>>;

template <typename Pose>
Pose identity() {
  if constexpr (std::is_same_v<Pose, geometry::Pose2>) {
    return {};
  } else {
    return Pose::Identity();
  }
}

template <typename Pose>
struct Vertex {
  std::int64_t id = 0;
  Pose pose = identity<Pose>();
  bool isFixed = false;
};

/// A measurement of one pose in the frame of another.
template <typename Pose>
struct Constraint {
  std::int64_t from = 0;
  std::int64_t to = 0;
  Pose T_from_to = identity<Pose>();
  /// Of the deviation d of the true pose from the measured one in its own axes, those of `to`: true = T_from_to * d.
  /// A 3D rotation is taken as twice its quaternion's vector part: the rotation vector, but for its third order.
  MotionMatrix<Pose> information = MotionMatrix<Pose>::Identity();
  bool isDoubtful = false;  ///< a loop that may be wrong
};

template <typename Pose>
struct Graph {
  std::vector<Vertex<Pose>> vertices;
  std::vector<Constraint<Pose>> constraints;
};

using PoseVertex = Vertex<geometry::Pose3>;
using PoseConstraint = Constraint<geometry::Pose3>;
using PoseGraph = Graph<geometry::Pose3>;
using PlanarPoseGraph = Graph<geometry::Pose2>;

struct OptimizerConfig {
  int maxIterations = 100;
  /// Ends where a step is expected to take less than this share off chi².
  double tolerance = 1e-7;
  /// A doubtful constraint is left out where keeping it costs more chi² than true ones do, but for this share of them.
  double rejectedTrueLoops = 0.001;
  /// The poses are the solution before some constraints were added: which doubtful ones to keep is decided from what
  /// fits them, which is quick, instead of anew. Only deciding anew lets many loops outvote odometry that they all
  /// contradict.
  bool isIncremental = false;
};

struct OptimizationReport {
  double chi2Before = 0.0;      ///< over all constraints, the doubtful ones as well
  double chi2After = 0.0;       ///< each with its weight
  int iterations = 0;           ///< systems of equations solved
  bool converged = true;        ///< false: out of iterations
  double seconds = 0.0;         ///< wall time
  std::vector<double> weights;  ///< of each constraint: 1; of a doubtful one that was left out 0
};

/// Moves the poses to where the constraints' errors, weighted by their information, have the least sum of squares near
/// where they are now. Fixed vertices stay; in a part of the graph without any, its first vertex stays, and so do
/// vertices without constraints. One thread, same input same bits. Throws base::Error at once, with nothing moved, for
/// an id that is missing or taken twice, a number that is not finite and an information that is not positive
/// semi-definite.
template <typename Pose>
OptimizationReport optimize(Graph<Pose>& graph, const OptimizerConfig& config = {});

/// Sum of e^T information e over all constraints: twice the cost that Ceres speaks of, and what g2o calls chi2.
template <typename Pose>
double chi2(const Graph<Pose>& graph);

/// Poses by a chain of measurements each: breadth first from the fixed vertices, in parts without any from their first
/// vertex, which stay where they are. Doubtful constraints are followed only where no other leads.
template <typename Pose>
void placeBySpanningTree(Graph<Pose>& graph);

/// How many parts the graph falls into, vertices without constraints included.
template <typename Pose>
int componentCount(const Graph<Pose>& graph);

/// What is known of the poses where they are now, given what stays fixed (see optimize()). Factorises once; as all
/// constraints count in full, leave doubtful ones out that were rejected.
template <typename Pose>
class Covariances {
 public:
  explicit Covariances(const Graph<Pose>& graph);
  ~Covariances();
  Covariances(Covariances&&) noexcept;
  Covariances& operator=(Covariances&&) noexcept;

  /// Of the vertex's motion in its own axes; zero where it is fixed. All are computed at the first call.
  MotionMatrix<Pose> of(std::int64_t id);
  /// Of the pose of `to` in `from`, in the axes of `to`: what a measurement between them is to be compared with.
  MotionMatrix<Pose> relative(std::int64_t from, std::int64_t to) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Covariances::of() for each id.
std::vector<MotionMatrix<geometry::Pose3>> covariances(const PoseGraph& graph, std::span<const std::int64_t> ids);
/// Covariances::relative(), for a single pair.
MotionMatrix<geometry::Pose3> relativeCovariance(const PoseGraph& graph, std::int64_t from, std::int64_t to);

}  // namespace prodomos::localization

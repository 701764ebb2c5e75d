// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/localization/pose_graph.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <cstdint>
#include <random>

namespace prodomos::test {

using localization::Graph;
using localization::kDegreesOfFreedom;
using localization::MotionMatrix;

/// A pose that is a small motion away from the origin, in the order of MotionMatrix.
template <typename Pose>
Pose motion(const Eigen::Matrix<double, kDegreesOfFreedom<Pose>, 1>& v) {
  if constexpr (std::is_same_v<Pose, geometry::Pose2>) {
    return {v[0], v[1], v[2]};
  } else {
    Pose pose = Pose::Identity();
    pose.translation() = v.template head<3>();
    const double angle = v.template tail<3>().norm();
    if (angle > 0.0) pose.linear() = Eigen::AngleAxisd(angle, v.template tail<3>() / angle).toRotationMatrix();
    return pose;
  }
}

inline geometry::Pose2 inverted(const geometry::Pose2& pose) {
  return geometry::inverse(pose);
}

inline geometry::Pose3 inverted(const geometry::Pose3& pose) {
  return pose.inverse();
}

/// Numbers of one seed, the same with each standard library.
class Dice {
 public:
  explicit Dice(std::uint32_t seed) : engine_(seed) {}

  double uniform() { return static_cast<double>(engine_()) / 4294967296.0; }
  /// Nearly normal, variance 1.
  double normal() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(uniform() * static_cast<double>(count)); }

 private:
  std::mt19937 engine_;
};

template <typename Pose>
Eigen::Matrix<double, kDegreesOfFreedom<Pose>, 1> normalVector(Dice& dice) {
  Eigen::Matrix<double, kDegreesOfFreedom<Pose>, 1> v;
  for (auto& number : v) number = dice.normal();
  return v;
}

template <typename Pose>
Pose somePose() {
  Eigen::Matrix<double, kDegreesOfFreedom<Pose>, 1> v;
  for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = 3.0 - 1.1 * static_cast<double>(i);
  return motion<Pose>(v);
}

struct RandomGraph {
  std::size_t vertices = 20;
  std::size_t loops = 10;
  double noise = 1.0;  ///< of measurements, in units of what their information says
  std::int64_t firstId = 0;
  std::uint32_t seed = 1;
};

/// A walk with loops between any of its vertices, at its true poses; all information matrices are full.
template <typename Pose>
Graph<Pose> randomGraph(const RandomGraph& config) {
  Dice dice(config.seed);
  Graph<Pose> graph;
  Pose pose = somePose<Pose>();
  for (std::size_t i = 0; i < config.vertices; ++i) {
    graph.vertices.push_back({.id = config.firstId + static_cast<std::int64_t>(i), .pose = pose});
    pose = pose * motion<Pose>(0.4 * normalVector<Pose>(dice));
  }
  const auto tie = [&](std::size_t from, std::size_t to) {
    using Matrix = MotionMatrix<Pose>;
    Matrix mixed;
    for (int column = 0; column < mixed.cols(); ++column) mixed.col(column) = normalVector<Pose>(dice);
    const Matrix covariance = 1e-4 * (mixed * mixed.transpose() + Matrix::Identity());
    const Pose truth = inverted(graph.vertices[from].pose) * graph.vertices[to].pose;
    // true = measured * deviation.
    const Eigen::Matrix<double, kDegreesOfFreedom<Pose>, 1> deviation =
        config.noise * Matrix(covariance.llt().matrixL()) * normalVector<Pose>(dice);
    const Matrix information = covariance.inverse();
    graph.constraints.push_back({.from = graph.vertices[from].id,
                                 .to = graph.vertices[to].id,
                                 .T_from_to = truth * inverted(motion<Pose>(deviation)),
                                 .information = 0.5 * (information + information.transpose())});
  };
  for (std::size_t i = 1; i < config.vertices; ++i) tie(i - 1, i);
  for (std::size_t i = 0; i < config.loops; ++i) {
    const auto from = dice.below(config.vertices);
    const auto to = (from + 1 + dice.below(config.vertices - 1)) % config.vertices;
    tie(from, to);
  }
  return graph;
}

/// Moves all vertices but the first.
template <typename Pose>
void shake(Graph<Pose>& graph, double sigma) {
  Dice dice(99);
  for (std::size_t i = 1; i < graph.vertices.size(); ++i) {
    graph.vertices[i].pose = graph.vertices[i].pose * motion<Pose>(sigma * normalVector<Pose>(dice));
  }
}

}  // namespace prodomos::test

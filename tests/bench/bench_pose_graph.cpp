// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause

/// How fast pose graphs are optimised, against Ceres with its default settings on the problem that its own pose graph
/// examples set up (automatic derivatives), both from the same spanning tree and on one core:
///
///     bench_pose_graph posegraphs/*.g2o
///
/// Ours is timed from the graph to the refined graph, Ceres within Solve() alone; processor time, median of the runs.

#include "prodomos/localization/g2o_file.hpp"
#include "prodomos/localization/pose_graph.hpp"

#include <Eigen/Cholesky>
#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <exception>
#include <map>

namespace prodomos {
namespace {

using geometry::Pose2;
using geometry::Pose3;
using namespace localization;

constexpr int kRuns = 5;

double cpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A^T A is the information: what residuals are weighted with.
template <typename Pose>
MotionMatrix<Pose> squareRoot(const MotionMatrix<Pose>& information) {
  return information.llt().matrixU();
}

struct Error2 {
  Pose2 measured;
  Eigen::Matrix3d weight;

  template <typename T>
  bool operator()(const T* x1, const T* y1, const T* yaw1, const T* x2, const T* y2, const T* yaw2,
                  T* residuals) const {
    const T dx = *x2 - *x1;
    const T dy = *y2 - *y1;
    const T inX = cos(*yaw1) * dx + sin(*yaw1) * dy - measured.x;
    const T inY = -sin(*yaw1) * dx + cos(*yaw1) * dy - measured.y;
    const double c = std::cos(measured.theta);
    const double s = std::sin(measured.theta);
    const T turn = *yaw2 - *yaw1 - measured.theta;
    const T twoPi(2.0 * M_PI);
    Eigen::Matrix<T, 3, 1> error(c * inX + s * inY, -s * inX + c * inY, turn - twoPi * floor((turn + T(M_PI)) / twoPi));
    Eigen::Map<Eigen::Matrix<T, 3, 1>>{residuals} = weight.cast<T>() * error;
    return true;
  }
};

struct Error3 {
  Pose3 measured;
  Eigen::Matrix<double, 6, 6> weight;

  template <typename T>
  bool operator()(const T* p1, const T* q1, const T* p2, const T* q2, T* residuals) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    using Quaternion = Eigen::Quaternion<T>;
    const Eigen::Map<const Vector> from(p1);
    const Eigen::Map<const Vector> to(p2);
    const Eigen::Map<const Quaternion> rotationFrom(q1);
    const Eigen::Map<const Quaternion> rotationTo(q2);
    const Quaternion turn = Quaternion(Eigen::Quaterniond(measured.linear()).cast<T>()).conjugate() *
                            (rotationFrom.conjugate() * rotationTo);
    Eigen::Matrix<T, 6, 1> error;
    error.template head<3>() = measured.linear().transpose().cast<T>() *
                               (rotationFrom.conjugate() * (to - from) - measured.translation().cast<T>());
    error.template tail<3>() = (turn.w() < T(0.0) ? T(-2.0) : T(2.0)) * turn.vec();
    Eigen::Map<Eigen::Matrix<T, 6, 1>>{residuals} = weight.cast<T>() * error;
    return true;
  }
};

struct Outcome {
  double seconds = 0.0;
  double chi2 = 0.0;
  int iterations = 0;
};

Outcome solve(ceres::Problem& problem) {
  ceres::Solver::Options options;
  options.max_num_iterations = 1000;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  const double begin = cpuSeconds();
  ceres::Solve(options, &problem, &summary);
  return {.seconds = cpuSeconds() - begin,
          .chi2 = 2.0 * summary.final_cost,
          .iterations = static_cast<int>(summary.iterations.size()) - 1};
}

Outcome solveWithCeres(const PlanarPoseGraph& graph) {
  std::map<std::int64_t, Pose2> poses;
  for (const auto& vertex : graph.vertices) poses[vertex.id] = vertex.pose;
  ceres::Problem problem;
  for (const auto& edge : graph.constraints) {
    auto& from = poses.at(edge.from);
    auto& to = poses.at(edge.to);
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Error2, 3, 1, 1, 1, 1, 1, 1>(
                                 new Error2{edge.T_from_to, squareRoot<Pose2>(edge.information)}),
                             nullptr, &from.x, &from.y, &from.theta, &to.x, &to.y, &to.theta);
  }
  auto& first = poses.at(graph.vertices.front().id);
  for (double* const fixed : {&first.x, &first.y, &first.theta}) problem.SetParameterBlockConstant(fixed);
  return solve(problem);
}

Outcome solveWithCeres(const PoseGraph& graph) {
  struct Pose {
    Eigen::Vector3d position;
    Eigen::Quaterniond rotation;
  };
  std::map<std::int64_t, Pose> poses;
  for (const auto& vertex : graph.vertices) {
    poses[vertex.id] = {vertex.pose.translation(), Eigen::Quaterniond(vertex.pose.linear())};
  }
  ceres::Problem problem;
  ceres::Manifold* const manifold = new ceres::EigenQuaternionManifold;
  for (const auto& edge : graph.constraints) {
    auto& from = poses.at(edge.from);
    auto& to = poses.at(edge.to);
    double* const ends[] = {from.rotation.coeffs().data(), to.rotation.coeffs().data()};
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Error3, 6, 3, 4, 3, 4>(
                                 new Error3{edge.T_from_to, squareRoot<Pose3>(edge.information)}),
                             nullptr, from.position.data(), ends[0], to.position.data(), ends[1]);
    for (double* const rotation : ends) problem.SetManifold(rotation, manifold);
  }
  auto& first = poses.at(graph.vertices.front().id);
  problem.SetParameterBlockConstant(first.position.data());
  problem.SetParameterBlockConstant(first.rotation.coeffs().data());
  return solve(problem);
}

template <typename Pose>
Outcome solveWithOurs(Graph<Pose> graph) {
  const double begin = cpuSeconds();
  const auto report = optimize(graph);
  return {.seconds = cpuSeconds() - begin, .chi2 = report.chi2After, .iterations = report.iterations};
}

template <typename Solve>
Outcome median(Solve solve) {
  std::array<Outcome, kRuns> runs;
  std::ranges::generate(runs, solve);
  std::ranges::sort(runs, {}, &Outcome::seconds);
  return runs[kRuns / 2];
}

void compare(const char* path) {
  auto file = readG2o(path);
  std::visit(
      [path](auto& graph) {
        placeBySpanningTree(graph);
        const auto ours = median([&graph] { return solveWithOurs(graph); });
        const auto ceres = median([&graph] { return solveWithCeres(graph); });
        const std::string name = std::filesystem::path(path).stem();
        std::printf("%-16s %8zu %8zu  %11.6g %3d %9.2f  %11.6g %4d %9.2f  %6.2f\n", name.c_str(), graph.vertices.size(),
                    graph.constraints.size(), ours.chi2, ours.iterations, 1e3 * ours.seconds, ceres.chi2,
                    ceres.iterations, 1e3 * ceres.seconds, ceres.seconds / ours.seconds);
        std::fflush(stdout);
      },
      file.graph);
}

}  // namespace
}  // namespace prodomos

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_pose_graph FILE.g2o...\n");
    return 2;
  }
  try {
    std::printf("%-16s %8s %8s  %11s %3s %9s  %11s %4s %9s  %6s\n", "graph", "poses", "edges", "chi2", "its", "ms",
                "Ceres: chi2", "its", "ms", "ratio");
    for (int i = 1; i < argc; ++i) prodomos::compare(argv[i]);
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "bench_pose_graph: %s\n", fault.what());
    return 1;
  }
  return 0;
}

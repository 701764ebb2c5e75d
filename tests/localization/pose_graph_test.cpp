// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/pose_graph.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/localization/g2o_file.hpp"

#include "localization/random_graph.hpp"
#include "support/datasets.hpp"

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace prodomos::localization {
namespace {

using geometry::Pose2;
using geometry::Pose3;
using test::motion;
using test::randomGraph;
using testing::HasSubstr;

Eigen::Matrix4d matrixOf(const Pose3& pose) {
  return pose.matrix();
}

Eigen::Matrix4d matrixOf(const Pose2& pose) {
  return geometry::toPose3(pose).matrix();
}

template <typename Pose>
double greatestDifference(const Graph<Pose>& a, const Graph<Pose>& b) {
  double greatest = 0.0;
  for (std::size_t i = 0; i < a.vertices.size(); ++i) {
    const Eigen::Matrix4d difference = matrixOf(a.vertices[i].pose) - matrixOf(b.vertices[i].pose);
    greatest = std::max(greatest, difference.cwiseAbs().maxCoeff());
  }
  return greatest;
}

/// All that is true of graphs in the plane and of those in space.
template <typename Pose>
class EachPoseGraph : public testing::Test {
 public:
  static constexpr int kDimension = kDegreesOfFreedom<Pose>;

  /// Information of all free vertices by differences of chi², for one where all measurements are met exactly.
  static Eigen::MatrixXd informationByDifferences(const Graph<Pose>& graph) {
    const auto size = static_cast<Eigen::Index>(graph.vertices.size() - 1) * kDimension;
    constexpr double kStep = 1e-5;
    const auto at = [&](const Eigen::VectorXd& step) {
      auto shifted = graph;
      for (std::size_t i = 1; i < graph.vertices.size(); ++i) {
        auto& pose = shifted.vertices[i].pose;
        pose = pose * motion<Pose>(step.segment<kDimension>(static_cast<Eigen::Index>(i - 1) * kDimension));
      }
      return chi2(shifted);
    };
    Eigen::MatrixXd information(size, size);
    const Eigen::MatrixXd steps = kStep * Eigen::MatrixXd::Identity(size, size);
    for (Eigen::Index row = 0; row < size; ++row) {
      for (Eigen::Index column = 0; column < size; ++column) {
        information(row, column) =
            (at(steps.col(row) + steps.col(column)) - at(steps.col(row) - steps.col(column))) / (4.0 * kStep * kStep);
      }
    }
    return information;
  }
};

using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(EachPoseGraph, Poses);

TYPED_TEST(EachPoseGraph, FindsTheTruthAgainWhereMeasurementsAreExact) {
  const auto truth = randomGraph<TypeParam>({.vertices = 40, .loops = 30, .noise = 0.0});
  auto graph = truth;
  test::shake(graph, 0.3);
  const auto report = optimize(graph);
  EXPECT_TRUE(report.converged);
  EXPECT_GT(report.chi2Before, 1.0);
  EXPECT_LT(report.chi2After, 1e-12);
  EXPECT_LT(greatestDifference(graph, truth), 1e-6);
}

TYPED_TEST(EachPoseGraph, EndsWhereNoSmallMotionLowersChi2) {
  auto graph = randomGraph<TypeParam>({.vertices = 15, .loops = 12, .noise = 1.0});
  const auto report = optimize(graph, {.tolerance = 1e-12});
  EXPECT_LT(report.chi2After, report.chi2Before);
  EXPECT_NEAR(report.chi2After, chi2(graph), 1e-9 * report.chi2After);
  for (std::size_t i = 1; i < graph.vertices.size(); ++i) {
    for (int axis = 0; axis < this->kDimension; ++axis) {
      for (const double step : {-1e-3, 1e-3}) {
        auto moved = graph;
        const MotionMatrix<TypeParam> steps = step * MotionMatrix<TypeParam>::Identity();
        moved.vertices[i].pose = moved.vertices[i].pose * motion<TypeParam>(steps.col(axis));
        EXPECT_GT(chi2(moved), report.chi2After) << "vertex " << i << ", axis " << axis;
      }
    }
  }
}

TYPED_TEST(EachPoseGraph, IsTheSameWhereverTheWholeLies) {
  auto graph = randomGraph<TypeParam>({.vertices = 30, .loops = 20, .noise = 1.0});
  const TypeParam shift = test::somePose<TypeParam>();
  auto shifted = graph;
  for (auto& vertex : shifted.vertices) vertex.pose = shift * vertex.pose;
  optimize(graph, {.tolerance = 1e-12});
  optimize(shifted, {.tolerance = 1e-12});
  for (auto& vertex : graph.vertices) vertex.pose = shift * vertex.pose;
  EXPECT_LT(greatestDifference(graph, shifted), 1e-6);
}

TYPED_TEST(EachPoseGraph, IsTheSameWhicheverWayRoundAnEdgeIsMeasured) {
  auto graph = randomGraph<TypeParam>({.vertices = 20, .loops = 15, .noise = 0.0});
  test::shake(graph, 0.2);
  auto turned = graph;
  for (auto& edge : turned.constraints) {
    std::swap(edge.from, edge.to);
    edge.T_from_to = test::inverted(edge.T_from_to);
  }
  optimize(graph);
  optimize(turned);
  EXPECT_LT(greatestDifference(graph, turned), 1e-6);
}

TYPED_TEST(EachPoseGraph, GivesTheSameBitsEachTime) {
  const auto start = randomGraph<TypeParam>({.vertices = 60, .loops = 50, .noise = 1.0});
  auto first = start;
  auto second = start;
  optimize(first);
  optimize(second);
  EXPECT_EQ(greatestDifference(first, second), 0.0);
}

TYPED_TEST(EachPoseGraph, LeavesFixedVerticesAndTheFirstOfEachPartWhereTheyAre) {
  auto graph = randomGraph<TypeParam>({.vertices = 20, .loops = 10, .noise = 1.0});
  auto other = randomGraph<TypeParam>({.vertices = 10, .loops = 5, .noise = 1.0, .firstId = 100});
  graph.vertices.insert(graph.vertices.end(), other.vertices.begin(), other.vertices.end());
  graph.constraints.insert(graph.constraints.end(), other.constraints.begin(), other.constraints.end());
  graph.vertices.push_back({.id = 500, .pose = test::somePose<TypeParam>()});
  graph.vertices[7].isFixed = true;
  EXPECT_EQ(componentCount(graph), 3);
  const auto start = graph;
  optimize(graph);
  for (const std::size_t still : {7U, 20U, 30U}) {
    EXPECT_EQ(matrixOf(graph.vertices[still].pose), matrixOf(start.vertices[still].pose));
  }
  EXPECT_NE(matrixOf(graph.vertices[0].pose), matrixOf(start.vertices[0].pose));
}

TYPED_TEST(EachPoseGraph, SpanningTreeMeetsItsMeasurementsExactly) {
  auto graph = randomGraph<TypeParam>({.vertices = 50, .loops = 0, .noise = 1.0});
  test::shake(graph, 1.0);
  placeBySpanningTree(graph);
  EXPECT_LT(chi2(graph), 1e-12);
}

TYPED_TEST(EachPoseGraph, CovarianceIsTheInverseOfChi2sCurvature) {
  const auto graph = randomGraph<TypeParam>({.vertices = 8, .loops = 6, .noise = 0.0});
  const Eigen::MatrixXd all = this->informationByDifferences(graph).inverse();
  Covariances known(graph);
  EXPECT_EQ(known.of(graph.vertices[0].id).norm(), 0.0);
  constexpr int D = TestFixture::kDimension;
  for (std::size_t i = 1; i < graph.vertices.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i - 1) * D;
    const MotionMatrix<TypeParam> expected = all.block<D, D>(at, at);
    EXPECT_LT((known.of(graph.vertices[i].id) - expected).norm(), 1e-4 * expected.norm()) << i;
  }
}

TYPED_TEST(EachPoseGraph, RelativeCovarianceOfAChainsEndsIsThatOfTheChain) {
  // A single edge: what is known of `to` in `from` is what was measured, wherever the pair stands.
  const auto graph = randomGraph<TypeParam>({.vertices = 6, .loops = 0, .noise = 0.0});
  const Covariances known(graph);
  for (const auto& edge : graph.constraints) {
    const MotionMatrix<TypeParam> expected = edge.information.inverse();
    EXPECT_LT((known.relative(edge.from, edge.to) - expected).norm(), 1e-9 * expected.norm());
  }
  // From the fixed vertex, relative is absolute.
  Covariances absolute(graph);
  const auto last = graph.vertices.back().id;
  EXPECT_LT((known.relative(graph.vertices.front().id, last) - absolute.of(last)).norm(), 1e-9);
}

TYPED_TEST(EachPoseGraph, RefusesWhatIsNoGraph) {
  const auto good = randomGraph<TypeParam>({.vertices = 5, .loops = 2, .noise = 0.0});
  const auto refusal = [](Graph<TypeParam> graph) -> std::string {
    const auto before = graph;
    try {
      optimize(graph);
    } catch (const base::Error& error) {
      EXPECT_EQ(greatestDifference(before, graph), 0.0);
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(refusal(good), "none");
  auto graph = good;
  graph.constraints[1].to = 77;
  EXPECT_THAT(refusal(graph), HasSubstr("expected a vertex 77, found none"));
  graph = good;
  graph.vertices[3].id = graph.vertices[1].id;
  EXPECT_THAT(refusal(graph), HasSubstr("vertex 1"));
  graph = good;
  graph.constraints[2].information(0, 0) = -1.0;
  EXPECT_THAT(refusal(graph), HasSubstr("positive semi-definite"));
  graph = good;
  graph.constraints[2].information(0, 1) += 1.0;
  EXPECT_THAT(refusal(graph), HasSubstr("symmetric"));
  graph = good;
  graph.constraints[0].information(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(graph), HasSubstr("constraint from vertex 0 to 1"));
  graph = good;
  graph.constraints[0].from = graph.constraints[0].to;
  EXPECT_THAT(refusal(graph), HasSubstr("two vertices"));
}

TEST(PoseGraph, OfNothingIsOptimal) {
  PoseGraph graph;
  EXPECT_EQ(optimize(graph).chi2After, 0.0);
  EXPECT_EQ(componentCount(graph), 0);
  graph.vertices.push_back({.id = 4});
  EXPECT_EQ(optimize(graph).iterations, 0);
}

TEST(PoseGraph, SquareClosesItsGapEvenly) {
  // Four sides of 1 m with right turns; each measured 1.1 m long one way: by symmetry all stay 1.1 m.
  PlanarPoseGraph square;
  for (int i = 0; i < 4; ++i) {
    square.vertices.push_back({.id = i});
    square.constraints.push_back(
        {.from = i, .to = (i + 1) % 4, .T_from_to = {1.1, 0.0, 1.5}, .information = Eigen::Matrix3d::Identity()});
  }
  placeBySpanningTree(square);
  optimize(square, {.tolerance = 1e-14});
  for (int i = 0; i < 4; ++i) {
    const auto side = geometry::inverse(square.vertices[static_cast<std::size_t>(i)].pose) *
                      square.vertices[static_cast<std::size_t>((i + 1) % 4)].pose;
    EXPECT_NEAR(std::abs(side.theta), std::acos(0.0), 1e-6);
  }
}

/// The chi² that others report, start: spanning tree.
class Benchmark : public testing::TestWithParam<std::pair<const char*, double>> {};

TEST_P(Benchmark, ReachesThePublishedChi2) {
  const auto [name, published] = GetParam();
  const auto path = test::dataset(std::string("posegraphs/") + name + ".g2o");
  if (!path) GTEST_SKIP() << "needs posegraphs/" << name << ".g2o";
  auto file = readG2o(*path);
  const auto report = std::visit(
      [](auto& graph) {
        placeBySpanningTree(graph);
        return optimize(graph);
      },
      file.graph);
  EXPECT_TRUE(report.converged);
  EXPECT_NEAR(report.chi2After, published, 0.6 * std::pow(10.0, std::floor(std::log10(published)) - 5.0));
}

INSTANTIATE_TEST_SUITE_P(PoseGraph, Benchmark,
                         testing::Values(std::pair("intel", 45.0047), std::pair("manhattan", 3549.04),
                                         std::pair("CSAIL", 40.5551), std::pair("parking-garage", 1.23869),
                                         std::pair("sphere2500", 727.15)));

}  // namespace
}  // namespace prodomos::localization

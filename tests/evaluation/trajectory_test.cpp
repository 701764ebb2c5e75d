// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/trajectory.hpp"

#include "evaluation/ways.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace prodomos::evaluation {

using test::at;

namespace {

/// Horn 1987 to the letter, by the greatest eigenvector of his 4x4 matrix.
geometry::Pose3 alignmentByHorn(const std::vector<PositionPair>& pairs) {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  for (const auto& [a, b] : pairs) {
    from += a / static_cast<double>(pairs.size());
    to += b / static_cast<double>(pairs.size());
  }
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  for (const auto& [a, b] : pairs) m += (a - from) * (b - to).transpose();
  Eigen::Matrix4d n;
  const Eigen::Vector3d cross(m(1, 2) - m(2, 1), m(2, 0) - m(0, 2), m(0, 1) - m(1, 0));
  n(0, 0) = m.trace();
  n.block<1, 3>(0, 1) = cross.transpose();
  n.block<3, 1>(1, 0) = cross;
  n.block<3, 3>(1, 1) = m + m.transpose() - m.trace() * Eigen::Matrix3d::Identity();
  const Eigen::Vector4d q = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(n).eigenvectors().col(3);
  geometry::Pose3 T_to_from = geometry::fromQuaternion({0, 0, 0}, {q(0), q(1), q(2), q(3)});
  T_to_from.translation() = to - T_to_from * from;
  return T_to_from;
}

double sumOfSquares(const std::vector<PositionPair>& pairs, const geometry::Pose3& T_truth_estimate) {
  double sum = 0.0;
  for (const auto& [estimated, truth] : pairs) sum += (T_truth_estimate * estimated - truth).squaredNorm();
  return sum;
}

std::vector<TimedPose> disturbed(std::vector<TimedPose> way, std::uint64_t seed) {
  base::Random random(seed);
  for (auto& pose : way) pose.pose = pose.pose * test::smallMove(random, 0.2, 0.1);
  return way;
}

}  // namespace

TEST(AbsoluteError, OfTheTruthInAnotherFrameIsZero) {
  const auto truth = test::windingWay(100);
  const auto pairs = associate(test::moved(truth, test::somewhereElse()), truth);
  ASSERT_EQ(pairs.size(), 100U);
  for (const double error : absoluteErrors(pairs)) EXPECT_NEAR(error, 0.0, 1e-9);
}

TEST(AbsoluteError, IsThatByHand) {
  // A square and the same with two opposite corners drawn out: no motion does better than none.
  const std::vector<PositionPair> pairs = {
      {{1, 1, 0}, {1, 1, 0}}, {{-1, -1, 0}, {-1, -1, 0}}, {{1.5, -1.5, 0}, {1, -1, 0}}, {{-1.5, 1.5, 0}, {-1, 1, 0}}};
  const auto errors = absoluteErrors(pairs);
  ASSERT_EQ(errors.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(errors[i], i < 2 ? 0.0 : std::sqrt(0.5), 1e-12);
}

TEST(AbsoluteError, ScaleIsNotAligned) {
  const auto truth = test::windingWay(100);
  auto twice = truth;
  for (auto& pose : twice) pose.pose.translation() *= 2.0;
  EXPECT_GT(statisticsOf(absoluteErrors(associate(twice, truth))).rmse, 1.0);
}

TEST(Alignment, IsThatOfHornsQuaternions) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto truth = test::windingWay(30);
    const auto pairs = associate(test::moved(disturbed(truth, seed), test::somewhereElse()), truth);
    EXPECT_TRUE(alignment(pairs).isApprox(alignmentByHorn(pairs), 1e-9));
  }
}

TEST(Alignment, IsBetterThanEverythingNearIt) {
  const auto truth = test::windingWay(40);
  const auto pairs = associate(test::moved(disturbed(truth, 5), test::somewhereElse()), truth);
  const auto best = alignment(pairs);
  base::Random random(6);
  for (int i = 0; i < 500; ++i) {
    const auto other = best * test::smallMove(random, 0.05, 0.01);
    EXPECT_GT(sumOfSquares(pairs, other), sumOfSquares(pairs, best));
  }
}

TEST(Alignment, IsARotationAlsoWhereAMirrorWouldFitBetter) {
  std::vector<PositionPair> pairs;
  base::Random random(2);
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d p = test::smallMove(random, 1.0, 0.0).translation();
    pairs.emplace_back(p, Eigen::Vector3d(-p.x(), p.y(), p.z()));
  }
  EXPECT_NEAR(alignment(pairs).linear().determinant(), 1.0, 1e-12);
  EXPECT_TRUE(alignment({}).isApprox(geometry::Pose3::Identity()));
}

TEST(Association, TakesTheNearestInTimeEachOnce) {
  const auto pose = [](double seconds, double x) { return TimedPose{at(seconds), geometry::toPose3({x, 0, 0})}; };
  const std::vector<TimedPose> estimate = {pose(0.000, 1), pose(0.010, 2), pose(1.000, 3), pose(2.000, 4)};
  const std::vector<TimedPose> truth = {pose(0.008, 10), pose(1.019, 20), pose(2.020, 30), pose(5.0, 40)};
  const auto pairs = associate(estimate, truth);
  ASSERT_EQ(pairs.size(), 2U);  // 0.020 s apart is too far, and 0.008 belongs to 0.010
  EXPECT_EQ(pairs[0].first.x(), 2.0);
  EXPECT_EQ(pairs[0].second.x(), 10.0);
  EXPECT_EQ(pairs[1].first.x(), 3.0);
  EXPECT_EQ(pairs[1].second.x(), 20.0);
  EXPECT_TRUE(associate({}, truth).empty());
  EXPECT_TRUE(associate(estimate, {}).empty());
}

TEST(RelativeError, OfTheTruthInAnotherFrameIsZero) {
  const auto truth = test::windingWay(60);
  const auto errors = relativeErrors(test::moved(truth, test::somewhereElse()), truth);
  ASSERT_EQ(errors.translation.size(), 49U);  // a second is ten poses; none ends at the last
  for (const double error : errors.translation) EXPECT_NEAR(error, 0.0, 1e-9);
  for (const double error : errors.rotation) EXPECT_NEAR(error, 0.0, 1e-7);
}

TEST(RelativeError, OfADriftIsTheDriftOverTheStretch) {
  std::vector<TimedPose> truth;
  std::vector<TimedPose> drifting;
  for (int i = 0; i < 50; ++i) {
    truth.push_back({at(0.1 * i), geometry::toPose3({0.1 * i, 0, 0})});
    drifting.push_back({at(0.1 * i), geometry::toPose3({0.11 * i, 0, 0})});  // 10 % too far
  }
  for (const int seconds : {1, 2}) {
    const auto errors = relativeErrors(drifting, truth, std::chrono::seconds(seconds));
    ASSERT_EQ(errors.translation.size(), 49U - 10U * static_cast<std::size_t>(seconds));
    for (const double error : errors.translation) EXPECT_NEAR(error, 0.1 * seconds, 1e-9);
  }
}

TEST(RelativeError, DoesNotGrowWithTheWayBehind) {
  // One slip in the middle: only the stretches over it show it.
  const auto truth = test::windingWay(100);
  auto slipped = truth;
  const auto T_slip = geometry::toPose3({0.0, 0.0, 0.3});
  for (std::size_t i = 50; i < slipped.size(); ++i) slipped[i].pose = T_slip * slipped[i].pose;
  const auto errors = relativeErrors(slipped, truth);
  EXPECT_EQ(std::ranges::count_if(errors.rotation, [](double angle) { return angle > 1e-3; }), 10);
  for (const double angle : errors.rotation) EXPECT_LT(angle, 0.3 + 1e-9);
}

TEST(RelativeError, NeedsTruthAtBothEnds) {
  const auto estimate = test::windingWay(40);
  const std::vector<TimedPose> truth(estimate.begin() + 20, estimate.end());
  EXPECT_EQ(relativeErrors(estimate, truth).translation.size(), 11U);  // two begin within two intervals before it
  EXPECT_TRUE(relativeErrors(estimate, {}).translation.empty());
  EXPECT_TRUE(relativeErrors({}, truth).translation.empty());
}

TEST(RelativeError, AStretchFromAPoseToItselfIsNone) {
  const auto pose = [](double seconds) { return TimedPose{at(seconds), geometry::Pose3::Identity()}; };
  const std::vector<TimedPose> sparse = {pose(0), pose(10), pose(20), pose(30)};
  EXPECT_TRUE(relativeErrors(sparse, sparse).translation.empty());
}

}  // namespace prodomos::evaluation

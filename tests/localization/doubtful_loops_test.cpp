// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "localization/laps.hpp"

#include <gtest/gtest.h>

namespace prodomos::localization {
namespace {

using geometry::Pose3;
using test::Laps;

struct Decisions {
  int rejectedTrue = 0;
  int keptFalse = 0;
  int loops = 0;
};

Decisions decisionsOf(const test::LapGraph& drive, const OptimizationReport& report) {
  Decisions decisions;
  for (std::size_t i = 0; i < report.weights.size(); ++i) {
    if (!drive.graph.constraints[i].isDoubtful) {
      EXPECT_EQ(report.weights[i], 1.0);
      continue;
    }
    ++decisions.loops;
    if (drive.isFalse[i]) {
      decisions.keptFalse += report.weights[i] > 0.0 ? 1 : 0;
    } else {
      decisions.rejectedTrue += report.weights[i] < 1.0 ? 1 : 0;
    }
  }
  return decisions;
}

/// How many in a hundred loops are false, and the seed.
class FalseLoops : public testing::TestWithParam<std::tuple<int, std::uint32_t>> {};

TEST_P(FalseLoops, DoNotBendTheMap) {
  const auto [share, seed] = GetParam();
  auto drive = test::driveLaps({.falseLoops = 0.01 * share, .seed = seed});
  auto clean = withoutFalseLoops(drive);
  optimize(clean.graph);
  const auto report = optimize(drive.graph);
  const auto decisions = decisionsOf(drive, report);
  EXPECT_EQ(decisions.keptFalse, 0);
  EXPECT_LE(decisions.rejectedTrue, 1) << "of " << decisions.loops;
  EXPECT_LT(rmse(drive), 1.03 * rmse(clean));
}

INSTANTIATE_TEST_SUITE_P(DoubtfulLoops, FalseLoops,
                         testing::Combine(testing::Values(0, 30, 50), testing::Values(1U, 2U, 3U, 4U, 5U)));

TEST(DoubtfulLoops, OutvoteOdometryThatDriftsMoreThanItSays) {
  auto drive = test::driveLaps({.falseLoops = 0.3, .isHonest = false});
  const double before = rmse(drive);
  const auto report = optimize(drive.graph);
  const auto decisions = decisionsOf(drive, report);
  EXPECT_EQ(decisions.keptFalse, 0);
  EXPECT_LT(decisions.rejectedTrue, decisions.loops / 10);
  EXPECT_LT(rmse(drive), 0.05 * before);
}

TEST(DoubtfulLoops, ASingleFalseOneLeavesOdometryItsShape) {
  auto drive = test::driveLaps({.laps = 1, .trueLoops = 0.0});
  const auto odometry = drive.graph;
  // "The far end of the round is where it began": 16 m off, and odometry is good to some decimetres.
  drive.graph.constraints.push_back(
      {.from = 0, .to = 25, .information = 1e3 * MotionMatrix<Pose3>::Identity(), .isDoubtful = true});
  const auto report = optimize(drive.graph);
  EXPECT_EQ(report.weights.back(), 0.0);
  EXPECT_LT(report.chi2After, 1e-3);
  for (std::size_t i = 0; i < odometry.vertices.size(); ++i) {
    EXPECT_TRUE(drive.graph.vertices[i].pose.isApprox(odometry.vertices[i].pose, 1e-4));
  }
}

TEST(DoubtfulLoops, ASingleTrueOneIsKept) {
  auto drive = test::driveLaps({.laps = 2, .trueLoops = 0.0});
  const Pose3 T_first_last = drive.truth.front().inverse() * drive.truth.back();
  drive.graph.constraints.push_back({.from = 0,
                                     .to = 99,
                                     .T_from_to = T_first_last,
                                     .information = 1e3 * MotionMatrix<Pose3>::Identity(),
                                     .isDoubtful = true});
  const double before = rmse(drive);
  const auto report = optimize(drive.graph);
  EXPECT_EQ(report.weights.back(), 1.0);
  EXPECT_LT(rmse(drive), 0.75 * before);
}

TEST(DoubtfulLoops, HoldAPartThatNothingElseHolds) {
  // Two rooms, joined by two loops that disagree: a pose for the second room there must be.
  auto drive = test::driveLaps({.laps = 1, .trueLoops = 0.0});
  auto& constraints = drive.graph.constraints;
  constraints.erase(constraints.begin() + 24);
  for (const double offset : {0.0, 5.0}) {
    PoseConstraint loop{.from = 3, .to = 40, .information = 1e3 * MotionMatrix<Pose3>::Identity(), .isDoubtful = true};
    loop.T_from_to.translation().x() += offset;
    constraints.push_back(loop);
  }
  optimize(drive.graph);
  for (const auto& vertex : drive.graph.vertices) EXPECT_TRUE(geometry::isFinite(vertex.pose));
}

TEST(DoubtfulLoops, AreJudgedAnewFromTheLastSolution) {
  // As a running mapper does: a loop more each time.
  const auto drive = test::driveLaps({.falseLoops = 0.3, .seed = 7});
  auto atOnce = drive;
  optimize(atOnce.graph);
  auto growing = withoutFalseLoops(drive);
  growing.graph.constraints.clear();
  for (const bool loops : {false, true}) {
    for (const auto& constraint : drive.graph.constraints) {
      if (constraint.isDoubtful != loops) continue;
      growing.graph.constraints.push_back(constraint);
      if (loops) optimize(growing.graph, {.isIncremental = true});
    }
  }
  EXPECT_LT(rmse(growing), 1.05 * rmse(atOnce) + 0.005);
}

}  // namespace
}  // namespace prodomos::localization

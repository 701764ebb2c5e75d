// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/loop_consistency.hpp"

#include "localization/chi_square.hpp"
#include "localization/laps.hpp"
#include "localization/largest_clique.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

namespace prodomos::localization {
namespace {

using geometry::Pose3;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(LoopConsistency, FindsTheTrueLoopsAmongFalseOnes) {
  for (const std::uint32_t seed : {1U, 2U, 3U, 4U}) {
    const auto drive = test::driveLaps({.falseLoops = 0.5, .seed = seed});
    const auto set = consistentLoops(drive.graph);
    EXPECT_TRUE(std::ranges::is_sorted(set));
    int wrong = 0;
    for (const auto loop : set) {
      EXPECT_TRUE(drive.graph.constraints[loop].isDoubtful);
      wrong += drive.isFalse[loop] ? 1 : 0;
    }
    const auto loops = std::ranges::count_if(drive.graph.constraints, &PoseConstraint::isDoubtful);
    const auto falseLoops = std::ranges::count(drive.isFalse, true);
    EXPECT_EQ(wrong, 0) << "seed " << seed;
    EXPECT_GT(static_cast<double>(set.size()), 0.7 * static_cast<double>(loops - falseLoops)) << "seed " << seed;
  }
}

TEST(LoopConsistency, DoesNotDependOnPosesOrOnTheWayRound) {
  auto drive = test::driveLaps({.falseLoops = 0.5});
  const auto set = consistentLoops(drive.graph);
  test::shake(drive.graph, 1.0);
  EXPECT_EQ(consistentLoops(drive.graph), set);
  for (auto& edge : drive.graph.constraints) {
    if (edge.isDoubtful) continue;
    // The deviation stays the same, told in the axes of the other end.
    std::swap(edge.from, edge.to);
    MotionMatrix<Pose3> map = MotionMatrix<Pose3>::Zero();
    const Eigen::Vector3d t = edge.T_from_to.translation();
    const Eigen::Matrix3d across =
        (Eigen::Matrix3d() << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0).finished();
    map.topLeftCorner<3, 3>() = map.bottomRightCorner<3, 3>() = edge.T_from_to.linear();
    map.topRightCorner<3, 3>() = across * edge.T_from_to.linear();
    const MotionMatrix<Pose3> covariance = map * edge.information.inverse() * map.transpose();
    const MotionMatrix<Pose3> information = covariance.inverse();
    edge.information = 0.5 * (information + information.transpose());
    edge.T_from_to = edge.T_from_to.inverse();
  }
  EXPECT_EQ(consistentLoops(drive.graph), set);
}

TEST(LoopConsistency, OfOneLoopIsThatLoopAndOfNoneNothing) {
  auto drive = test::driveLaps({.laps = 1, .trueLoops = 0.0});
  EXPECT_THAT(consistentLoops(drive.graph), IsEmpty());
  drive.graph.constraints.push_back({.from = 0, .to = 30, .isDoubtful = true});
  EXPECT_THAT(consistentLoops(drive.graph), ElementsAre(drive.graph.constraints.size() - 1));
}

TEST(LoopConsistency, ComparesLoopsBetweenTwoSessionsByTheirOwnWays) {
  // Two sessions without a trusted way between them; three loops agree on where the second lies, two do not.
  auto drive = test::driveLaps({.laps = 2, .trueLoops = 0.0});
  auto& constraints = drive.graph.constraints;
  constraints.erase(constraints.begin() + 49);
  const auto join = [&](int from, int to, const Pose3& wrong) {
    const auto at = [&](int i) { return drive.truth[static_cast<std::size_t>(i)]; };
    constraints.push_back({.from = from,
                           .to = to,
                           .T_from_to = at(from).inverse() * at(to) * wrong,
                           .information = 1e3 * MotionMatrix<Pose3>::Identity(),
                           .isDoubtful = true});
  };
  join(5, 57, Pose3::Identity());
  join(20, 71, geometry::fromYawPitchRoll({4, 0, 0}, 0.5, 0, 0));
  join(30, 80, Pose3::Identity());
  join(40, 60, geometry::fromYawPitchRoll({0, -3, 0}, 2.0, 0, 0));
  join(10, 90, Pose3::Identity());
  EXPECT_THAT(consistentLoops(drive.graph), ElementsAre(98, 100, 102));
}

TEST(LargestClique, IsThatOfTryingAllSets) {
  test::Dice dice(5);
  for (int round = 0; round < 50; ++round) {
    constexpr std::size_t kSize = 14;
    const double density = 0.2 + 0.7 * dice.uniform();
    Agreement agreement(kSize);
    for (std::size_t a = 0; a < kSize; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        if (dice.uniform() < density) agreement.set(a, b);
      }
    }
    int largest = 0;
    for (unsigned set = 0; set < 1U << kSize; ++set) {
      bool agrees = true;
      for (std::size_t a = 0; a < kSize; ++a) {
        for (std::size_t b = 0; b < a; ++b) {
          if ((set >> a & 1U) != 0 && (set >> b & 1U) != 0 && !agreement(a, b)) agrees = false;
        }
      }
      if (agrees) largest = std::max(largest, std::popcount(set));
    }
    const auto clique = largestClique(agreement);
    EXPECT_EQ(static_cast<int>(clique.size()), largest);
    for (const auto a : clique) {
      for (const auto b : clique) EXPECT_TRUE(a == b || agreement(a, b));
    }
  }
}

TEST(LargestClique, GivesTheBestItHasWhenItMustEnd) {
  Agreement agreement(200);
  test::Dice dice(6);
  for (std::size_t a = 0; a < 200; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (dice.uniform() < 0.9) agreement.set(a, b);
    }
  }
  const auto clique = largestClique(agreement, 500);
  EXPECT_GT(clique.size(), 20U);
  EXPECT_THAT(largestClique(Agreement(0)), IsEmpty());
}

TEST(ChiSquare, BoundsAreThoseOfTheTables) {
  EXPECT_NEAR(chiSquareBound(1, 0.05), 3.841459, 1e-6);
  EXPECT_NEAR(chiSquareBound(2, 0.01), 9.210340, 1e-6);
  EXPECT_NEAR(chiSquareBound(3, 0.001), 16.266236, 1e-6);
  EXPECT_NEAR(chiSquareBound(6, 0.01), 16.811894, 1e-6);
  EXPECT_NEAR(chiSquareBound(6, 0.001), 22.457744, 1e-6);
}

}  // namespace
}  // namespace prodomos::localization

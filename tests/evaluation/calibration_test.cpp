// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/calibration.hpp"

#include "prodomos/base/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace prodomos::evaluation {
namespace {

TEST(Calibration, OfNoBetIsNone) {
  EXPECT_FALSE(calibrationOf({}));
}

TEST(Calibration, IsWhatOneReckonsByHand) {
  const auto calibration = calibrationOf({{0.9, true}, {0.8, true}, {0.7, false}, {0.1, false}});
  ASSERT_TRUE(calibration);
  EXPECT_NEAR(calibration->brier, (0.01 + 0.04 + 0.49 + 0.01) / 4, 1e-12);
  EXPECT_NEAR(calibration->baseRate, 0.5, 1e-12);
  EXPECT_NEAR(*calibration->brierSkill, 1.0 - calibration->brier / 0.25, 1e-12);
  EXPECT_NEAR(calibration->expectedError, (0.1 + 0.2 + 0.7 + 0.1) / 4, 1e-12);
}

TEST(Calibration, AddsUpLikeBetsInABin) {
  const auto calibration = calibrationOf({{0.71, true}, {0.75, true}, {0.79, false}});
  ASSERT_TRUE(calibration);
  const auto& bin = calibration->bins[7];
  EXPECT_EQ(bin.count, 3U);
  EXPECT_NEAR(bin.meanProbability, 0.75, 1e-12);
  EXPECT_NEAR(bin.frequency, 2.0 / 3.0, 1e-12);
  EXPECT_EQ(calibration->bins.size(), 10U);
  EXPECT_NEAR(calibration->expectedError, 0.75 - 2.0 / 3.0, 1e-12);
}

TEST(Calibration, HasNoSkillWhereAllCameOutAlike) {
  EXPECT_FALSE(calibrationOf({{0.9, true}, {0.8, true}})->brierSkill);
  EXPECT_FALSE(calibrationOf({{0.9, false}})->brierSkill);
}

TEST(Calibration, OfTheBaseRateIsWithoutSkillAndOfTheTruthPerfect) {
  EXPECT_NEAR(*calibrationOf({{0.5, true}, {0.5, false}})->brierSkill, 0.0, 1e-12);
  EXPECT_NEAR(*calibrationOf({{1.0, true}, {0.0, false}})->brierSkill, 1.0, 1e-12);
  EXPECT_EQ(calibrationOf({{1.0, true}, {0.0, false}})->expectedError, 0.0);
}

TEST(Calibration, TakesEndsAndNonsenseIntoItsBins) {
  const auto calibration =
      calibrationOf({{1.0, true}, {7.0, true}, {-1.0, false}, {std::numeric_limits<double>::quiet_NaN(), true}});
  EXPECT_EQ(calibration->bins[9].count, 2U);
  EXPECT_EQ(calibration->bins[0].count, 1U);
  EXPECT_EQ(calibration->bins[5].count, 1U);
}

TEST(Calibration, OfHonestBetsIsNearlyPerfectInAnyOrder) {
  base::Random random(1, "calibration_test");
  std::vector<Bet> bets;
  for (int i = 0; i < 20000; ++i) {
    const double probability = random.uniform();
    bets.push_back({probability, random.uniform() < probability});
  }
  const auto calibration = calibrationOf(bets);
  EXPECT_LT(calibration->expectedError, 0.02);
  EXPECT_NEAR(*calibration->brierSkill, 1.0 / 3.0, 0.02);  // 1 - (1/6) / (1/4)
  std::ranges::reverse(bets);
  EXPECT_NEAR(calibrationOf(bets)->brier, calibration->brier, 1e-9);
}

}  // namespace
}  // namespace prodomos::evaluation

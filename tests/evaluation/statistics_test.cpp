// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace prodomos::evaluation {

TEST(Statistics, OfFourNumbersAreThoseByHand) {
  const auto s = statisticsOf({4.0, 1.0, 2.0, 5.0});
  EXPECT_EQ(s.count, 4U);
  EXPECT_DOUBLE_EQ(s.mean, 3.0);
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(10.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.squaredMean, 46.0 / 4.0);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(46.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.squaredStd, std::sqrt(369.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.median, 3.0);
  EXPECT_DOUBLE_EQ(s.min, 1.0);
  EXPECT_DOUBLE_EQ(s.max, 5.0);
}

TEST(Statistics, OfNothingAreZero) {
  const auto s = statisticsOf({});
  EXPECT_EQ(s.count, 0U);
  EXPECT_EQ(s.mean, 0.0);
  EXPECT_EQ(s.max, 0.0);
}

TEST(Statistics, AMedianOfAnOddNumberIsOneOfThem) {
  EXPECT_DOUBLE_EQ(statisticsOf({9.0, 1.0, 2.0}).median, 2.0);
}

TEST(Statistics, AFarOffsetDoesNotSpoilTheDeviation) {
  EXPECT_NEAR(statisticsOf({1e9 + 1.0, 1e9 + 3.0}).std, 1.0, 1e-6);
}

}  // namespace prodomos::evaluation

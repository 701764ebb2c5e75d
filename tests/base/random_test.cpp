// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/random.hpp"

#include <gtest/gtest.h>

#include <array>

namespace prodomos::base {
namespace {

TEST(Random, GivesTheSameNumbersForTheSameSeed) {
  Random one(42);
  Random other(42);
  Random third(43);
  int alike = 0;
  for (int i = 0; i < 100; ++i) {
    const double number = one.uniform();
    EXPECT_EQ(number, other.uniform());
    if (number == third.uniform()) ++alike;
  }
  EXPECT_EQ(alike, 0);
}

TEST(Random, GivesTheSameNumbersOnEveryMachine) {
  Random random(5489);
  // The first output of std::mt19937_64 is laid down by the standard's reference: 14514284786278117030.
  EXPECT_EQ(random.uniform(), static_cast<double>(14514284786278117030U >> 11U) * 0x1.0p-53);
}

TEST(Random, IsUniform) {
  Random random(1);
  std::array<int, 10> counts{};
  constexpr int kDraws = 100'000;
  for (int i = 0; i < kDraws; ++i) {
    const double number = random.uniform(-5.0, 5.0);
    ASSERT_GE(number, -5.0);
    ASSERT_LT(number, 5.0);
    ++counts[static_cast<std::size_t>(number + 5.0)];
  }
  // Five standard deviations of a binomial.
  for (const int count : counts) EXPECT_NEAR(count, kDraws / 10, 5 * 95);
}

TEST(Random, DrawsBothEndsOfARangeOfIntegers) {
  Random random(2);
  std::array<int, 6> counts{};
  for (int i = 0; i < 60'000; ++i) {
    const int number = random.integer(-2, 3);
    ASSERT_GE(number, -2);
    ASSERT_LE(number, 3);
    ++counts[static_cast<std::size_t>(number + 2)];
  }
  for (const int count : counts) EXPECT_NEAR(count, 10'000, 5 * 92);
}

TEST(Random, DrawsNormalNumbersOfTheMeanAndDeviationAskedFor) {
  Random random(3);
  constexpr int kDraws = 100'000;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double number = random.normal(2.0, 3.0);
    sum += number;
    squares += (number - 2.0) * (number - 2.0);
  }
  EXPECT_NEAR(sum / kDraws, 2.0, 0.05);
  EXPECT_NEAR(std::sqrt(squares / kDraws), 3.0, 0.05);
}

}  // namespace
}  // namespace prodomos::base

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/time.hpp"

#include "prodomos/base/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace prodomos::base {
namespace {

TEST(Time, PrintsAsManyDecimalsAsNeededButOne) {
  EXPECT_EQ(toString(fromNanoseconds(0)), "0.0");
  EXPECT_EQ(toString(fromNanoseconds(976'052'857'337'530'000)), "976052857.33753");
  EXPECT_EQ(toString(fromNanoseconds(1)), "0.000000001");
  EXPECT_EQ(toString(fromNanoseconds(5'000'000'000)), "5.0");
  EXPECT_EQ(toString(fromNanoseconds(-1'500'000'000)), "-1.5");
  EXPECT_EQ(toString(fromNanoseconds(-1)), "-0.000000001");
}

TEST(Time, IsReadWithoutRounding) {
  EXPECT_EQ(parseSeconds("976052857.337530"), fromNanoseconds(976'052'857'337'530'000));
  EXPECT_EQ(parseSeconds("1311868164.363181117"), fromNanoseconds(1'311'868'164'363'181'117));
  EXPECT_EQ(parseSeconds("12"), fromNanoseconds(12'000'000'000));
  EXPECT_EQ(parseSeconds("-0.25"), fromNanoseconds(-250'000'000));
  EXPECT_EQ(parseSeconds("0.000000001"), fromNanoseconds(1));
}

TEST(Time, KeepsNineDecimals) {
  EXPECT_EQ(parseSeconds("1.1234567899"), fromNanoseconds(1'123'456'789));
  EXPECT_EQ(parseSeconds("1.12345678900000000000000001"), fromNanoseconds(1'123'456'789));
}

TEST(Time, IsReadBackAsItIsPrinted) {
  Random random(2);
  for (int i = 0; i < 20'000; ++i) {
    const double magnitude = std::pow(10.0, random.uniform(0, 18.95));
    const auto time = fromNanoseconds(static_cast<std::int64_t>(random.uniform(-1, 1) * magnitude));
    ASSERT_EQ(parseSeconds(toString(time)), time) << toNanoseconds(time);
  }
}

TEST(Time, IsNotReadFromAnythingElse) {
  for (const char* text : {"", "-", ".", ".5", "-.5", "--1", "+1", " 1", "1 ", "1.5s", "1,5", "1.-5", "1.5.5", "1e9",
                           "nan", "inf", "0x10", "99999999999", "99999999999999999999999"}) {
    EXPECT_EQ(parseSeconds(text), std::nullopt) << "'" << text << "'";
  }
}

TEST(Time, SecondsAreRoundedToTheNearestNanosecond) {
  EXPECT_EQ(fromSeconds(1e-9).count(), 1);
  EXPECT_EQ(fromSeconds(0.1).count(), 100'000'000);
  EXPECT_EQ(fromSeconds(-0.1 + 4e-10).count(), -100'000'000);
  EXPECT_EQ(fromSeconds(1.4e-9).count(), 1);
  EXPECT_DOUBLE_EQ(seconds(fromSeconds(12.5)), 12.5);
}

}  // namespace
}  // namespace prodomos::base

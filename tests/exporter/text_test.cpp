// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace prodomos::exporter {
namespace {

TEST(Text, WritesNumbersWithFixedDecimals) {
  EXPECT_EQ(fixed(1.0 / 3.0, 3), "0.333");
  EXPECT_EQ(fixed(-2.0), "-2.000000");
  EXPECT_EQ(fixed(7.9, 0), "8");
}

TEST(Text, KnowsNoNegativeZero) {
  EXPECT_EQ(fixed(-0.0), "0.000000");
  EXPECT_EQ(fixed(-0.0001, 2), "0.00");
  EXPECT_EQ(brief(-0.0001, 2), "0");
}

TEST(Text, HasRoomForTheGreatestNumber) {
  EXPECT_EQ(fixed(std::numeric_limits<double>::lowest(), 9).size(), 1U + 309U + 1U + 9U);
}

TEST(Text, DropsZerosAtTheEndOfBriefNumbers) {
  EXPECT_EQ(brief(0.05), "0.05");
  EXPECT_EQ(brief(2.0), "2");
  EXPECT_EQ(brief(100.0, 0), "100");
  EXPECT_EQ(brief(1.500001, 3), "1.5");
}

TEST(Text, EscapesForXmlAndForQuotes) {
  EXPECT_EQ(xml("a<b>&\"\x01"), "a&lt;b&gt;&amp;&quot;?");
  EXPECT_EQ(inQuotes("a\"b\\c\n"), R"("a\"b\\c?")");
}

TEST(Text, TellsNamesWithoutTheirFolders) {
  EXPECT_EQ(fileName("/home/somebody/log.rawlog"), "log.rawlog");
  EXPECT_EQ(fileName("/data/tum_folder/"), "tum_folder");
  EXPECT_EQ(fileName("log.rawlog"), "log.rawlog");
  EXPECT_EQ(fileName(""), "");
}

}  // namespace
}  // namespace prodomos::exporter

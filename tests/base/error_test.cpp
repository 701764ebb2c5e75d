// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prodomos::base {
namespace {

TEST(Error, SaysPlaceExpectedAndFoundInOneLine) {
  EXPECT_EQ(expectedFound("log.rawlog:12", "a scan", "the end of the file"),
            "log.rawlog:12: expected a scan, found the end of the file");
}

TEST(Error, OfUsageHoldsAllFaultsOneALine) {
  const UsageError error(std::vector<std::string>{"first", "second"});
  EXPECT_STREQ(error.what(), "first\nsecond");
  EXPECT_THAT(error.faults(), testing::ElementsAre("first", "second"));
  EXPECT_STREQ(UsageError("only").what(), "only");
}

TEST(Error, OfEveryKindIsCaughtAsError) {
  EXPECT_THROW(throw FileError("file"), Error);
  EXPECT_THROW(throw UsageError("usage"), Error);
  EXPECT_THROW(throw Error("any"), std::runtime_error);
}

}  // namespace
}  // namespace prodomos::base

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/mapper/report.hpp"

#include <gtest/gtest.h>

namespace prodomos::mapper {
namespace {

TEST(Report, KeepsTheFirstFaultsAndCountsAll) {
  Report report;
  for (int i = 0; i < 12; ++i) report.addFault("a.rawlog: object " + std::to_string(i));
  EXPECT_EQ(report.faultCount, 12);
  ASSERT_EQ(report.faults.size(), Report::kMostFaults);
  EXPECT_EQ(report.faults.front(), "a.rawlog: object 0");
}

TEST(Report, ComesBackAsItWasSaved) {
  Report report;
  report.read = 12;
  report.used = 7;
  report.usedByKind = {{"laser_scan", 4}, {"odometry", 3}};
  report.skippedByReason = {{"unsupported CObservationGPS", 5}};
  report.notLookedAt = {{"an image without depth", 3}};
  report.refused = {{"a door without width", 1}};
  report.submaps = 2;
  report.distance = 12.5;
  report.addFault("a.rawlog: cut");
  base::ByteWriter out;
  report.save(out);

  Report again;
  again.usedByKind = {{"something else", 1}};
  again.faults = {"another"};
  base::ByteReader in(out.bytes());
  again.load(in);
  EXPECT_EQ(in.left(), 0U);
  EXPECT_EQ(again.read, report.read);
  EXPECT_EQ(again.used, report.used);
  EXPECT_EQ(again.usedByKind, report.usedByKind);
  EXPECT_EQ(again.skippedByReason, report.skippedByReason);
  EXPECT_EQ(again.notLookedAt, report.notLookedAt);
  EXPECT_EQ(again.refused, report.refused);
  EXPECT_EQ(again.faults, report.faults);
  EXPECT_EQ(again.faultCount, report.faultCount);
  EXPECT_EQ(again.submaps, report.submaps);
  EXPECT_EQ(again.distance, report.distance);
}

}  // namespace
}  // namespace prodomos::mapper

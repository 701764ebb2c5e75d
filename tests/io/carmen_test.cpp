// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/io/open_source.hpp"

#include "log.hpp"
#include "support/datasets.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prodomos::io {
namespace {

using sensors::LaserScan;
using sensors::Odometry;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kDegree = std::numbers::pi / 180.0;

Log readText(std::string_view text) {
  const test::TemporaryFolder folder;
  return readAll(*openSource(folder.write("walk.log", text)));
}

TEST(CarmenLog, GivesOdometryAndScanOfEachLine) {
  const auto log = readText(
      "# CARMEN Logfile\n"
      "PARAM robot_frontlaser_offset 0.17 1.0 host 1.0\n"
      "PARAM robot_front_laser_max 50.0 1.0 host 1.0\n"
      "ODOM 1.0 2.0 0.5 0 0 0 10.25 host 0.1\n"
      "FLASER 4 1.0 60.0 0.0 2.5 9 9 9 1.5 2.5 0.25 10.5 host 0.2\n"
      "RLASER 3 1.0 2.0 3.0 9 9 9 1.5 2.5 0.25 10.75 host 0.2\n");
  EXPECT_EQ(log.end.fault, "");
  EXPECT_THAT(log.skipped, IsEmpty());
  ASSERT_THAT(log.readings, SizeIs(5));
  EXPECT_EQ(log.readings[0].sensor, "ODOM");
  EXPECT_EQ(base::toString(log.readings[0].time), "10.25");
  EXPECT_TRUE(as<Odometry>(log.readings[0]).T_odom_body.isApprox(geometry::toPose3({1.0, 2.0, 0.5})));
  EXPECT_EQ(log.readings[1].sensor, "FLASER");
  EXPECT_EQ(base::toString(log.readings[1].time), "10.5");
  EXPECT_TRUE(as<Odometry>(log.readings[1]).T_odom_body.isApprox(geometry::toPose3({1.5, 2.5, 0.25})));
  const auto& scan = as<LaserScan>(log.readings[2]);
  EXPECT_EQ(log.readings[2].sensor, "FLASER");
  EXPECT_TRUE(scan.T_body_sensor.isApprox(geometry::toPose3({0.17, 0.0, 0.0})));
  EXPECT_EQ(scan.maxRange, 50.0);
  EXPECT_EQ(scan.ranges, (std::vector<float>{1.0F, LaserScan::kNoReturn, LaserScan::kInvalid, 2.5F}));
  EXPECT_NEAR(scan.firstAngle, -90.0 * kDegree, 1e-12);
  EXPECT_NEAR(scan.angleStep, 60.0 * kDegree, 1e-12);
  const auto& rear = as<LaserScan>(log.readings[4]);
  EXPECT_NEAR(std::abs(geometry::yaw(rear.T_body_sensor)), std::numbers::pi, 1e-12);
  EXPECT_NEAR(rear.angleStep, 90.0 * kDegree, 1e-12);
}

TEST(CarmenLog, ReadsTheNewerLaserMessage) {
  const auto log = readText(
      "ROBOTLASER1 0 -1.5 3.0 1.0 30.0 0.01 0 4 1 2 3 40 1 7 1.2 2.0 0 1.0 2.0 0 0 0 0.1 0.1 0 5.5 host 5.6\n");
  ASSERT_THAT(log.readings, SizeIs(2));
  EXPECT_EQ(base::toString(log.readings[0].time), "5.5");
  EXPECT_TRUE(as<Odometry>(log.readings[0]).T_odom_body.isApprox(geometry::toPose3({1.0, 2.0, 0.0})));
  const auto& scan = as<LaserScan>(log.readings[1]);
  EXPECT_EQ(scan.firstAngle, -1.5);
  EXPECT_EQ(scan.angleStep, 1.0);
  EXPECT_EQ(scan.ranges, (std::vector<float>{1.0F, 2.0F, 3.0F, LaserScan::kNoReturn}));
  EXPECT_TRUE(scan.T_body_sensor.isApprox(geometry::toPose3({0.2, 0.0, 0.0})));
}

TEST(CarmenLog, NamesTheLineOfAMalformedMessage) {
  const auto log = readText(
      "ODOM 1 2 0 0 0 0 1.0 host 1\n"
      "FLASER 3 1.0 2.0\n"
      "ODOM 1 nonsense 0 0 0 0 2.0 host 1\n"
      "FLASER 2 1.0 x 0 0 0 0 0 0 3.0 host 1\n"
      "GARBAGE 1 2 3\n"
      "TRUEPOS 1 2 3 4 5 6 4.0 host 1\n"
      "ODOM 1 2 0 0 0 0 5.0 host 1\n");
  EXPECT_THAT(log.readings, SizeIs(2));
  ASSERT_THAT(log.skipped, SizeIs(5));
  EXPECT_EQ(log.skipped[0].reason, "malformed FLASER");
  EXPECT_THAT(log.skipped[0].fault, HasSubstr("walk.log:2: expected "));
  EXPECT_THAT(log.skipped[0].fault, HasSubstr("found `FLASER 3 1.0 2.0`"));
  EXPECT_THAT(log.skipped[1].fault, HasSubstr("walk.log:3: expected `ODOM x y theta"));
  EXPECT_THAT(log.skipped[2].fault, HasSubstr("walk.log:4: expected a range in metres as field 4"));
  EXPECT_THAT(log.skipped[3].fault, HasSubstr("walk.log:5: expected a CARMEN message"));
  EXPECT_EQ(log.skipped[4].reason, "unsupported TRUEPOS");
  EXPECT_EQ(log.skipped[4].fault, "");
}

TEST(CarmenLog, UsesAScanWithoutItsBadRanges) {
  const auto log = readText("FLASER 4 1.0 nan -2.0 inf 0 0 0 0 0 0 3.0 host 1\n");
  ASSERT_THAT(log.readings, SizeIs(2));
  EXPECT_EQ(as<LaserScan>(log.readings[1]).ranges,
            (std::vector<float>{1.0F, LaserScan::kInvalid, LaserScan::kInvalid, LaserScan::kNoReturn}));
  EXPECT_THAT(log.readings[1].fault, HasSubstr("walk.log:1: expected ranges of zero or more, found 2 other of 4"));
}

TEST(CarmenLog, AgreesWithTheRawlogOfTheSameWalk) {
  const auto carmen = test::dataset("laser/fr079.clf.bz2");
  const auto rawlog = test::dataset("laser/fr079.rawlog");
  if (!carmen || !rawlog) GTEST_SKIP() << "needs laser/fr079.clf.bz2 and laser/fr079.rawlog";
  const auto source = openSource(*carmen);
  EXPECT_EQ(source->info().kind, "CARMEN log");
  const auto a = readAll(*source);
  const auto b = readAll(*openSource(*rawlog));
  EXPECT_THAT(a.skipped, IsEmpty());
  EXPECT_THAT(a.of<Odometry>(), SizeIs(4934 + 8951));
  const auto scansA = a.of<LaserScan>();
  const auto scansB = b.of<LaserScan>();
  ASSERT_THAT(scansA, SizeIs(4934));
  ASSERT_THAT(scansB, SizeIs(4934));
  for (std::size_t i = 0; i < scansA.size(); ++i) {
    const auto& scanA = as<LaserScan>(scansA[i]);
    const auto& scanB = as<LaserScan>(scansB[i]);
    ASSERT_LT(std::abs(base::seconds(scansA[i].time - scansB[i].time)), 1e-5) << i;
    ASSERT_EQ(scanA.ranges, scanB.ranges) << i;
    ASSERT_NEAR(scanA.firstAngle, scanB.firstAngle, 1e-6);
    ASSERT_NEAR(scanA.angleStep * 359.0, scanB.angleStep * 359.0, 1e-6);
    ASSERT_TRUE(scanA.T_body_sensor.isApprox(scanB.T_body_sensor, 1e-5));
  }
}

}  // namespace
}  // namespace prodomos::io

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/io/open_source.hpp"

#include "log.hpp"
#include "support/datasets.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prodomos::io {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

struct Counts {
  const char* log;
  std::size_t scans;
  std::size_t odometry;
  std::size_t beams;
};

class RealRawlog : public testing::TestWithParam<Counts> {};

TEST_P(RealRawlog, GivesEveryScanAndEveryOdometry) {
  const auto path = test::dataset(GetParam().log);
  if (!path) GTEST_SKIP() << "needs " << GetParam().log;
  const auto source = openSource(*path);
  EXPECT_EQ(source->info().kind, "MRPT rawlog");
  const auto log = readAll(*source);
  EXPECT_EQ(log.end.fault, "");
  EXPECT_THAT(log.skipped, IsEmpty());
  EXPECT_THAT(log.of<sensors::Odometry>(), SizeIs(GetParam().odometry));
  const auto scans = log.of<sensors::LaserScan>();
  ASSERT_THAT(scans, SizeIs(GetParam().scans));
  for (const auto& scan : scans) EXPECT_THAT(as<sensors::LaserScan>(scan).ranges, SizeIs(GetParam().beams));
  EXPECT_EQ(source->progress().done, source->progress().total);
}

INSTANTIATE_TEST_SUITE_P(Laser, RealRawlog,
                         testing::Values(Counts{"laser/intel.rawlog", 13631, 13631, 180},
                                         Counts{"laser/fr079.rawlog", 4934, 4934, 360},
                                         Counts{"laser/mit-csail.rawlog", 1988, 1988, 361},
                                         Counts{"laser/ual_2014.rawlog", 3318, 15351, 361},
                                         Counts{"laser/driving_in_office_obs.rawlog", 1159, 1161, 626},
                                         Counts{"laser/driving_in_office.rawlog", 1159, 1161, 626},
                                         Counts{"laser/sena_loop.rawlog", 225, 224, 361}));

TEST(RawlogReader, ReadsBothFlavoursOfTheSameDriveAlike) {
  const auto actions = test::dataset("laser/driving_in_office.rawlog");
  const auto observations = test::dataset("laser/driving_in_office_obs.rawlog");
  if (!actions || !observations) GTEST_SKIP() << "needs laser/driving_in_office*.rawlog";
  const auto a = readAll(*openSource(*actions));
  const auto b = readAll(*openSource(*observations));
  const auto scansA = a.of<sensors::LaserScan>();
  const auto scansB = b.of<sensors::LaserScan>();
  ASSERT_EQ(scansA.size(), scansB.size());
  for (std::size_t i = 0; i < scansA.size(); ++i) {
    ASSERT_EQ(scansA[i].time, scansB[i].time);
    ASSERT_EQ(as<sensors::LaserScan>(scansA[i]).ranges, as<sensors::LaserScan>(scansB[i]).ranges);
  }
  const auto odometryA = a.of<sensors::Odometry>();
  const auto odometryB = b.of<sensors::Odometry>();
  ASSERT_EQ(odometryA.size(), odometryB.size());
  for (std::size_t i = 0; i < odometryA.size(); ++i) {
    ASSERT_EQ(odometryA[i].time, odometryB[i].time);
    const auto& T_odom_body = as<sensors::Odometry>(odometryB[i]).T_odom_body;
    ASSERT_TRUE(as<sensors::Odometry>(odometryA[i]).T_odom_body.isApprox(T_odom_body, 1e-6)) << i;
  }
}

TEST(RawlogReader, KnowsAngleAndRangeOfEachBeam) {
  const auto path = test::dataset("laser/intel.rawlog");
  if (!path) GTEST_SKIP() << "needs laser/intel.rawlog";
  const auto log = readAll(*openSource(*path));
  const auto first = log.of<sensors::LaserScan>().front();
  const auto& scan = as<sensors::LaserScan>(first);
  EXPECT_NEAR(scan.firstAngle, -std::numbers::pi / 2.0, 1e-6);
  EXPECT_NEAR(scan.firstAngle + 179.0 * scan.angleStep, std::numbers::pi / 2.0, 1e-6);
  EXPECT_GT(scan.maxRange, 10.0);
  for (const float range : scan.ranges) {
    EXPECT_TRUE((range > 0.0F && range < scan.maxRange) || range == sensors::LaserScan::kNoReturn ||
                range == sensors::LaserScan::kInvalid);
  }
  EXPECT_EQ(first.sensor, "FLASER");
}

TEST(RawlogReader, GivesTheSameItemsAfterASkip) {
  const auto path = test::dataset("laser/driving_in_office.rawlog");
  if (!path) GTEST_SKIP() << "needs laser/driving_in_office.rawlog";
  const auto whole = readAll(*openSource(*path));
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{1001}}) {
    const auto source = openSource(*path);
    source->skip(count);
    const auto rest = readAll(*source);
    ASSERT_EQ(rest.readings.size(), whole.readings.size() - count);
    for (std::size_t i = 0; i < rest.readings.size(); ++i) {
      const auto& expected = whole.readings[i + count];
      EXPECT_EQ(rest.readings[i].time, expected.time);
      ASSERT_EQ(rest.readings[i].data.index(), expected.data.index());
      if (const auto* odometry = std::get_if<sensors::Odometry>(&expected.data)) {
        EXPECT_EQ(as<sensors::Odometry>(rest.readings[i]).T_odom_body.matrix(), odometry->T_odom_body.matrix());
      }
    }
  }
}

TEST(RawlogReader, ReadsADepthCamera) {
  const auto path = test::dataset("rgbd/single_frame.rawlog");
  if (!path) GTEST_SKIP() << "needs rgbd/single_frame.rawlog";
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  const auto log = readAll(*openSource(*path));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  ASSERT_THAT(log.readings, SizeIs(1));
  EXPECT_EQ(log.readings[0].sensor, "OPENNI2");
  const auto& frame = as<sensors::RgbdFrame>(log.readings[0]);
  EXPECT_EQ(frame.depth.width(), 640);
  EXPECT_EQ(frame.depth.height(), 480);
  EXPECT_EQ(frame.color.width(), 640);
  EXPECT_GT(frame.camera.fx, 300.0);
  const auto pixels = frame.depth.pixels();
  const auto known = std::ranges::count_if(pixels, [](float z) { return z > 0.3F && z < 12.0F; });
  EXPECT_GT(known, 640 * 480 / 4);
  for (const float z : pixels) EXPECT_GE(z, 0.0F);
}

}  // namespace
}  // namespace prodomos::io

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/io/rawlog_sink.hpp"

#include "prodomos/io/open_source.hpp"

#include "log.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <future>
#include <iostream>
#include <limits>

namespace prodomos::io {
namespace {

using sensors::LaserScan;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kPi = 3.14159265358979;

base::Time at(double seconds) {
  return base::Time(base::fromSeconds(seconds));
}

geometry::Pose3 movedAndRotated() {
  return geometry::fromYawPitchRoll({0.3, -0.1, 0.8}, 0.5, -0.2, 0.1);
}

LaserScan fan(std::vector<float> ranges) {
  LaserScan scan;
  scan.T_body_sensor = movedAndRotated();
  scan.firstAngle = -0.5;
  scan.angleStep = ranges.size() > 1 ? 1.0 / static_cast<double>(ranges.size() - 1) : 0.0;
  scan.maxRange = 20.0;
  scan.ranges = std::move(ranges);
  return scan;
}

class RoundTrip : public testing::TestWithParam<RawlogFlavour> {
 protected:
  Log through(const std::vector<sensors::Reading>& readings, const sensors::ClassTable& classes = {}) {
    const auto path = folder_.path() / "log.rawlog";
    const auto sink = createRawlog(path, GetParam(), classes);
    for (const auto& reading : readings) sink->write(reading);
    sink->close();
    const auto source = openSource(path);
    classes_ = source->info().classes;
    hasRecordedPoses_ = source->info().hasRecordedPoses;
    auto log = readAll(*source);
    EXPECT_EQ(log.end.fault, "");
    return log;
  }

  test::TemporaryFolder folder_;
  sensors::ClassTable classes_;
  bool hasRecordedPoses_ = false;
};

/// Where beam i of a scan points and ends, seen from the body.
Eigen::Vector3d direction(const LaserScan& scan, std::size_t beam) {
  const double angle = scan.firstAngle + static_cast<double>(beam) * scan.angleStep;
  return scan.T_body_sensor.linear() * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
}

void expectSameFan(const LaserScan& a, const LaserScan& b) {
  ASSERT_EQ(a.ranges.size(), b.ranges.size());
  EXPECT_LT((a.T_body_sensor.translation() - b.T_body_sensor.translation()).norm(), 1e-9);
  for (std::size_t i = 0; i < a.ranges.size(); ++i) {
    EXPECT_LT((direction(a, i) - direction(b, i)).norm(), 1e-6) << "beam " << i;
  }
}

TEST_P(RoundTrip, KeepsScans) {
  const std::vector<float> ranges = {1.0F, 2.5F, LaserScan::kNoReturn, 0.017F, LaserScan::kInvalid, 19.99F};
  const auto scan = fan(ranges);
  const auto log = through({{at(1.5), "front", scan}});
  ASSERT_THAT(log.readings, SizeIs(1));
  EXPECT_EQ(log.readings[0].sensor, "front");
  EXPECT_EQ(log.readings[0].time, at(1.5));
  EXPECT_EQ(log.readings[0].fault, "");
  const auto& back = as<LaserScan>(log.readings[0]);
  EXPECT_EQ(back.ranges, ranges);
  EXPECT_EQ(back.maxRange, 20.0);
  expectSameFan(back, scan);
}

TEST_P(RoundTrip, KeepsFansThatAreNotSymmetricOrRunClockwise) {
  auto lopsided = fan({1.0F, 2.0F, 3.0F});
  lopsided.firstAngle = -kPi / 2.0;
  auto clockwise = fan({1.0F, 2.0F, 3.0F});
  clockwise.firstAngle = 0.5;
  clockwise.angleStep = -0.5;
  const auto log = through({{at(1), "a", lopsided}, {at(2), "b", clockwise}});
  ASSERT_THAT(log.readings, SizeIs(2));
  expectSameFan(as<LaserScan>(log.readings[0]), lopsided);
  expectSameFan(as<LaserScan>(log.readings[1]), clockwise);
}

TEST_P(RoundTrip, KeepsScansOfOneBeamAndOfNone) {
  const auto log = through({{at(1), "a", fan({3.0F})}, {at(2), "b", fan({})}});
  ASSERT_THAT(log.readings, SizeIs(2));
  EXPECT_EQ(as<LaserScan>(log.readings[0]).ranges, std::vector<float>{3.0F});
  EXPECT_THAT(as<LaserScan>(log.readings[1]).ranges, IsEmpty());
}

TEST_P(RoundTrip, MakesBadRangesInvalidAndSaysSo) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const auto log = through({{at(1), "a", fan({1.0F, kNaN, -3.0F, 2.0F})}});
  ASSERT_THAT(log.readings, SizeIs(1));
  EXPECT_EQ(as<LaserScan>(log.readings[0]).ranges,
            (std::vector<float>{1.0F, LaserScan::kInvalid, LaserScan::kInvalid, 2.0F}));
  EXPECT_THAT(log.readings[0].fault, HasSubstr("log.rawlog: object 0: expected ranges of zero or more, found 2"));
  EXPECT_THAT(log.readings[0].fault, HasSubstr("beam 1 is NaN"));
}

TEST_P(RoundTrip, KeepsStampsToTheTickOfMrpt) {
  for (const std::int64_t nanoseconds : {0L, 100L, 976052857337530000L, 1700000000123456700L}) {
    const auto time = base::fromNanoseconds(nanoseconds);
    const auto log = through({{time, "a", fan({1.0F})}});
    ASSERT_THAT(log.readings, SizeIs(1));
    EXPECT_EQ(base::toNanoseconds(log.readings[0].time), nanoseconds);
  }
}

TEST_P(RoundTrip, KeepsOdometryInItsPlaceBetweenTheScans) {
  std::vector<sensors::Reading> readings;
  for (int i = 0; i < 50; ++i) {
    const geometry::Pose2 pose = {576.0 + 0.1 * i, std::sin(0.2 * i), geometry::normalizeAngle(0.3 * i)};
    readings.push_back({at(i), "odometry", sensors::Odometry{geometry::toPose3(pose)}});
    if (i % 3 != 0) readings.push_back({at(i + 0.01), "laser", fan({1.0F, 2.0F})});
  }
  const auto log = through(readings);
  ASSERT_EQ(log.readings.size(), readings.size());
  for (std::size_t i = 0; i < readings.size(); ++i) {
    EXPECT_EQ(log.readings[i].time, readings[i].time);
    ASSERT_EQ(log.readings[i].data.index(), readings[i].data.index());
    if (const auto* odometry = std::get_if<sensors::Odometry>(&readings[i].data)) {
      EXPECT_TRUE(as<sensors::Odometry>(log.readings[i]).T_odom_body.isApprox(odometry->T_odom_body, 1e-9));
    }
  }
}

TEST_P(RoundTrip, KeepsDepthColourAndLabels) {
  sensors::RgbdFrame frame;
  frame.T_body_camera = movedAndRotated() * sensors::cameraAxesInBody();
  frame.camera = {500.0, 501.0, 3.5, 2.5, {0.1, -0.2, 0.001, 0.002, 0.03}};
  frame.depth = sensors::Image<float>(8, 6, 1.5F);
  frame.depth(2, 3) = 0.0F;
  frame.color = sensors::Image<sensors::Rgb>(8, 6, {10, 20, 30});
  frame.color(7, 5) = {255, 0, 128};
  frame.labels = sensors::LabelImage{sensors::Image<std::uint16_t>(8, 6, 1), {}, {}};
  frame.labels->classes(0, 0) = 0;
  frame.labels->classes(1, 0) = 64;
  const auto log = through({{at(1), "kinect", frame}}, {{1, "floor"}, {64, "door"}});
  ASSERT_THAT(log.readings, SizeIs(1));
  const auto& back = as<sensors::RgbdFrame>(log.readings[0]);
  EXPECT_TRUE(back.T_body_camera.isApprox(frame.T_body_camera, 1e-9));
  EXPECT_EQ(back.camera, frame.camera);
  EXPECT_THAT(std::vector<float>(back.depth.pixels().begin(), back.depth.pixels().end()),
              testing::Pointwise(testing::FloatNear(0.0005F), frame.depth.pixels()));
  EXPECT_TRUE(std::ranges::equal(back.color.pixels(), frame.color.pixels()));
  ASSERT_TRUE(back.labels);
  EXPECT_TRUE(std::ranges::equal(back.labels->classes.pixels(), frame.labels->classes.pixels()));
  EXPECT_EQ(classes_, (sensors::ClassTable{{0, "unlabeled"}, {1, "floor"}, {64, "door"}}));
}

TEST_P(RoundTrip, KeepsColourWithoutDepth) {
  sensors::RgbdFrame frame;
  frame.T_body_camera = movedAndRotated();
  frame.camera = {500.0, 501.0, 3.5, 2.5, {}};
  frame.color = sensors::Image<sensors::Rgb>(8, 6, {10, 20, 30});
  const auto log = through({{at(1), "camera", frame}});
  ASSERT_THAT(log.readings, SizeIs(1));
  const auto& back = as<sensors::RgbdFrame>(log.readings[0]);
  EXPECT_TRUE(back.depth.empty());
  EXPECT_EQ(back.color.width(), 8);
  EXPECT_EQ(back.camera, frame.camera);
  EXPECT_TRUE(back.T_body_camera.isApprox(frame.T_body_camera, 1e-9));
}

TEST_P(RoundTrip, KeepsPointsWithColourOrIntensity) {
  sensors::PointCloud plain;
  plain.T_body_sensor = movedAndRotated();
  plain.points_in_sensor = {{1, 2, 3}, {-4, 5, 6}};
  auto colored = plain;
  colored.color = {{0, 1, 255}, {128, 64, 32}};
  auto intense = plain;
  intense.intensity = {0.25F, 1.0F};
  const auto log = through({{at(1), "a", plain}, {at(2), "b", colored}, {at(3), "c", intense}});
  ASSERT_THAT(log.readings, SizeIs(3));
  for (const auto& reading : log.readings) {
    EXPECT_EQ(as<sensors::PointCloud>(reading).points_in_sensor, plain.points_in_sensor);
    EXPECT_TRUE(as<sensors::PointCloud>(reading).T_body_sensor.isApprox(plain.T_body_sensor, 1e-9));
  }
  EXPECT_EQ(as<sensors::PointCloud>(log.readings[1]).color, colored.color);
  EXPECT_EQ(as<sensors::PointCloud>(log.readings[2]).intensity, intense.intensity);
}

TEST_P(RoundTrip, KeepsRecordedPoses) {
  const auto log = through({{at(1), "mocap", sensors::RecordedPose{movedAndRotated()}}});
  ASSERT_THAT(log.readings, SizeIs(1));
  EXPECT_TRUE(as<sensors::RecordedPose>(log.readings[0]).T_world_body.isApprox(movedAndRotated(), 1e-9));
  EXPECT_TRUE(hasRecordedPoses_);
}

TEST_P(RoundTrip, RefusesWhatMrptHasNoClassFor) {
  const auto sink = createRawlog(folder_.path() / "log.rawlog", GetParam());
  const auto write = [&](const sensors::ReadingData& data) {
    return errorOf<base::Error>([&] { sink->write({at(1), "a", data}); });
  };
  EXPECT_THAT(write(sensors::Detections{}), HasSubstr("found detections"));
  EXPECT_THAT(write(sensors::KeyPoints{}), HasSubstr("found key_points"));
  EXPECT_THAT(write(sensors::Odometry{movedAndRotated()}), HasSubstr("odometry in the plane"));
}

INSTANTIATE_TEST_SUITE_P(Flavours, RoundTrip,
                         testing::Values(RawlogFlavour::kObservations, RawlogFlavour::kActionsAndSensoryFrames),
                         [](const auto& info) {
                           return info.param == RawlogFlavour::kObservations ? "Observations" : "ActionsAndFrames";
                         });

TEST(RawlogSink, SaysWhereItCannotWrite) {
  EXPECT_THAT(errorOf([] { createRawlog("/nowhere/log.rawlog"); }), HasSubstr("/nowhere/log.rawlog: expected a file"));
}

TEST(RawlogSink, SaysThatTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  const auto sink = createRawlog("/dev/full");
  EXPECT_THAT(errorOf([&] {
                sink->write({at(1), "a", fan({1.0F})});
                sink->close();
              }),
              HasSubstr("/dev/full: expected a file that can be written, found No space left"));
}

/// A simulation writes its log in one thread, and its progress in another.
TEST(RawlogSink, LeavesStandardErrorAlone) {
  const test::TemporaryFolder folder;
  auto* const before = std::cerr.rdbuf();
  auto writing = std::async(std::launch::async, [&folder] {
    const auto sink = createRawlog(folder.path() / "log.rawlog");
    for (int i = 0; i < 300; ++i) sink->write({at(i), "a", fan({1.0F, 2.0F})});
    sink->close();
  });
  while (writing.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    ASSERT_EQ(std::cerr.rdbuf(), before);
  }
  writing.get();
}

}  // namespace
}  // namespace prodomos::io

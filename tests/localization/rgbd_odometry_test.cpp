// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/rgbd_odometry.hpp"

#include "localization/box_room.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace prodomos::localization {
namespace {

using geometry::Pose3;
using test::BoxRoom;
using Estimate = RgbdOdometry::Estimate;

constexpr double kDegree = std::numbers::pi / 180.0;

base::Time at(int frame) {
  return base::Time(base::fromSeconds(0.1 * frame));
}

/// A hand-held walk: forward and sideways, looking about.
Pose3 walk(int i, double heading = 0.0) {
  const double t = 0.1 * i;
  return geometry::fromYawPitchRoll({1.2 + 0.25 * t, 1.8 + 0.3 * std::sin(t), 1.3 + 0.05 * std::sin(2.0 * t)},
                                    heading + 0.3 * std::sin(0.8 * t), 0.3 + 0.1 * std::sin(t),
                                    0.1 * std::sin(1.3 * t));
}

/// How far the estimated motion since the first frame is off.
struct Error {
  double meters;
  double degrees;
};
Error errorOf(const Pose3& T_world_first, const Pose3& T_world_now, const Pose3& trueFirst, const Pose3& trueNow) {
  const Pose3 off = (trueFirst.inverse() * trueNow).inverse() * (T_world_first.inverse() * T_world_now);
  return {off.translation().norm(), geometry::rotationAngle(off) / kDegree};
}

/// Tracks `count` frames of a walk and expects each near the truth.
void expectFollows(const BoxRoom& room, double heading, int count, double meters, double degrees,
                   bool withColor = true) {
  RgbdOdometry odometry;
  Pose3 T_world_first;
  for (int i = 0; i < count; ++i) {
    auto frame = room.see(walk(i, heading));
    if (!withColor) frame.color = {};
    const auto estimate = odometry.track(at(i), frame);
    if (estimate.T_world_before) T_world_first = *estimate.T_world_before * T_world_first;
    if (i == 0) T_world_first = estimate.T_world_body;
    const auto error = errorOf(T_world_first, estimate.T_world_body, walk(0, heading), walk(i, heading));
    EXPECT_FALSE(estimate.isLost) << "frame " << i;
    EXPECT_LT(error.meters, meters) << "frame " << i;
    EXPECT_LT(error.degrees, degrees) << "frame " << i;
  }
}

bool bitEqual(const Estimate& a, const Estimate& b) {
  return a.T_world_body.matrix() == b.T_world_body.matrix() && a.covariance == b.covariance && a.isLost == b.isLost &&
         a.isLevelled == b.isLevelled;
}

double sigmaAlong(const map::Matrix6& covariance, int axis) {
  return std::sqrt(covariance(axis, axis));
}

TEST(RgbdOdometry, FollowsAWalkThroughATexturedRoomFromWhateverHeading) {
  for (const double heading : {0.0, 1.9, -2.4}) expectFollows(BoxRoom::furnished(), heading, 25, 0.02, 0.5);
}

TEST(RgbdOdometry, FollowsByStructureAloneWhereNothingHasTexture) {
  expectFollows(BoxRoom::furnished(BoxRoom::Texture::kBlank), 0.0, 25, 0.03, 0.7);
}

TEST(RgbdOdometry, FollowsWithoutColour) {
  expectFollows(BoxRoom::furnished(), 0.0, 15, 0.03, 0.7, false);
}

TEST(RgbdOdometry, TheFloorTellsUpAndHeight) {
  const Pose3 truth = geometry::fromYawPitchRoll({1.2, 1.8, 1.35}, 0.7, 0.35, 0.15);
  RgbdOdometry odometry;
  const auto estimate = odometry.track(at(0), BoxRoom::furnished().see(truth));
  EXPECT_TRUE(estimate.isLevelled);
  const Pose3 expected = geometry::fromYawPitchRoll({0.0, 0.0, 1.35}, 0.0, 0.35, 0.15);
  EXPECT_NEAR(estimate.T_world_body.translation().norm(), 1.35, 0.02);
  EXPECT_LT(geometry::rotationAngle(expected.inverse() * estimate.T_world_body), 0.5 * kDegree);
}

TEST(RgbdOdometry, WithoutAFloorTheCameraIsTakenAsLevelAndItIsSaid) {
  const BoxRoom high({6.0, 5.0, 8.0}, {}, BoxRoom::Texture::kSpeckled);
  RgbdOdometryConfig config;
  RgbdOdometry odometry(config);
  const auto estimate = odometry.track(at(0), high.see(geometry::fromYawPitchRoll({3.0, 2.5, 5.0}, 0.0, 0.0, 0.0)));
  EXPECT_FALSE(estimate.isLevelled);
  EXPECT_FALSE(estimate.isLost);
  EXPECT_NEAR(estimate.T_world_body.translation().z(), config.assumedHeight, 1e-9);
}

TEST(RgbdOdometry, AFloorSeenLaterLevelsTheWorldAndSaysHowItMoved) {
  const BoxRoom room = BoxRoom::furnished();
  const auto pose = [](int i) {  // looks up first, then down
    return geometry::fromYawPitchRoll({1.2, 2.0, 1.4}, 0.1, -0.5 + 0.08 * i, 0.1);
  };
  RgbdOdometry odometry;
  Pose3 T_world_first;
  bool wasLevelled = false;
  for (int i = 0; i < 14; ++i) {
    const auto estimate = odometry.track(at(i), room.see(pose(i)));
    if (i == 0) {
      EXPECT_FALSE(estimate.isLevelled);
      T_world_first = estimate.T_world_body;
    }
    EXPECT_EQ(estimate.isLevelled && !wasLevelled, estimate.T_world_before.has_value() && !wasLevelled);
    wasLevelled = estimate.isLevelled;
    if (estimate.T_world_before) T_world_first = *estimate.T_world_before * T_world_first;
    const auto error = errorOf(T_world_first, estimate.T_world_body, pose(0), pose(i));
    EXPECT_LT(error.meters, 0.02);
    EXPECT_LT(error.degrees, 0.5);
  }
  EXPECT_TRUE(wasLevelled);
  EXPECT_NEAR(T_world_first.translation().z(), 1.4, 0.03);
  EXPECT_NEAR(T_world_first.linear()(2, 2), std::cos(0.5) * std::cos(0.1), 0.01);
}

TEST(RgbdOdometry, ATurnOnTheSpotEndsWhereItBegan) {
  const BoxRoom room = BoxRoom::furnished();
  const auto pose = [](int i) { return geometry::fromYawPitchRoll({2.5, 2.2, 1.3}, i * 10.0 * kDegree, 0.25, 0.0); };
  RgbdOdometry odometry;
  Pose3 T_world_first;
  Estimate last;
  for (int i = 0; i <= 36; ++i) {
    last = odometry.track(at(i), room.see(pose(i)));
    if (i == 0) T_world_first = last.T_world_body;
    if (last.T_world_before) T_world_first = *last.T_world_before * T_world_first;
    EXPECT_FALSE(last.isLost) << "frame " << i;
  }
  const auto error = errorOf(T_world_first, last.T_world_body, pose(0), pose(36));
  EXPECT_LT(error.meters, 0.01);
  EXPECT_LT(error.degrees, 0.3);
}

TEST(RgbdOdometry, AWallWithoutTextureLeavesTheWaysAlongItOpen) {
  const BoxRoom wall({40.0, 40.0, 40.0}, {}, BoxRoom::Texture::kBlank);
  RgbdOdometry odometry;
  const Pose3 pose = geometry::fromYawPitchRoll({38.0, 20.0, 20.0}, 0.0, 0.0, 0.0);
  odometry.track(at(0), wall.see(pose));
  const auto estimate = odometry.track(at(1), wall.see(pose));
  EXPECT_LT(sigmaAlong(estimate.covariance, 0), 0.01);  // towards it
  EXPECT_GT(sigmaAlong(estimate.covariance, 1), 0.05);  // along it
  EXPECT_GT(sigmaAlong(estimate.covariance, 2), 0.05);
  EXPECT_GT(sigmaAlong(estimate.covariance, 3), 0.05);  // about its normal
  EXPECT_LT(sigmaAlong(estimate.covariance, 4), 0.01);
  EXPECT_LT(sigmaAlong(estimate.covariance, 5), 0.01);
}

TEST(RgbdOdometry, WhatMovesDoesNotDragThePoseOnceItIsMasked) {
  BoxRoom room = BoxRoom::furnished();
  room.boxes().push_back({});
  const Pose3 pose = walk(0);
  RgbdOdometry odometry;
  Pose3 T_world_first;
  for (int i = 0; i < 10; ++i) {
    const double y = 1.2 + 0.05 * i;  // walks by, and fills a third of the image
    room.boxes().back() = {{2.2, y, 0.0}, {2.6, y + 0.7, 1.8}};
    const auto frame = room.see(pose);
    sensors::Mask movers(frame.depth.width(), frame.depth.height(), 0);
    BoxRoom still = room;
    still.boxes().pop_back();
    const auto background = still.see(pose);
    for (int v = 0; v < movers.height(); ++v) {
      for (int u = 0; u < movers.width(); ++u) {
        movers(u, v) = frame.depth(u, v) < background.depth(u, v) - 0.01F ? 1 : 0;
      }
    }
    const auto estimate = odometry.track(at(i), frame, &movers);
    if (i == 0) T_world_first = estimate.T_world_body;
    if (estimate.T_world_before) T_world_first = *estimate.T_world_before * T_world_first;
    EXPECT_FALSE(estimate.isLost);
    EXPECT_LT(errorOf(T_world_first, estimate.T_world_body, pose, pose).meters, 0.005);
  }
}

TEST(RgbdOdometry, GoesOnBitByBitAfterSaveAndLoad) {
  const BoxRoom room = BoxRoom::furnished();
  RgbdOdometry whole;
  RgbdOdometry resumed;
  for (int i = 0; i < 16; ++i) {
    const auto frame = i == 6 ? sensors::RgbdFrame{} : room.see(walk(i));
    const auto expected = whole.track(at(i), frame);
    if (i >= 8 || i == 7) {
      EXPECT_TRUE(bitEqual(expected, resumed.track(at(i), frame))) << "frame " << i;
    }
    if (i == 6 || i == 11) {  // once in the middle of being lost
      base::ByteWriter out;
      whole.save(out);
      resumed = RgbdOdometry();
      base::ByteReader in(out.bytes());
      resumed.load(in);
      EXPECT_EQ(in.left(), 0U);
      base::ByteWriter again;
      resumed.save(again);
      EXPECT_EQ(out.bytes(), again.bytes());
    }
  }
}

TEST(RgbdOdometry, ACutStateIsAnError) {
  RgbdOdometry odometry;
  odometry.track(at(0), BoxRoom::furnished().see(walk(0)));
  base::ByteWriter out;
  odometry.save(out);
  const auto bytes = out.bytes();
  for (const std::size_t size : {std::size_t{0}, std::size_t{20}, bytes.size() / 2, bytes.size() - 1}) {
    RgbdOdometry other;
    base::ByteReader in(std::span<const std::byte>(bytes).first(size));
    EXPECT_THROW(other.load(in), base::Error) << size;
  }
}

std::vector<sensors::RgbdFrame> badFrames(const sensors::RgbdFrame& good) {
  std::vector<sensors::RgbdFrame> bad(7, good);
  bad[0] = {};
  bad[1].depth = sensors::Image<float>(320, 240, 0.0F);
  bad[1].color = sensors::Image<sensors::Rgb>(320, 240);
  bad[2].depth = sensors::Image<float>(320, 240, std::numeric_limits<float>::quiet_NaN());
  bad[2].color = {};
  bad[3].depth = sensors::Image<float>(100, 100, 2.0F);
  bad[4].camera.fx = 0.0;
  bad[5].camera.cx = std::numeric_limits<double>::quiet_NaN();
  bad[6].T_body_camera.translation().x() = std::numeric_limits<double>::infinity();
  return bad;
}

TEST(RgbdOdometry, ABadFrameIsLostAndTheNextGoodOneIsFoundAgain) {
  const BoxRoom room = BoxRoom::furnished();
  for (const auto& bad : badFrames(room.see(walk(5)))) {
    RgbdOdometry odometry;
    Pose3 T_world_first;
    for (int i = 0; i < 8; ++i) {
      const auto estimate = odometry.track(at(i), i == 5 ? bad : room.see(walk(i)));
      if (i == 0) T_world_first = estimate.T_world_body;
      if (estimate.T_world_before) T_world_first = *estimate.T_world_before * T_world_first;
      EXPECT_EQ(estimate.isLost, i == 5) << i;
      EXPECT_TRUE(geometry::isFinite(estimate.T_world_body));
      EXPECT_GT(sigmaAlong(estimate.covariance, 0), i == 5 ? 0.05 : 0.0);
      const auto error = errorOf(T_world_first, estimate.T_world_body, walk(0), walk(i));
      EXPECT_LT(error.meters, i == 5 ? 0.2 : 0.03) << i;
    }
  }
}

TEST(RgbdOdometry, ALogMayBeginWithBadFrames) {
  const BoxRoom room = BoxRoom::furnished();
  RgbdOdometry odometry;
  int i = 0;
  for (const auto& bad : badFrames(room.see(walk(0)))) EXPECT_TRUE(odometry.track(at(i++), bad).isLost);
  EXPECT_FALSE(odometry.track(at(i), room.see(walk(i))).isLost);
  EXPECT_FALSE(odometry.track(at(i + 1), room.see(walk(i + 1))).isLost);
}

TEST(RgbdOdometry, ALostCameraFindsItsWayBackAfterALongGap) {
  const BoxRoom room = BoxRoom::furnished();
  RgbdOdometry odometry;
  Pose3 T_world_first;
  for (int i = 0; i < 10; ++i) {
    const auto estimate = odometry.track(at(i), room.see(walk(i)));
    if (i == 0) T_world_first = estimate.T_world_body;
    if (estimate.T_world_before) T_world_first = *estimate.T_world_before * T_world_first;
  }
  const auto estimate = odometry.track(at(5000), room.see(walk(2)));
  EXPECT_FALSE(estimate.isLost);
  EXPECT_LT(errorOf(T_world_first, estimate.T_world_body, walk(0), walk(2)).meters, 0.02);
}

TEST(RgbdOdometry, InAnotherPlaceItGoesOnAfterAWhile) {
  const BoxRoom room = BoxRoom::furnished();
  const BoxRoom elsewhere({9.0, 7.0, 3.0}, {{{5.0, 1.0, 0.0}, {5.5, 2.0, 1.3}}}, BoxRoom::Texture::kSpeckled);
  const auto pose = [](int i) { return geometry::fromYawPitchRoll({3.0 + 0.03 * i, 4.0, 1.5}, -0.6, 0.2, 0.0); };
  RgbdOdometry odometry;
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(odometry.track(at(i), room.see(walk(i))).isLost);
  Estimate known;
  int lost = 0;
  for (int i = 5; i < 25; ++i) {
    const auto estimate = odometry.track(at(i), elsewhere.see(pose(i)));
    lost += estimate.isLost ? 1 : 0;
    if (i == 18) known = estimate;
    if (i <= 18) continue;
    EXPECT_FALSE(estimate.isLost) << i;
    EXPECT_LT(errorOf(known.T_world_body, estimate.T_world_body, pose(18), pose(i)).meters, 0.01) << i;
  }
  EXPECT_GT(lost, 5);
}

TEST(RgbdOdometry, WhereNothingIsSeenWheelOdometryIsFollowed) {
  const BoxRoom room = BoxRoom::furnished();
  RgbdOdometry odometry;
  const auto first = odometry.track(at(0), room.see(walk(0)));
  const Pose3 step = geometry::fromYawPitchRoll({0.4, 0.0, 0.0}, 0.1, 0.0, 0.0);
  const auto blind = odometry.track(at(1), {}, nullptr, step);
  EXPECT_TRUE(blind.isLost);
  EXPECT_TRUE(blind.T_world_body.isApprox(first.T_world_body * step, 1e-9));
}

TEST(RgbdOdometry, AnotherResolutionMidwayIsTheSameRoomStill) {
  const BoxRoom room = BoxRoom::furnished();
  RgbdOdometry odometry;
  Pose3 T_world_first;
  for (int i = 0; i < 12; ++i) {
    const auto frame = i < 6 ? room.see(walk(i)) : room.see(walk(i), {300.0, 300.0, 199.5, 149.5, {}}, 400, 300);
    const auto estimate = odometry.track(at(i), frame);
    if (i == 0) T_world_first = estimate.T_world_body;
    if (estimate.T_world_before) T_world_first = *estimate.T_world_before * T_world_first;
    EXPECT_FALSE(estimate.isLost);
    EXPECT_LT(errorOf(T_world_first, estimate.T_world_body, walk(0), walk(i)).meters, 0.02);
  }
}

TEST(RgbdOdometry, TheCameraMayBeMountedAnyhow) {
  const BoxRoom room = BoxRoom::furnished();
  const Pose3 T_body_mount = geometry::fromYawPitchRoll({0.2, 0.1, 1.3}, -0.4, 0.3, 0.1);
  RgbdOdometry odometry;
  for (int i = 0; i < 10; ++i) {  // a robot on the floor, driving a bend
    const Pose3 truth = geometry::fromYawPitchRoll({1.2 + 0.05 * i, 1.8, 0.0}, 0.03 * i, 0.0, 0.0);
    auto frame = room.see(truth * T_body_mount);
    frame.T_body_camera = T_body_mount * sensors::cameraAxesInBody();
    const auto estimate = odometry.track(at(i), frame);
    const Pose3 T_first_body = geometry::fromYawPitchRoll({1.2, 1.8, 0.0}, 0.0, 0.0, 0.0).inverse() * truth;
    EXPECT_NEAR(estimate.T_world_body.translation().z(), 0.0, 0.03);
    EXPECT_NEAR(geometry::yaw(estimate.T_world_body), geometry::yaw(T_first_body), 0.01);
    EXPECT_NEAR(estimate.T_world_body.linear()(2, 2), 1.0, 0.001);
  }
}

TEST(RgbdOdometry, MemoryIsBounded) {
  const BoxRoom room = BoxRoom::furnished();
  RgbdOdometryConfig config;
  config.keyFrames = 3;
  RgbdOdometry odometry(config);
  std::size_t most = 0;
  for (int i = 0; i < 30; ++i) {
    EXPECT_FALSE(
        odometry.track(at(i), room.see(geometry::fromYawPitchRoll({2.5, 2.2, 1.3}, 0.15 * i, 0.25, 0.0))).isLost);
    base::ByteWriter out;
    odometry.save(out);
    most = std::max(most, out.bytes().size());
  }
  EXPECT_LT(most, 3U * (80 * 60 * 4 + 800 * 48 + 500) + 1000);
}

TEST(RgbdOdometry, ConfigurationIsReadAndWritten) {
  base::ConfigInput input;
  input.text = base::writeConfig(RgbdOdometryConfig{}, true);
  input.assignments = {"rgbd_odometry.key_points=500", "rgbd_odometry.key_frames=7"};
  const auto config = base::readConfig<RgbdOdometryConfig>(input);
  EXPECT_EQ(config.keyPoints, 500);
  EXPECT_EQ(config.keyFrames, 7);
  EXPECT_EQ(config.levelFrames, RgbdOdometryConfig{}.levelFrames);
}

}  // namespace
}  // namespace prodomos::localization

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/localizer.hpp"

#include "prodomos/base/error.hpp"

#include "mapper/drive.hpp"
#include "support/temporary_folder.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>

namespace prodomos::mapper {
namespace {

using geometry::Pose3;

MapperConfig with(const std::string& poses) {
  MapperConfig config;
  config.input.poses = poses;
  return config;
}

base::Time at(double seconds) {
  return base::Time(base::fromSeconds(1000.0 + seconds));
}
sensors::Reading wheels(double seconds, double x) {
  return {at(seconds), "odometry", sensors::Odometry{geometry::toPose3({x, 0, 0})}, ""};
}
sensors::Reading recorded(double seconds, double x) {
  return {at(seconds), "pose", sensors::RecordedPose{geometry::toPose3({x, 0, 0})}, ""};
}
sensors::Reading emptyScan(double seconds) {
  return {at(seconds), "laser", sensors::LaserScan{}, ""};
}
/// A wall of one colour, two metres ahead: no motion can be told from it.
sensors::Reading cameraFrame(base::Time time) {
  sensors::RgbdFrame frame;
  frame.camera = {50.0, 50.0, 31.5, 23.5, {}};
  frame.depth = sensors::Image<float>(64, 48, 2.0F);
  frame.color = sensors::Image<sensors::Rgb>(64, 48, {128, 128, 128});
  return {time, "camera", frame, ""};
}

/// What a lidar of the same robot sees: the scan's end points, at three heights.
sensors::Reading cloudOf(const sensors::Reading& reading) {
  const auto& scan = std::get<sensors::LaserScan>(reading.data);
  sensors::PointCloud cloud;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    if (!std::isfinite(scan.ranges[i])) continue;
    const double angle = scan.firstAngle + static_cast<double>(i) * scan.angleStep;
    const double range = static_cast<double>(scan.ranges[i]);
    for (const double height : {0.4, 0.6, 0.8}) {
      const Eigen::Vector3d point(range * std::cos(angle), range * std::sin(angle), height);
      cloud.points_in_sensor.push_back(point.cast<float>());
    }
  }
  return {reading.time, "lidar", cloud, ""};
}

const std::vector<Eigen::Vector2d> kWay = {{1.0, 1.0}, {7.0, 1.1}};

/// Along the corridor; the wheels tell a tenth too much and turn 2° a metre.
std::vector<sensors::Reading> corridorDrive() {
  return driveThrough(testing::fourRooms(), kWay, slippingRobot());
}

double distanceBetween(const Pose3& a, const Pose3& b) {
  return (a.translation() - b.translation()).norm();
}

TEST(Localizer, FollowsWhatTheConfigurationNames) {
  test::TemporaryFolder folder;
  const auto file = folder.write("poses.txt", "# time x y z qx qy qz qw\n1000 0 7 0 0 0 0 1\n1010 10 7 0 0 0 0 1\n");
  const auto located = [&](const std::string& poses, bool logHasPoses) {
    Localizer localizer(with(poses), liveInfo(logHasPoses));
    localizer.take(wheels(0, 1.0));
    localizer.take(recorded(0, 2.0));
    localizer.expect(emptyScan(0));
    const auto found = localizer.locate(emptyScan(0), nullptr);
    return std::pair(localizer.name(), Eigen::Vector2d(found.value().T_travel_body.translation().head<2>()));
  };
  using P = std::pair<std::string, Eigen::Vector2d>;
  EXPECT_EQ(located("odometry", true), P("odometry", {1, 0}));
  EXPECT_EQ(located("recorded", true), P("recorded", {2, 0}));
  EXPECT_EQ(located("estimated", true), P("estimated", {0, 0}));
  EXPECT_EQ(located(file, true), P(file, {0, 7}));
  EXPECT_EQ(located("auto", true), P("recorded", {2, 0}));
  EXPECT_EQ(located("auto", false), P("estimated", {0, 0}));
  EXPECT_THROW(located((folder.path() / "none.txt").string(), true), base::FileError);
}

TEST(Localizer, SaysOfWhatUseAPoseIs) {
  Localizer byRecord(with("recorded"), liveInfo());
  EXPECT_EQ(byRecord.take(recorded(0, 1)), "");
  EXPECT_EQ(byRecord.take(wheels(0, 1)), "odometry not asked for");
  Localizer estimating(with("estimated"), liveInfo());
  EXPECT_EQ(estimating.take(wheels(0, 1)), "");
  EXPECT_EQ(estimating.take(recorded(0, 1)), "recorded_pose not asked for");
  EXPECT_EQ(estimating.take(wheels(1, std::nan(""))), "pose is not finite");
}

TEST(Localizer, AwaitsTheOdometryAfterAReading) {
  Localizer localizer(with("estimated"), liveInfo());
  localizer.expect(emptyScan(0));
  EXPECT_TRUE(localizer.awaits(at(0))) << "odometry may still come";
  localizer.take(wheels(0, 0));
  EXPECT_FALSE(localizer.awaits(at(0)));
  EXPECT_TRUE(localizer.awaits(at(0.1)));
  localizer.locate(emptyScan(0), nullptr);
  EXPECT_TRUE(localizer.awaits(at(0.1))) << "there is odometry in this log";
}

TEST(Localizer, AwaitsNothingOnceALogHasShownThatItHasNoOdometry) {
  for (const char* poses : {"estimated", "odometry"}) {
    Localizer localizer(with(poses), liveInfo());
    localizer.expect(emptyScan(0));
    ASSERT_TRUE(localizer.awaits(at(0)));
    localizer.locate(emptyScan(0), nullptr);
    EXPECT_EQ(localizer.awaits(at(1)), std::string(poses) == "odometry") << poses;
  }
}

TEST(Localizer, KnowsNoPoseFarFromAllThatAreRecorded) {
  Localizer localizer(with("recorded"), liveInfo());
  EXPECT_FALSE(localizer.locate(emptyScan(0), nullptr));
  localizer.take(recorded(10, 1.0));
  EXPECT_FALSE(localizer.locate(emptyScan(8.9), nullptr));
  EXPECT_TRUE(localizer.locate(emptyScan(9.1), nullptr));
}

TEST(Localizer, DoubtsTheWheelsMoreTheLongerTheWay) {
  const auto covarianceAfter = [](double way) {
    Localizer localizer(with("odometry"), liveInfo());
    localizer.take(wheels(0, 0.0));
    localizer.take(wheels(1, way));
    EXPECT_TRUE(localizer.locate(emptyScan(0), nullptr)->covariance.isZero());
    return localizer.locate(emptyScan(1), nullptr)->covariance;
  };
  const auto near = covarianceAfter(0.5);
  const auto far = covarianceAfter(2.0);
  EXPECT_TRUE(far.isApprox(4.0 * near, 1e-9)) << "variances of stretches add up";
  EXPECT_NEAR(std::sqrt(far(0, 0)), 0.05 * std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(std::sqrt(far(5, 5)), 0.01 * std::sqrt(2.0), 1e-9);
}

/// The way of a log through a localizer: all that is located, in its order.
struct Way {
  std::vector<Localizer::Located> laser;
  std::vector<Localizer::Located> others;
};

/// Poses are taken before anything is located, as if all had been waited for.
Way locateAll(Localizer& localizer, const std::vector<sensors::Reading>& log) {
  Way way;
  for (const auto& reading : log) {
    if (Localizer::isPose(reading)) {
      localizer.take(reading);
    } else {
      localizer.expect(reading);
    }
  }
  for (const auto& reading : log) {
    if (Localizer::isPose(reading)) continue;
    const auto located = localizer.locate(reading, nullptr);
    (std::holds_alternative<sensors::LaserScan>(reading.data) ? way.laser : way.others).push_back(located.value());
  }
  return way;
}

TEST(Localizer, FindsTheTrueWayThoughWheelsSlip) {
  Localizer localizer(with("estimated"), liveInfo());
  const auto way = locateAll(localizer, corridorDrive());
  const auto truth = truthOf(kWay);
  ASSERT_EQ(way.laser.size(), truth.size());
  double farthest = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    farthest = std::max(farthest, distanceBetween(way.laser[i].T_travel_body, geometry::toPose3(truth[i])));
  EXPECT_LT(farthest, 0.1) << "wheels alone are 0.9 m off in the end";
  EXPECT_EQ(localizer.lost(), 0);
}

TEST(Localizer, FollowsTheLaserRatherThanCloudsAndCloudsRatherThanCameras) {
  const auto truth = truthOf(kWay);
  for (const bool hasLaser : {true, false}) {
    std::vector<sensors::Reading> log;
    for (auto& reading : corridorDrive()) {
      if (reading.sensor != "laser") {
        log.push_back(reading);
        continue;
      }
      log.push_back(cameraFrame(reading.time));
      log.push_back(cloudOf(reading));
      if (hasLaser) {  // the cloud is of no use: the lidar is dark
        std::get<sensors::PointCloud>(log.back().data).points_in_sensor.clear();
        log.push_back(reading);
      }
    }
    Localizer localizer(with("estimated"), liveInfo());
    const auto way = locateAll(localizer, log);
    const auto& last = hasLaser ? way.laser.back() : way.others.back();
    EXPECT_LT(distanceBetween(last.T_travel_body, geometry::toPose3(truth.back())), 0.1) << hasLaser;
    EXPECT_EQ(localizer.lost(), 0) << hasLaser;
  }
}

TEST(Localizer, LeavesCamerasWithoutDepthAside) {
  auto blind = cameraFrame(at(0));
  blind.sensor = "eye";
  std::get<sensors::RgbdFrame>(blind.data).depth = {};
  Localizer localizer(with("estimated"), liveInfo());
  localizer.expect(blind);
  localizer.expect(cameraFrame(at(0)));
  localizer.locate(cameraFrame(at(0)), nullptr);
  localizer.locate(cameraFrame(at(0.1)), nullptr);
  localizer.locate(cameraFrame(at(0.2)), nullptr);
  EXPECT_GT(localizer.lost(), 0) << "a blank wall tells no motion, so these were looked at";
}

TEST(Localizer, PlacesWhatComesBetweenScansByTheWheels) {
  const double half = 0.1;  // seconds, of those between two scans
  std::vector<sensors::Reading> log;
  for (auto& reading : corridorDrive()) {
    log.push_back(reading);
    if (reading.sensor == "laser") log.push_back(cameraFrame(reading.time + base::fromSeconds(half)));
  }
  Localizer localizer(with("estimated"), liveInfo());
  const auto way = locateAll(localizer, log);
  ASSERT_EQ(way.laser.size(), way.others.size());
  for (std::size_t i = 0; i + 1 < way.laser.size(); ++i) {
    const auto& before = way.laser[i].T_travel_body;
    const auto& after = way.laser[i + 1].T_travel_body;
    const auto middle = geometry::interpolate(before, after, 0.5);
    EXPECT_LT(distanceBetween(way.others[i].T_travel_body, middle), 0.03) << i;
  }
}

TEST(Localizer, IsNotLedAstrayByWhatComesBetweenScans) {
  // The way that the wheels tell since the last scan is that from the scan on, not from the camera's frame.
  std::vector<sensors::Reading> plain = corridorDrive();
  std::vector<sensors::Reading> mixed;
  for (auto& reading : plain) {
    mixed.push_back(reading);
    if (reading.sensor == "laser") mixed.push_back(cameraFrame(reading.time + base::fromSeconds(0.15)));
  }
  Localizer one(with("estimated"), liveInfo());
  Localizer other(with("estimated"), liveInfo());
  const auto expected = locateAll(one, plain);
  const auto way = locateAll(other, mixed);
  ASSERT_EQ(way.laser.size(), expected.laser.size());
  for (std::size_t i = 0; i < way.laser.size(); ++i) {
    EXPECT_EQ(way.laser[i].T_travel_body.matrix(), expected.laser[i].T_travel_body.matrix()) << "scan " << i;
    EXPECT_EQ(way.laser[i].covariance, expected.laser[i].covariance) << "scan " << i;
  }
}

TEST(Localizer, DoubtsAnEstimateMoreTheLongerTheWay) {
  Localizer localizer(with("estimated"), liveInfo());
  const auto way = locateAll(localizer, corridorDrive());
  EXPECT_LT(way.laser.front().covariance.diagonal().maxCoeff(), 1e-9) << "nothing has moved yet";
  for (std::size_t i = 1; i < way.laser.size(); ++i) {
    const auto& covariance = way.laser[i].covariance;
    EXPECT_TRUE(covariance.isApprox(covariance.transpose(), 1e-9));
    EXPECT_GT(covariance.determinant(), 0.0);
    EXPECT_LT(std::sqrt(covariance(0, 0)), 0.05) << "of a step of 0.1 m";
  }
}

TEST(Localizer, CountsScansThatItDoesNotRecognise) {
  auto log = corridorDrive();
  for (std::size_t i = log.size() / 2; i < log.size(); ++i) {  // somebody covers most of the laser
    if (auto* scan = std::get_if<sensors::LaserScan>(&log[i].data)) scan->ranges.resize(6);
  }
  Localizer localizer(with("estimated"), liveInfo());
  locateAll(localizer, log);
  EXPECT_EQ(localizer.lost(), static_cast<std::int64_t>(log.size() / 4));
  const auto lost = localizer.locate(emptyScan(1e6), nullptr).value();
  EXPECT_GT(localizer.lost(), static_cast<std::int64_t>(log.size() / 4)) << "a scan that shows nothing";
  EXPECT_TRUE(geometry::isFinite(lost.T_travel_body));
}

TEST(Localizer, GoesOnBitByBitFromWhereItWasSaved) {
  std::vector<sensors::Reading> log;
  for (auto& reading : corridorDrive()) {
    log.push_back(reading);
    if (reading.sensor == "laser") log.push_back(cameraFrame(reading.time + base::fromSeconds(0.05)));
  }
  const auto feed = [](Localizer& localizer, const sensors::Reading& reading) -> std::optional<Localizer::Located> {
    if (Localizer::isPose(reading)) {
      localizer.take(reading);
      return std::nullopt;
    }
    localizer.expect(reading);
    auto located = localizer.locate(reading, nullptr);
    localizer.forgetBefore(reading.time);
    return located;
  };
  for (const char* poses : {"estimated", "odometry"}) {
    Localizer undisturbed(with(poses), liveInfo());
    for (std::size_t i = 0; i < log.size() / 2; ++i) feed(undisturbed, log[i]);
    base::ByteWriter saved;
    undisturbed.save(saved);
    Localizer resumed(with(poses), liveInfo());
    base::ByteReader in(saved.bytes());
    resumed.load(in);
    EXPECT_EQ(in.left(), 0U);
    for (std::size_t i = log.size() / 2; i < log.size(); ++i) {
      const auto expected = feed(undisturbed, log[i]);
      const auto found = feed(resumed, log[i]);
      ASSERT_EQ(found.has_value(), expected.has_value());
      if (!found) continue;
      ASSERT_EQ(found->T_travel_body.matrix(), expected->T_travel_body.matrix()) << poses << ", item " << i;
      ASSERT_EQ(found->covariance, expected->covariance) << poses << ", item " << i;
    }
    base::ByteWriter one;
    base::ByteWriter other;
    undisturbed.save(one);
    resumed.save(other);
    EXPECT_TRUE(one.take() == other.take()) << poses;
  }
}

}  // namespace
}  // namespace prodomos::mapper

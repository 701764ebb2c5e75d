// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/leg_detector.hpp"

#include "prodomos/base/random.hpp"
#include "prodomos/perception/person_tracker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

namespace prodomos::perception {
namespace {

using Eigen::Vector2d;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kPi = std::numbers::pi;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct Circle {
  Vector2d middle;
  double radius;
};

/// A room of 10 m by 8 m about the origin with posts in it, seen by a level sensor of 721 beams over a full turn.
sensors::LaserScan scanOf(const std::vector<Circle>& posts, const geometry::Pose2& T_world_sensor,
                          base::Random* noise = nullptr) {
  sensors::LaserScan scan;
  scan.T_body_sensor = geometry::Pose3(Eigen::Translation3d(0.0, 0.0, 0.3));
  scan.firstAngle = -kPi;
  scan.angleStep = 2.0 * kPi / 720.0;
  scan.maxRange = 30.0;
  const Vector2d from(T_world_sensor.x, T_world_sensor.y);
  for (int i = 0; i <= 720; ++i) {
    const double angle = T_world_sensor.theta + scan.firstAngle + i * scan.angleStep;
    const Vector2d ray(std::cos(angle), std::sin(angle));
    double range = std::min((ray.x() > 0.0 ? 5.0 - from.x() : -5.0 - from.x()) / ray.x(),
                            (ray.y() > 0.0 ? 4.0 - from.y() : -4.0 - from.y()) / ray.y());
    for (const auto& post : posts) {
      const Vector2d to = post.middle - from;
      const double along = to.dot(ray);
      const double beside = to.squaredNorm() - along * along;
      if (along <= 0.0 || beside >= post.radius * post.radius) continue;
      range = std::min(range, along - std::sqrt(post.radius * post.radius - beside));
    }
    if (noise != nullptr) range += noise->normal(0.0, 0.01);
    scan.ranges.push_back(static_cast<float>(range));
  }
  return scan;
}

std::vector<Circle> legsAt(const Vector2d& position, const Vector2d& apart = {0.0, 0.24}) {
  return {{position + apart / 2.0, 0.06}, {position - apart / 2.0, 0.06}};
}

geometry::Pose3 bodyAt(const geometry::Pose2& pose, double z = 0.0) {
  return geometry::toPose3(pose, z);
}

TEST(LegDetector, FindsAPairOfLegsBetweenThem) {
  for (const auto& pose : {geometry::Pose2{}, geometry::Pose2{-2.0, 1.0, 2.5}}) {
    const auto people = findLegs(scanOf(legsAt({1.5, 0.5}), pose), bodyAt(pose, 3.0), base::Time{});
    ASSERT_THAT(people, SizeIs(1));
    EXPECT_LT((people[0].position_in_submap.head<2>() - Vector2d(1.5, 0.5)).norm(), 0.05);
    EXPECT_DOUBLE_EQ(people[0].position_in_submap.z(), 3.0);
    EXPECT_TRUE(people[0].mustMove);
    EXPECT_FALSE(people[0].heading);
  }
}

TEST(LegDetector, ToleratesNoise) {
  base::Random random(2, "laser");
  int found = 0;
  for (int i = 0; i < 50; ++i) {
    found += static_cast<int>(findLegs(scanOf(legsAt({2.0, -1.0}), {}, &random), bodyAt({}), base::Time{}).size());
  }
  EXPECT_GE(found, 45);
  EXPECT_LE(found, 50);
}

TEST(LegDetector, TellsTwoPeopleApart) {
  auto legs = legsAt({2.0, 1.0});
  for (const auto& leg : legsAt({2.0, -1.0})) legs.push_back(leg);
  EXPECT_THAT(findLegs(scanOf(legs, {}), bodyAt({}), base::Time{}), SizeIs(2));
}

TEST(LegDetector, WallsPillarsAndSinglePostsAreNone) {
  EXPECT_THAT(findLegs(scanOf({}, {}), bodyAt({}), base::Time{}), IsEmpty());
  EXPECT_THAT(findLegs(scanOf({{{2.0, 0.0}, 0.06}}, {}), bodyAt({}), base::Time{}), IsEmpty());
  EXPECT_THAT(findLegs(scanOf({{{2.0, 0.0}, 0.25}, {{2.0, 0.6}, 0.25}}, {}), bodyAt({}), base::Time{}), IsEmpty());
  EXPECT_THAT(findLegs(scanOf({{{2.0, 0.0}, 0.06}, {{2.0, 1.0}, 0.06}}, {}), bodyAt({}), base::Time{}), IsEmpty());
  // At the wall: nothing behind them tells that they are free.
  EXPECT_THAT(findLegs(scanOf(legsAt({4.92, 0.0}), {}), bodyAt({}), base::Time{}), IsEmpty());
}

TEST(LegDetector, LooksInLevelScansNearTheFloorOnly) {
  auto scan = scanOf(legsAt({2.0, 0.0}), {});
  scan.T_body_sensor.translation().z() = 1.2;
  EXPECT_THAT(findLegs(scan, bodyAt({}), base::Time{}), IsEmpty());
  scan.T_body_sensor = geometry::fromYawPitchRoll({0.0, 0.0, 0.3}, 0.0, 0.3, 0.0);
  EXPECT_THAT(findLegs(scan, bodyAt({}), base::Time{}), IsEmpty());
}

TEST(LegDetector, MadScansHoldNobody) {
  sensors::LaserScan scan;
  EXPECT_THAT(findLegs(scan, bodyAt({}), base::Time{}), IsEmpty());
  scan.ranges.assign(500, kNan);
  scan.angleStep = 0.01;
  EXPECT_THAT(findLegs(scan, bodyAt({}), base::Time{}), IsEmpty());
  scan.ranges.assign(500, sensors::LaserScan::kNoReturn);
  EXPECT_THAT(findLegs(scan, bodyAt({}), base::Time{}), IsEmpty());
  scan.ranges.assign(500, sensors::LaserScan::kInvalid);
  EXPECT_THAT(findLegs(scan, bodyAt({}), base::Time{}), IsEmpty());
  scan = scanOf(legsAt({2.0, 0.0}), {});
  geometry::Pose3 nowhere = geometry::Pose3::Identity();
  nowhere.translation().x() = std::nan("");
  EXPECT_THAT(findLegs(scan, nowhere, base::Time{}), IsEmpty());
}

TEST(LegDetector, LegsThatBeamsWithoutReturnSurroundAreFree) {
  auto scan = scanOf(legsAt({2.0, 0.0}), {});
  for (auto& range : scan.ranges) {
    if (range > 3.0F) range = sensors::LaserScan::kNoReturn;
  }
  EXPECT_THAT(findLegs(scan, bodyAt({}), base::Time{}), SizeIs(1));
}

/// A gait of 1 m/s along y, past a chair.
TEST(LegDetector, WhoWalksIsFollowedAndAChairIsNot) {
  std::int64_t ids = 0;
  PersonTracker tracker({}, base::SessionId{0}, 0, [&] { return base::EntityId{ids++}; });
  base::Random random(7, "laser");
  for (int i = 0; i < 60; ++i) {
    const double t = 0.1 * i;
    const double swing = 0.25 * std::sin(2.0 * kPi * t);
    auto posts = legsAt({2.0, -3.0 + t}, {0.16, 2.0 * swing});
    posts.push_back({{1.0, -1.0}, 0.03});
    posts.push_back({{1.0, -0.6}, 0.03});
    const auto time = base::Time{} + base::fromSeconds(t);
    tracker.add(base::SubMapId{0}, time, findLegs(scanOf(posts, {}, &random), bodyAt({}), time), nullptr);
  }
  const auto people = tracker.entities();
  ASSERT_THAT(people, SizeIs(1));
  EXPECT_LT((people[0].T_submap_entity.translation().head<2>() - Vector2d(2.0, 2.9)).norm(), 0.2);
  EXPECT_NEAR(geometry::yaw(people[0].T_submap_entity), kPi / 2.0, 0.4);
}

}  // namespace
}  // namespace prodomos::perception

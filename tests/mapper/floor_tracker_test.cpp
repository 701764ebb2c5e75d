// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/floor_tracker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace prodomos::mapper {
namespace {

using map::EdgeKind;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A robot that tells the tracker of each five centimetres of its way.
class Walker {
 public:
  explicit Walker(double bobbing = 0.0) : bobbing_(bobbing) {}

  /// Climbs `rise` on its way of `way` metres, both along the slope.
  void go(double way, double rise = 0.0) {
    const int steps = static_cast<int>(std::round(way / kStep));
    for (int i = 0; i < steps; ++i) {
      distance_ += kStep;
      height_ += rise / steps;
      tell();
    }
  }
  void jump(double rise) {
    height_ += rise;
    tell();
  }
  /// Metres of the way along stairs of 32 degrees.
  void climb(double rise) { go(std::abs(rise) / std::sin(0.56), rise); }

  FloorTracker tracker{1.8};
  std::vector<EdgeKind> changes;

 private:
  static constexpr double kStep = 0.05;

  void tell() {
    const auto way = tracker.update(height_ + bobbing_ * std::sin(distance_ * 5.0), distance_);
    if (way) changes.push_back(*way);
  }

  double bobbing_;
  double distance_ = 0.0;
  double height_ = 0.0;
};

TEST(FloorTracker, StaysOnTheGroundFloor) {
  Walker robot;
  robot.go(50);
  robot.go(5, 0.4);  // a ramp at a door
  robot.go(20);
  EXPECT_THAT(robot.changes, IsEmpty());
  EXPECT_EQ(robot.tracker.current().number, 0);
  EXPECT_EQ(robot.tracker.floors().size(), 1U);
}

TEST(FloorTracker, BelongsToTheFloorBelowUntilTheStairsEnd) {
  Walker robot;
  robot.go(10);
  robot.climb(3);
  EXPECT_EQ(robot.tracker.current().number, 0);
  robot.go(3);
  EXPECT_THAT(robot.changes, ElementsAre(EdgeKind::kStairs));
  EXPECT_EQ(robot.tracker.current().number, 1);
  EXPECT_NEAR(robot.tracker.current().height, 3.0, 0.03);
}

TEST(FloorTracker, TakesALandingHalfWayUpForNoFloor) {
  Walker robot;
  robot.go(5);
  robot.climb(1.6);
  robot.go(3);
  robot.climb(1.6);
  robot.go(3);
  EXPECT_THAT(robot.changes, ElementsAre(EdgeKind::kStairs));
  EXPECT_NEAR(robot.tracker.current().height, 3.2, 0.03);
}

TEST(FloorTracker, CountsAGentleRampAsStairsOnceItIsAStoreyUp) {
  Walker robot;
  robot.go(5);
  robot.go(30, 3.0);
  robot.go(5);
  EXPECT_THAT(robot.changes, ElementsAre(EdgeKind::kStairs));
  EXPECT_EQ(robot.tracker.current().number, 1);
}

TEST(FloorTracker, CallsAClimbWithoutAWayALift) {
  Walker jumps;  // the laser slept meanwhile
  jumps.go(5);
  jumps.jump(3.5);
  jumps.go(3);
  EXPECT_THAT(jumps.changes, ElementsAre(EdgeKind::kLift));
  EXPECT_NEAR(jumps.tracker.current().height, 3.5, 1e-9);

  Walker rises;  // here it watched: the way is the climb itself
  rises.go(5);
  rises.go(3.5, 3.5);
  rises.go(3);
  EXPECT_THAT(rises.changes, ElementsAre(EdgeKind::kLift));
}

TEST(FloorTracker, BearsACameraCarriedByHand) {
  Walker person(0.2);
  person.go(30);
  EXPECT_THAT(person.changes, IsEmpty());
  person.climb(3);
  person.go(5);
  EXPECT_THAT(person.changes, ElementsAre(EdgeKind::kStairs));
  EXPECT_NEAR(person.tracker.current().height, 3.0, 0.2);
}

TEST(FloorTracker, NumbersBasementsDownwardsAndKnowsFloorsAgain) {
  Walker robot;
  robot.go(5);
  robot.climb(-3);
  robot.go(3);
  EXPECT_EQ(robot.tracker.current().number, -1);
  robot.climb(3);
  robot.go(3);
  EXPECT_EQ(robot.tracker.current().number, 0);
  EXPECT_EQ(robot.tracker.current().height, 0.0);
  robot.climb(3);
  robot.go(3);
  robot.climb(3);
  robot.go(3);
  EXPECT_EQ(robot.tracker.current().number, 2);
  robot.climb(-6);
  robot.go(3);
  EXPECT_EQ(robot.tracker.current().number, 0);
  EXPECT_EQ(robot.tracker.floors().size(), 4U);
  EXPECT_EQ(robot.changes.size(), 5U);
}

TEST(FloorTracker, GoesOnFromWhatItSaved) {
  Walker undisturbed;
  Walker resumed;
  for (auto* robot : {&undisturbed, &resumed}) {
    robot->go(5);
    robot->climb(3);
    robot->go(1);
  }
  base::ByteWriter out;
  resumed.tracker.save(out);
  resumed.tracker = FloorTracker(1.8);
  base::ByteReader in(out.bytes());
  resumed.tracker.load(in);
  EXPECT_EQ(in.left(), 0U);
  for (auto* robot : {&undisturbed, &resumed}) robot->go(1);
  EXPECT_THAT(resumed.changes, ElementsAre(EdgeKind::kStairs));
  EXPECT_EQ(resumed.tracker.current().height, undisturbed.tracker.current().height);

  base::ByteWriter first;
  base::ByteWriter second;
  undisturbed.tracker.save(first);
  resumed.tracker.save(second);
  EXPECT_EQ(first.bytes(), second.bytes());
}

TEST(FloorTracker, HearsTheSamePlaceTwiceAsOnce) {  // a resumed session begins with the reading it stopped at
  FloorTracker once(1.8);
  FloorTracker twice(1.8);
  for (int i = 0; i < 200; ++i) {
    const double height = i < 100 ? 0.03 * i : 3.0;
    once.update(height, 0.06 * i);
    twice.update(height, 0.06 * i);
    twice.update(height, 0.06 * i);
  }
  base::ByteWriter first;
  base::ByteWriter second;
  once.save(first);
  twice.save(second);
  EXPECT_EQ(first.bytes(), second.bytes());
  EXPECT_EQ(once.current().number, 1);
}

TEST(FloorTracker, ForgetsTheWayBehindIt) {
  Walker robot;
  robot.go(1000);
  for (int i = 0; i < 1000; ++i) robot.jump(0.0);
  base::ByteWriter out;
  robot.tracker.save(out);
  EXPECT_LT(out.bytes().size(), 1000U);
}

}  // namespace
}  // namespace prodomos::mapper

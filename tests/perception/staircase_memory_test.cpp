// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/memory_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace prodomos::perception {
namespace {

using test::MemoryBench;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kPi = std::numbers::pi;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Flight {
  geometry::Pose2 foot;  ///< x uphill
  double foot_z = 0.0;
  double riser = 0.17;
  double depth = 0.28;
  int count = 17;  ///< risers; tread `count` is the floor above
  double width = 1.4;

  double rise() const { return count * riser; }
};

class FlightMaker {
 public:
  FlightMaker(const Flight& flight, std::uint64_t seed) : flight_(flight), random_(seed, "flights") {}

  /// Treads first … last, counted from 1, and `share` of the width from the right.
  StaircaseSighting see(double time, int first, int last, double share = 1.0) {
    StaircaseSighting sighting;
    sighting.time = test::at(time);
    const double width = share * flight_.width;
    const geometry::Pose2 origin{(first - 1) * flight_.depth + random_.normal(0.0, 0.02),
                                 (width - flight_.width) / 2.0 + random_.normal(0.0, 0.02), random_.normal(0.0, 0.02)};
    sighting.footIsSeen = first == 1;
    sighting.T_submap_stairs = geometry::toPose3(flight_.foot * origin, flight_.foot_z + (first - 1) * flight_.riser);
    const double along = first == 1 ? 0.03 : 0.5;
    const Eigen::Matrix3d R = sighting.T_submap_stairs.linear();
    sighting.covariance(2, 2) = 1e-4;
    sighting.covariance.topLeftCorner<3, 3>() =
        R * Eigen::Vector3d(along * along, share < 1.0 ? 0.09 : 1e-3, 1e-4).asDiagonal() * R.transpose();
    sighting.covariance(3, 3) = 4e-4;
    for (int tread = first; tread <= last; ++tread) {
      sighting.steps.push_back({.z = flight_.foot_z + tread * flight_.riser + random_.normal(0.0, 0.01),
                                .along = (tread - first) * flight_.depth + random_.normal(0.0, 0.02),
                                .depth = flight_.depth,
                                .width = width});
    }
    sighting.slope = flight_.riser / flight_.depth;
    sighting.width = width + random_.normal(0.0, 0.02);
    sighting.widthIsWhole = share == 1.0;
    sighting.headIsSeen = last == flight_.count;
    sighting.newFloor_z = sighting.steps.back().z;
    sighting.newFloorSigma = sighting.headIsSeen ? 0.03 : 1.0;
    sighting.evidence = 2.0;
    sighting.points_in_submap.assign(1000, Eigen::Vector3f::Zero());
    return sighting;
  }
  /// As from the floor above.
  StaircaseSighting seeFromAbove(double time, int first, int last) {
    auto sighting = see(time, first, last);
    sighting.descends = true;
    sighting.headIsSeen = false;
    sighting.footIsSeen = false;
    sighting.newFloor_z = sighting.steps.front().z - flight_.riser;
    sighting.newFloorSigma = 1.5;
    const Eigen::Matrix3d R = sighting.T_submap_stairs.linear();
    sighting.covariance.topLeftCorner<3, 3>() = R * Eigen::Vector3d(0.25, 1e-3, 1e-4).asDiagonal() * R.transpose();
    return sighting;
  }
  base::Random& random() { return random_; }

 private:
  Flight flight_;
  base::Random random_;
};

StaircaseSighting inSubmap(StaircaseSighting sighting, const geometry::Pose3& T_world_submap) {
  const geometry::Pose3 T_submap_world = T_world_submap.inverse();
  sighting.T_submap_stairs = T_submap_world * sighting.T_submap_stairs;
  Eigen::Matrix4d rotation = Eigen::Matrix4d::Identity();
  rotation.topLeftCorner<3, 3>() = T_submap_world.linear();
  sighting.covariance = rotation * sighting.covariance * rotation.transpose();
  for (auto& step : sighting.steps) step.z += T_submap_world.translation().z();
  sighting.newFloor_z += T_submap_world.translation().z();
  return sighting;
}

void add(MemoryBench& bench, std::int64_t submap, const Eigen::Vector3d& sensor, const StaircaseSighting& sighting) {
  const std::vector seen = {inSubmap(sighting, bench.submaps.at(submap))};
  bench.memory.add({submap}, bench.sensorPose(submap, sensor), seen, bench.poses());
}

const map::Staircase& stairsOf(const map::Entity& entity) {
  return std::get<map::Staircase>(entity.attributes);
}

/// As evaluation has it: half the run downhill from the middle.
geometry::Pose2 footOf(const MemoryBench& bench, const map::Entity& entity) {
  const auto& stairs = stairsOf(entity);
  const double run = std::abs(stairs.height) * stairs.stepDepth / stairs.stepHeight;
  return bench.inWorld(entity) * geometry::Pose2{-run / 2.0, 0.0, 0.0};
}

void expectFlight(const MemoryBench& bench, const map::Entity& entity, const Flight& flight) {
  const auto foot = footOf(bench, entity);
  EXPECT_LT(std::hypot(foot.x - flight.foot.x, foot.y - flight.foot.y), 0.08);
  EXPECT_NEAR(geometry::normalizeAngle(foot.theta - flight.foot.theta), 0.0, 0.03);
  EXPECT_NEAR(std::abs(stairsOf(entity).height), flight.rise(), 0.04);
  EXPECT_EQ(stairsOf(entity).stepCount, flight.count);
  EXPECT_NEAR(stairsOf(entity).stepHeight, flight.riser, 0.003);
  EXPECT_NEAR(stairsOf(entity).stepDepth, flight.depth, 0.006);
  EXPECT_NEAR(stairsOf(entity).stepWidth, flight.width, 0.06);
}

const Flight kFlight{.foot = {4.0, 1.0, 0.6}};

TEST(StaircaseMemory, OneFlightSeenManyTimesIsOneEntity) {
  MemoryBench bench;
  FlightMaker maker(kFlight, 1);
  for (int i = 0; i < 15; ++i) add(bench, 0, {0.2 * i, 0.0, 1.2}, maker.see(0.2 * i, 1, kFlight.count));
  ASSERT_THAT(bench.entities(), SizeIs(1));
  expectFlight(bench, bench.entities()[0], kFlight);
  EXPECT_GT(stairsOf(bench.entities()[0]).height, 0.0);
  EXPECT_GT(bench.entities()[0].confidence, 0.95);
  EXPECT_FALSE(bench.entities()[0].points_in_submap.empty());
  EXPECT_LE(bench.entities()[0].points_in_submap.size(), 500U);
}

TEST(StaircaseMemory, PartsSeenOneByOneAddUpToTheWholeFlight) {
  MemoryBench bench;
  FlightMaker maker(kFlight, 2);
  for (int i = 0; i < 24; ++i) {  // six steps at a time, upwards, half of the width but for one look
    const int first = 1 + i / 2;
    add(bench, 0, {0.2 * i, 0.0, 1.2},
        maker.see(0.2 * i, first, std::min(first + 5, kFlight.count), i == 5 ? 1.0 : 0.5));
  }
  ASSERT_THAT(bench.entities(), SizeIs(1));
  expectFlight(bench, bench.entities()[0], kFlight);
}

TEST(StaircaseMemory, WithoutItsHeadAFlightIsAsHighAsWasSeen) {
  MemoryBench bench;
  FlightMaker maker(kFlight, 3);
  for (int i = 0; i < 10; ++i) {
    auto seen = maker.see(0.2 * i, 1, 8);
    seen.newFloorSigma = 0.0;
    add(bench, 0, {0.2 * i, 0.0, 1.2}, seen);
  }
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_NEAR(stairsOf(bench.entities()[0]).height, 8 * kFlight.riser, 0.03);
  const auto foot = footOf(bench, bench.entities()[0]);
  EXPECT_LT(std::hypot(foot.x - kFlight.foot.x, foot.y - kFlight.foot.y), 0.08);
}

TEST(StaircaseMemory, SeenFromBelowAndFromAboveIsOneFlight) {
  MemoryBench bench;
  bench.submaps[1] = geometry::toPose3({8.0, 3.0, -2.0}, kFlight.rise());
  FlightMaker maker(kFlight, 4);
  for (int i = 0; i < 12; ++i) add(bench, 0, {0.2 * i, 0.0, 1.2}, maker.see(0.2 * i, 1, 12));
  for (int i = 0; i < 6; ++i) add(bench, 1, {0.2 * i, 8.0, 4.0}, maker.seeFromAbove(60.0 + i, 9, 17));
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_EQ(bench.entities()[0].submap, base::SubMapId{0});
  expectFlight(bench, bench.entities()[0], kFlight);
}

TEST(StaircaseMemory, WhoClimbsDoesNotTakeTheStepBelowForTheFloor) {
  MemoryBench bench;
  FlightMaker maker(kFlight, 11);
  for (int i = 0; i < 5; ++i) add(bench, 0, {0.3 * i, 0.0, 1.2}, maker.see(i, 1, 9));
  for (int tread = 1; tread < 10; ++tread) {  // standing on it, it seems to be the floor that the next ones rise from
    auto seen = maker.see(10.0 + tread, tread + 1, std::min(tread + 8, kFlight.count));
    seen.footIsSeen = true;
    add(bench, 0, {1.5 + 0.3 * tread, 0.0, 1.2 + tread * kFlight.riser}, seen);
  }
  ASSERT_THAT(bench.entities(), SizeIs(1));
  expectFlight(bench, bench.entities()[0], kFlight);
}

/// As it seems to who has climbed so far up without knowing.
Flight sunk(Flight flight, double climbed) {
  flight.foot_z -= climbed;
  return flight;
}

/// Up the flight and back down again, always believing to be on the lower floor.
void climbUnawares(MemoryBench& bench, double time) {
  for (int tread = 1; tread < kFlight.count - 3; ++tread) {
    FlightMaker maker(sunk(kFlight, tread * kFlight.riser), 20 + static_cast<std::uint64_t>(tread));
    const auto eye = kFlight.foot * geometry::Pose2{(tread - 0.5) * kFlight.depth, 0.0, 0.0};
    add(bench, 0, {eye.x, eye.y, 1.2}, maker.see(time + tread, tread + 2, kFlight.count));
  }
  FlightMaker maker(sunk(kFlight, kFlight.rise()), 50);
  const auto head = kFlight.foot * geometry::Pose2{6.0, 0.0, 0.0};
  for (int i = 0; i < 6; ++i) add(bench, 0, {head.x, head.y, 1.2}, maker.seeFromAbove(time + 30.0 + i, 9, 17));
}

TEST(StaircaseMemory, WhoClimbsUnawaresSeesNoOtherFlight) {
  MemoryBench bench;
  FlightMaker maker(kFlight, 12);
  for (int i = 0; i < 5; ++i) add(bench, 0, {0.3 * i, 0.0, 1.2}, maker.see(i, 1, 12));
  const int seen = bench.entities().at(0).observations;
  climbUnawares(bench, 10.0);
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_GT(bench.entities()[0].observations, seen + 15) << "it is this one that was seen";
  for (int i = 0; i < 5; ++i) add(bench, 0, {0.3 * i, 0.0, 1.2}, maker.see(60.0 + i, 1, kFlight.count));
  ASSERT_THAT(bench.entities(), SizeIs(1));
  expectFlight(bench, bench.entities()[0], kFlight);
}

TEST(StaircaseMemory, WhoHasClimbedUnawaresSeesFlightsElsewhere) {
  MemoryBench bench;
  FlightMaker maker(kFlight, 13);
  for (int i = 0; i < 5; ++i) add(bench, 0, {0.3 * i, 0.0, 1.2}, maker.see(i, 1, 12));
  climbUnawares(bench, 10.0);
  Flight next = kFlight;
  next.foot = kFlight.foot * geometry::Pose2{17 * kFlight.depth, 1.8, kPi};
  FlightMaker other(next, 14);
  for (int i = 0; i < 5; ++i) add(bench, 0, {8.0 + 0.3 * i, 5.0, 1.2}, other.see(60.0 + i, 1, kFlight.count));
  ASSERT_THAT(bench.entities(), SizeIs(2));
  expectFlight(bench, bench.entities()[1], next);
}

TEST(StaircaseMemory, AFlightThatIsOnlySeenFromAboveDescends) {
  MemoryBench bench;
  bench.submaps[0] = geometry::toPose3({8.0, 3.0, -2.0}, kFlight.rise());
  FlightMaker maker(kFlight, 5);
  for (int i = 0; i < 12; ++i) add(bench, 0, {0.3 * i, 8.0, 4.0}, maker.seeFromAbove(i, 6, 17));
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_NEAR(stairsOf(bench.entities()[0]).height, -12 * kFlight.riser, 0.03) << "down to below the lowest tread seen";
  EXPECT_NEAR(geometry::normalizeAngle(bench.inWorld(bench.entities()[0]).theta - kFlight.foot.theta), 0.0, 0.03);
}

TEST(StaircaseMemory, FlightsThatTurnBackAndThoseAboveEachOtherAreDifferent) {
  MemoryBench bench;
  const Flight back{.foot = {4.0 + 3.0 * std::cos(0.6), 1.0 + 3.0 * std::sin(0.6), 0.6 + kPi}, .foot_z = 1.5};
  const Flight above{.foot = kFlight.foot, .foot_z = 3.2};
  FlightMaker one(kFlight, 6);
  FlightMaker two(back, 7);
  FlightMaker three(above, 8);
  for (int i = 0; i < 8; ++i) {
    add(bench, 0, {0.3 * i, 0.0, 1.2}, one.see(i, 1, 9));
    add(bench, 0, {0.3 * i, 0.0, 1.2}, two.see(i, 1, 9));
    add(bench, 0, {0.3 * i, 0.0, 1.2}, three.see(i, 1, 9));
  }
  EXPECT_THAT(bench.entities(), SizeIs(3));
}

TEST(StaircaseMemory, ASingleWeakSightingIsNoFlightYet) {
  MemoryBench bench;
  FlightMaker maker(kFlight, 9);
  add(bench, 0, {0.0, 0.0, 1.2}, maker.see(0.0, 1, 4));
  EXPECT_THAT(bench.entities(), IsEmpty());
}

TEST(StaircaseMemory, WhatCannotBeAFlightIsPassedOver) {
  MemoryBench bench;
  FlightMaker maker(kFlight, 10);
  for (int i = 0; i < 10; ++i) {
    const auto good = maker.see(i, 1, 9);
    auto nowhere = good;
    nowhere.T_submap_stairs.translation().y() = kNan;
    auto certain = good;
    certain.covariance.setZero();
    auto unsteady = good;
    unsteady.steps[3].z = kNan;
    auto falling = good;
    std::swap(falling.steps[2], falling.steps[5]);
    auto stepless = good;
    stepless.steps.clear();
    auto endless = good;
    endless.width = 50.0;
    for (const auto& bad : {nowhere, certain, unsteady, falling, stepless, endless}) {
      bench.memory.add({0}, geometry::Pose3(Eigen::Translation3d(0.3 * i, 0.0, 1.2)), std::vector{bad}, bench.poses());
    }
  }
  EXPECT_THAT(bench.entities(), IsEmpty());
}

}  // namespace
}  // namespace prodomos::perception

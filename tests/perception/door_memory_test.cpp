// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/memory_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace prodomos::perception {
namespace {

using map::DoorState;
using map::HingeSide;
using test::doorOf;
using test::MemoryBench;
using test::SightingMaker;
using test::WorldDoor;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kPi = std::numbers::pi;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The robot goes along y, 2 m before a door at the origin that looks along x.
Eigen::Vector3d before(double y) {
  return {-2.0, y, 1.2};
}

/// One sighting a frame, 5 frames a second, while the robot drives past.
void driveBy(MemoryBench& bench, SightingMaker& maker, const WorldDoor& door, int frames, double begin = 0.0) {
  for (int i = 0; i < frames; ++i) {
    const auto sensor = before(-1.0 + 0.1 * i);
    bench.add(0, sensor, {maker.see(door, sensor, begin + 0.2 * i)});
  }
}

TEST(DoorMemory, OneDoorSeenManyTimesIsOneEntity) {
  MemoryBench bench;
  SightingMaker maker(1);
  const WorldDoor door{{0.0, 0.0, 0.0}};
  driveBy(bench, maker, door, 20);
  const auto entities = bench.entities();
  ASSERT_THAT(entities, SizeIs(1));
  EXPECT_EQ(entities[0].id, base::EntityId{1});
  EXPECT_EQ(entities[0].observations, 20);
  EXPECT_EQ(entities[0].firstSeen, test::at(0.0));
  EXPECT_EQ(entities[0].lastSeen, test::at(3.8));
  EXPECT_GT(entities[0].confidence, 0.95);
  const auto pose = bench.inWorld(entities[0]);
  EXPECT_LT(std::hypot(pose.x, pose.y), 0.03);
  EXPECT_NEAR(pose.theta, 0.0, 0.03);
  EXPECT_NEAR(doorOf(entities[0]).width, 0.9, 0.03);
  EXPECT_TRUE(doorOf(entities[0]).hasLeaf);
  EXPECT_EQ(doorOf(entities[0]).hingeSide, HingeSide::kLeft);
  EXPECT_EQ(doorOf(entities[0]).state, DoorState::kClosed);
}

TEST(DoorMemory, ASingleWeakSightingIsNoDoorYet) {
  MemoryBench bench;
  SightingMaker maker(1);
  const auto sensor = before(0.0);
  bench.add(0, sensor, {maker.see({}, sensor, 0.0)});
  EXPECT_THAT(bench.entities(), IsEmpty());
}

TEST(DoorMemory, StandingAndStaringMakesLittleSurer) {
  MemoryBench bench;
  SightingMaker maker(2);
  for (int i = 0; i < 500; ++i) {
    auto seen = maker.see({}, before(0.0), 0.2 * i);
    seen.evidence = 2.0;
    bench.add(0, before(0.0), {seen});
  }
  MemoryBench moving;
  driveBy(moving, maker, {}, 20);
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_LT(bench.entities()[0].confidence, moving.entities()[0].confidence);
  EXPECT_GT(bench.entities()[0].covariance(0, 0), moving.entities()[0].covariance(0, 0));
  EXPECT_GT(std::sqrt(bench.entities()[0].covariance(0, 0)), 0.03);
}

TEST(DoorMemory, SeenFromBothSidesIsOneDoorWithOneHinge) {
  for (const auto hinge : {HingeSide::kLeft, HingeSide::kRight}) {
    MemoryBench bench;
    SightingMaker maker(3);
    const WorldDoor door{.pose = {1.0, 2.0, 0.7}, .hinge = hinge};
    for (int i = 0; i < 20; ++i) {
      const double side = i < 10 ? -2.0 : 2.0;
      const auto spot = door.pose * geometry::Pose2{side, 0.2 * i - 2.0, 0.0};
      const Eigen::Vector3d sensor(spot.x, spot.y, 1.2);
      bench.add(0, sensor, {maker.see(door, sensor, i)});
    }
    ASSERT_THAT(bench.entities(), SizeIs(1));
    EXPECT_NEAR(bench.inWorld(bench.entities()[0]).theta, 0.7, 0.03) << "the side seen first";
    EXPECT_EQ(doorOf(bench.entities()[0]).hingeSide, hinge);
  }
}

TEST(DoorMemory, DoorsNextToEachOtherStayTwo) {
  MemoryBench bench;
  SightingMaker maker(4);
  const std::vector<WorldDoor> doors = {{{0.0, 0.0, 0.0}}, {{0.0, 1.2, 0.0}}};  // 0.3 m between the jambs
  for (int i = 0; i < 20; ++i) {
    const auto sensor = before(0.1 * i);
    std::vector<DoorSighting> seen;
    for (const auto& door : doors) {
      if (maker.random().uniform() < 0.7) seen.push_back(maker.see(door, sensor, 0.2 * i));
    }
    bench.add(0, sensor, seen);
  }
  ASSERT_THAT(bench.entities(), SizeIs(2));
  const double apart = bench.inWorld(bench.entities()[0]).y - bench.inWorld(bench.entities()[1]).y;
  EXPECT_NEAR(std::abs(apart), 1.2, 0.05);
}

TEST(DoorMemory, ADoubleDoorAndOneOfItsLeavesAreNotBothWritten) {
  MemoryBench bench;
  SightingMaker maker(5);
  const WorldDoor whole{.pose = {0.0, 0.0, 0.0}, .width = 1.8};
  const WorldDoor leaf{.pose = {0.0, 0.45, 0.0}, .width = 0.9};
  for (int i = 0; i < 20; ++i) {
    const auto sensor = before(0.1 * i);
    bench.add(0, sensor, {maker.see(i % 4 == 0 ? leaf : whole, sensor, 0.2 * i)});
  }
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_NEAR(doorOf(bench.entities()[0]).width, 1.8, 0.05);
}

TEST(DoorMemory, CutSightingsAddUpToTheWholeDoor) {
  MemoryBench bench;
  SightingMaker maker(6);
  const WorldDoor door{.pose = {0.0, 0.0, 0.0}, .width = 1.0};
  for (int i = 0; i < 20; ++i) {
    const auto sensor = before(0.2 * i);
    auto seen = maker.see(door, sensor, 0.2 * i);
    if (i < 15) {  // cut: up to 0.3 m of the leaf are out of the image, and nobody knows how much
      const double missing = maker.random().uniform(0.0, 0.3);
      seen.T_submap_door.translation().y() += missing / 2.0;
      seen.door.width -= missing;
      seen.covariance(1, 1) = 0.15 * 0.15;
      seen.widthSigma = 0.3;
      seen.whole = false;
    }
    bench.add(0, sensor, {seen});
  }
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_NEAR(bench.inWorld(bench.entities()[0]).y, 0.0, 0.04);
  EXPECT_NEAR(doorOf(bench.entities()[0]).width, 1.0, 0.04);
}

TEST(DoorMemory, OutliersDoNotPullTheDoor) {
  MemoryBench bench;
  SightingMaker maker(7);
  for (int i = 0; i < 12; ++i) {
    const auto sensor = before(-2.0 + 0.4 * i);
    auto seen = maker.see({}, sensor, 0.2 * i);
    if (i % 4 == 0) seen.T_submap_door.translation() += Eigen::Vector3d(0.0, 0.25, 0.0);  // also the first
    bench.add(0, sensor, {seen});
  }
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_NEAR(bench.inWorld(bench.entities()[0]).y, 0.0, 0.05);
}

TEST(DoorMemory, ADoorwayStaysOneUntilALeafIsSeen) {
  MemoryBench bench;
  SightingMaker maker(8);
  driveBy(bench, maker, {.hasLeaf = false}, 10);
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_FALSE(doorOf(bench.entities()[0]).hasLeaf);
  EXPECT_EQ(doorOf(bench.entities()[0]).state, DoorState::kOpen);
  driveBy(bench, maker, {.state = DoorState::kAjar}, 10, 100.0);
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_TRUE(doorOf(bench.entities()[0]).hasLeaf);
  EXPECT_EQ(doorOf(bench.entities()[0]).state, DoorState::kAjar);
}

/// Taken for a closed door of its own: the leaf of a door at the origin, turned about its left jamb.
WorldDoor leafOf(const WorldDoor& door, double angle) {
  const Eigen::Vector2d hinge(0.0, door.width / 2.0);
  const Eigen::Vector2d middle = hinge + door.width / 2.0 * Eigen::Vector2d(std::sin(angle), -std::cos(angle));
  return {.pose = {middle.x(), middle.y(), angle}, .width = door.width, .hinge = HingeSide::kUnknown};
}

TEST(DoorMemory, ALeafTakenForAClosedDoorBelongsToItsOpenDoor) {
  for (const double angle : {0.4, 0.8, 1.5}) {
    MemoryBench bench;
    SightingMaker maker(18);
    const WorldDoor opening{.hasLeaf = false};
    driveBy(bench, maker, leafOf(opening, angle), 8);
    ASSERT_THAT(bench.entities(), SizeIs(1)) << angle;
    driveBy(bench, maker, opening, 12, 10.0);
    const auto entities = bench.entities();
    ASSERT_THAT(entities, SizeIs(1)) << angle;
    const auto pose = bench.inWorld(entities[0]);
    EXPECT_LT(std::hypot(pose.x, pose.y), 0.04) << angle;
    EXPECT_TRUE(doorOf(entities[0]).hasLeaf) << angle;
    EXPECT_EQ(doorOf(entities[0]).hingeSide, HingeSide::kLeft) << angle;
    EXPECT_EQ(doorOf(entities[0]).state, DoorState::kOpen) << angle;
  }
}

TEST(DoorMemory, ADoorRoundTheCornerIsNoLeaf) {
  const WorldDoor round{.pose = {0.35 + 0.45, 0.45 + 0.15, kPi / 2.0}, .hinge = HingeSide::kRight};
  for (const bool hasLeaf : {false, true}) {
    MemoryBench bench;
    SightingMaker maker(19);
    driveBy(bench, maker, {.hasLeaf = hasLeaf}, 12);
    driveBy(bench, maker, round, 12, 10.0);
    EXPECT_THAT(bench.entities(), SizeIs(2)) << hasLeaf;
  }
}

TEST(DoorMemory, AClosedDoorHasNoLeafElsewhere) {
  MemoryBench bench;
  SightingMaker maker(20);
  const WorldDoor door;
  driveBy(bench, maker, door, 12);
  driveBy(bench, maker, leafOf(door, 1.5), 12, 3.0);
  EXPECT_THAT(bench.entities(), SizeIs(2));
}

TEST(DoorMemory, OneOddReadingDoesNotOpenADoorButAFewDo) {
  MemoryBench bench;
  SightingMaker maker(9);
  driveBy(bench, maker, {}, 10);
  const auto sensor = before(0.0);
  bench.add(0, sensor, {maker.see({.state = DoorState::kOpen}, sensor, 2.2)});
  EXPECT_EQ(doorOf(bench.entities()[0]).state, DoorState::kClosed);
  for (int i = 0; i < 4; ++i) bench.add(0, sensor, {maker.see({.state = DoorState::kOpen}, sensor, 2.4 + 0.2 * i)});
  EXPECT_EQ(doorOf(bench.entities()[0]).state, DoorState::kOpen);
}

TEST(DoorMemory, AfterALongTimeTheFirstReadingTellsTheState) {
  MemoryBench bench;
  SightingMaker maker(10);
  driveBy(bench, maker, {}, 10);
  bench.add(0, before(0.0), {maker.see({.state = DoorState::kOpen}, before(0.0), 600.0)});
  EXPECT_EQ(doorOf(bench.entities()[0]).state, DoorState::kOpen);
}

TEST(DoorMemory, SeenFromTwoSubMapsIsOneWhereItIsSeenBest) {
  MemoryBench bench;
  bench.submaps[1] = geometry::toPose3({3.0, -4.0, 1.2});
  SightingMaker maker(11);
  const WorldDoor door{{0.0, 0.0, 0.0}};
  driveBy(bench, maker, door, 6);
  EXPECT_THAT(bench.entities(), SizeIs(1));
  for (int i = 0; i < 20; ++i) {
    const auto sensor = before(-1.0 + 0.2 * i);
    bench.add(1, sensor, {maker.see(door, sensor, 60.0 + i)});
  }
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_EQ(bench.entities()[0].submap, base::SubMapId{1});
  const auto pose = bench.inWorld(bench.entities()[0]);
  EXPECT_LT(std::hypot(pose.x, pose.y), 0.04);
  EXPECT_NEAR(pose.theta, 0.0, 0.03);
}

TEST(DoorMemory, DuplicatesOfDriftAreOneWhenTheirSubMapsConverge) {
  MemoryBench bench;
  SightingMaker maker(12);
  const WorldDoor door{{0.0, 0.0, 0.0}};
  driveBy(bench, maker, door, 10);
  bench.submaps[1] = geometry::toPose3({0.0, 2.5, 0.0});  // believed; it lies at the origin
  for (int i = 0; i < 10; ++i) {
    const auto sensor = before(-1.0 + 0.2 * i);
    bench.memory.add({1}, geometry::Pose3(Eigen::Translation3d(sensor)), std::vector{maker.see(door, sensor, 60.0 + i)},
                     bench.poses());
  }
  ASSERT_THAT(bench.entities(), SizeIs(2));
  bench.change();
  bench.submaps[1] = geometry::Pose3::Identity();
  bench.addFromGrid(1, {});
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_EQ(bench.entities()[0].id, base::EntityId{1}) << "the one that was there first";
  EXPECT_EQ(bench.entities()[0].observations, 20);
  EXPECT_THAT(bench.change().removedEntities, testing::ElementsAre(base::EntityId{2}));
}

TEST(DoorMemory, DoorsAboveEachOtherAreTwo) {
  MemoryBench bench;
  bench.submaps[1] = geometry::Pose3(Eigen::Translation3d(0.0, 0.0, 3.0));
  SightingMaker maker(13);
  driveBy(bench, maker, {}, 10);
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector3d sensor = before(-1.0 + 0.2 * i);
    bench.memory.add({1}, geometry::Pose3(Eigen::Translation3d(sensor)), std::vector{maker.see({}, sensor, 60.0 + i)},
                     bench.poses());
  }
  EXPECT_THAT(bench.entities(), SizeIs(2));
}

TEST(DoorMemory, GridsTellOfDoorwaysAndTakeThemBack) {
  MemoryBench bench;
  SightingMaker maker(14);
  const WorldDoor doorway{.pose = {0.0, 0.0, 0.0}, .hasLeaf = false};
  const auto seen = [&](double time) {
    auto sighting = maker.see(doorway, before(0.0), time);
    sighting.evidence = 4.0;
    return std::vector{sighting};
  };
  bench.addFromGrid(0, seen(1.0));
  bench.addFromGrid(0, seen(2.0));
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_FALSE(doorOf(bench.entities()[0]).hasLeaf);
  bench.change();
  bench.addFromGrid(0, {});
  EXPECT_THAT(bench.entities(), IsEmpty());
  EXPECT_THAT(bench.change().removedEntities, SizeIs(1));
}

std::vector<DoorSighting> doorwayAtOrigin(SightingMaker& maker, double evidence, double time = 1.0) {
  auto sighting = maker.see({.pose = {0.0, 0.0, 0.0}, .hasLeaf = false}, before(0.0), time);
  sighting.evidence = evidence;
  return {sighting};
}

TEST(DoorMemory, AGridThatNoLongerShowsADoorwayTakesBackWhatItSaidAndNoMore) {
  MemoryBench bench;
  bench.submaps[1] = bench.submaps[2] = geometry::Pose3::Identity();
  SightingMaker maker(18);
  for (const int submap : {0, 1}) bench.addFromGrid(submap, doorwayAtOrigin(maker, 3.5));
  ASSERT_THAT(bench.entities(), SizeIs(1));
  bench.addFromGrid(0, {});
  ASSERT_THAT(bench.entities(), SizeIs(1)) << "the other one still shows it";
  EXPECT_NEAR(bench.entities()[0].confidence, 1.0 / (1.0 + std::exp(1.0 - 3.5)), 1e-6);
}

TEST(DoorMemory, GridsThatShowThatThereIsNoDoorwayRefuteIt) {
  MemoryBench bench;
  SightingMaker maker(19);
  for (int i = 1; i < 30; ++i) bench.submaps[i] = geometry::Pose3::Identity();
  bench.addFromGrid(0, doorwayAtOrigin(maker, 3.5));
  for (int i = 1; i < 30; ++i) {
    bench.addFromGrid(i, {}, false);
    ASSERT_THAT(bench.entities(), SizeIs(1)) << "those that show nothing say nothing";
  }
  for (int i = 1; i < 30; ++i) bench.addFromGrid(i, {}, true);
  EXPECT_THAT(bench.entities(), IsEmpty());
}

TEST(DoorMemory, OneGridCountsOnceHoweverOftenItIsAsked) {
  MemoryBench bench;
  bench.submaps[1] = geometry::Pose3::Identity();
  SightingMaker maker(20);
  bench.addFromGrid(0, doorwayAtOrigin(maker, 3.5));
  for (int i = 0; i < 50; ++i) bench.addFromGrid(1, {}, true);
  EXPECT_THAT(bench.entities(), SizeIs(1));
  for (int i = 0; i < 50; ++i) bench.addFromGrid(1, doorwayAtOrigin(maker, 0.1), true);
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_NEAR(bench.entities()[0].confidence, 1.0 / (1.0 + std::exp(1.0 - 3.6)), 1e-6) << "the last word of each";
}

TEST(DoorMemory, AGridWithoutAnOpeningDoesNotSpeakAgainstALeaf) {
  MemoryBench bench;
  SightingMaker maker(21);
  driveBy(bench, maker, {}, 10);
  ASSERT_THAT(bench.entities(), SizeIs(1));
  const double before = bench.entities()[0].confidence;
  for (int i = 1; i < 40; ++i) {
    bench.submaps[i] = geometry::Pose3::Identity();
    bench.addFromGrid(i, {}, true);
  }
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_EQ(bench.entities()[0].confidence, before);
}

TEST(DoorMemory, OpeningsMayBeWiderThanLeaves) {
  SightingMaker maker(16);
  const auto entitiesOf = [&maker](double width, bool hasLeaf) {
    MemoryBench bench;
    auto sighting = maker.see({.pose = {0.0, 0.0, 0.0}, .width = width, .hasLeaf = hasLeaf}, before(0.0), 1.0);
    sighting.evidence = 4.0;
    bench.addFromGrid(0, std::vector{sighting});
    return bench.entities();
  };
  EXPECT_THAT(entitiesOf(3.8, false), SizeIs(1));
  EXPECT_THAT(entitiesOf(5.0, false), IsEmpty());
  EXPECT_THAT(entitiesOf(3.8, true), IsEmpty());
}

TEST(DoorMemory, WhatOneGridShowsVaguelyAnotherMayConfirmMuchLater) {
  MemoryBench bench;
  bench.submaps[1] = geometry::Pose3::Identity();
  SightingMaker maker(17);
  const WorldDoor doorway{.pose = {0.0, 0.0, 0.0}, .hasLeaf = false};
  const auto seen = [&](double time) {
    auto sighting = maker.see(doorway, before(0.0), time);
    sighting.since = test::at(time - 10.0);
    sighting.evidence = 2.0;
    return std::vector{sighting};
  };
  bench.addFromGrid(0, seen(20.0));
  EXPECT_THAT(bench.entities(), IsEmpty());
  bench.addFromGrid(1, seen(1000.0));
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_EQ(bench.entities()[0].firstSeen, test::at(10.0)) << "when the grid was begun";
}

TEST(DoorMemory, WhatCannotBeADoorIsPassedOver) {
  MemoryBench bench;
  SightingMaker maker(15);
  for (int i = 0; i < 20; ++i) {
    const auto sensor = before(0.2 * i);
    const auto good = maker.see({}, sensor, i);
    auto wide = good;
    wide.door.width = 5.0;
    auto nowhere = good;
    nowhere.T_submap_door.translation().x() = kNan;
    auto certain = good;
    certain.covariance.setZero();
    auto unmeasured = good;
    unmeasured.door.width = kNan;
    auto unheard = good;
    unheard.evidence = std::numeric_limits<double>::infinity();
    bench.add(0, sensor, {wide, nowhere, certain, unmeasured, unheard});
  }
  EXPECT_THAT(bench.entities(), IsEmpty());
  geometry::Pose3 lost = geometry::Pose3::Identity();
  lost.translation().setConstant(kNan);
  bench.memory.add({0}, lost, std::vector{maker.see({}, before(0.0), 0.0)}, bench.poses());
  EXPECT_THAT(bench.entities(), IsEmpty());
}

/// A corridor of doors with misses and clutter, from both directions, in sub-maps that turn.
TEST(DoorMemory, ACorridorWithMissesAndClutterIsMappedAsItIs) {
  MemoryBench bench;
  SightingMaker maker(16);
  auto& random = maker.random();
  std::vector<WorldDoor> doors;
  for (int i = 0; i < 10; ++i) {
    doors.push_back({.pose = {3.0 * i, i % 2 == 0 ? 1.2 : -1.2, i % 2 == 0 ? kPi / 2.0 : -kPi / 2.0},
                     .width = random.uniform(0.8, 1.1),
                     .hinge = random.uniform() < 0.5 ? HingeSide::kLeft : HingeSide::kRight});
  }
  for (int i = 0; i < 4; ++i) bench.submaps[i] = geometry::toPose3({8.0 * i, 0.0, 0.5 * i});
  int frame = 0;
  for (double x = -2.0; x < 29.0; x += 0.15, ++frame) {
    const Eigen::Vector3d sensor(x, 0.0, 1.2);
    const auto submap = std::min<std::int64_t>(3, static_cast<std::int64_t>(std::max(0.0, x) / 8.0));
    std::vector<DoorSighting> seen;
    for (const auto& door : doors) {
      const double ahead = door.pose.x - x;
      if (ahead > 0.5 && ahead < 4.0 && random.uniform() < 0.6) seen.push_back(maker.see(door, sensor, 0.2 * frame));
    }
    if (random.uniform() < 0.2) {  // clutter, never twice in the same place
      seen.push_back(
          maker.see({.pose = {x + 2.0, random.uniform(-1.2, 1.2), random.uniform(-kPi, kPi)}}, sensor, 0.2 * frame));
    }
    bench.add(submap, sensor, seen);
  }
  std::size_t found = 0;
  for (const auto& door : doors) {
    for (const auto& entity : bench.entities()) {
      const auto pose = bench.inWorld(entity);
      if (std::hypot(pose.x - door.pose.x, pose.y - door.pose.y) > 0.1) continue;
      ++found;
      EXPECT_NEAR(doorOf(entity).width, door.width, 0.05);
      EXPECT_EQ(doorOf(entity).hingeSide, door.hinge);
    }
  }
  EXPECT_EQ(found, doors.size());
  EXPECT_LE(bench.entities().size(), doors.size() + 1);
}

}  // namespace
}  // namespace prodomos::perception

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/entity_memory.hpp"

#include "perception/flat_world.hpp"
#include "perception/memory_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <optional>

namespace prodomos::perception {
namespace {

using map::DoorState;
using test::doorOf;
using test::MemoryBench;
using test::SightingMaker;
using test::WorldDoor;
using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;
using testing::SizeIs;

/// The robot looks along x at a wall 2 m ahead, with the door in it.
const WorldDoor kDoor{{2.0, 0.0, 0.0}};

Eigen::Vector3d cameraAt(double y) {
  return {0.0, y, 1.2};
}

/// What lies in the wall where the door is believed; what is further off than the wall lies 3 m behind it.
enum class Scene { kWall, kOpening, kAjarLeaf, kSomebodyBefore, kNoWall };

double depthBeyond(Scene scene, const Eigen::Vector3d& onWall) {
  constexpr double kWall = 2.0;
  constexpr double kBehind = 5.0;
  const bool isInDoor = std::abs(onWall.y()) < 0.45 && onWall.z() < 2.0;
  if (scene == Scene::kNoWall || (scene == Scene::kOpening && isInDoor)) return kBehind;
  if (scene == Scene::kAjarLeaf && isInDoor) return kWall + 0.25 * (onWall.y() + 0.45);
  if (scene == Scene::kSomebodyBefore && std::abs(onWall.y()) < 0.6) return 1.0;
  return kWall;
}

/// A view of 160 x 120 pixels from `camera`, along x.
struct Look {
  Look(Scene scene, const Eigen::Vector3d& camera, double time) {
    constexpr int kWidth = 160;
    constexpr int kHeight = 120;
    frame.camera = {100.0, 100.0, 79.5, 59.5, {}};
    frame.depth = sensors::Image<float>(kWidth, kHeight);
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u) {
        const Eigen::Vector3d onWall = camera + 2.0 * Eigen::Vector3d(1.0, (79.5 - u) / 100.0, (59.5 - v) / 100.0);
        frame.depth.row(v)[u] = static_cast<float>(depthBeyond(scene, onWall));
      }
    }
    surfaces.depth =
        sensors::DepthGrid(sensors::Camera(frame.camera, kWidth, kHeight), frame.depth, nullptr, 8.0, nullptr);
    view.emplace(RgbdView{.time = test::at(time),
                          .frame = frame,
                          .T_submap_camera = Eigen::Translation3d(camera) * sensors::cameraAxesInBody()});
  }

  sensors::RgbdFrame frame;
  Surfaces surfaces;
  std::optional<RgbdView> view;
};

void look(MemoryBench& bench, Scene scene, double y, double time) {
  const Look look(scene, cameraAt(y), time);
  bench.memory.look({0}, *look.view, look.surfaces, bench.poses());
}

void seeDoor(MemoryBench& bench, SightingMaker& maker, int frames, const WorldDoor& door = kDoor, double begin = 0.0) {
  for (int i = 0; i < frames; ++i) {
    const auto camera = cameraAt(-0.5 + 0.1 * i);
    bench.add(0, camera, {maker.see(door, camera, begin + 0.2 * i)});
  }
}

TEST(EntityMemory, OneSeesThroughADoorThatWasClosed) {
  MemoryBench bench;
  SightingMaker maker(1);
  seeDoor(bench, maker, 10);
  for (int i = 0; i < 5; ++i) look(bench, Scene::kOpening, 0.0, 10.0 + 0.2 * i);
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_EQ(doorOf(bench.entities()[0]).state, DoorState::kOpen);
  EXPECT_EQ(bench.entities()[0].lastSeen, test::at(10.8));
}

/// A level scan from there: the wall with what lies in its door, and 3 m behind it another one.
void scan(MemoryBench& bench, Scene scene, double y, double time) {
  test::FlatWorld world;
  for (const double side : {-1.0, 1.0}) world.addWall({2.0, side * 6.0}, {2.0, side * 0.45});
  world.addWall({5.0, -6.0}, {5.0, 6.0});
  if (scene == Scene::kWall) world.addWall({2.0, -0.45}, {2.0, 0.45});
  if (scene == Scene::kAjarLeaf) world.addWall({2.0, -0.45}, {2.6, 0.2});
  if (scene == Scene::kSomebodyBefore) world.addWall({1.0, -0.4}, {1.0, 0.4});
  const auto T_submap_sensor = geometry::toPose3({0.0, y, 0.0});
  bench.memory.look({0}, T_submap_sensor, world.scan({0.0, y, 0.0}), test::at(time), bench.poses());
}

TEST(EntityMemory, AScanTellsWhetherADoorIsClosed) {
  MemoryBench bench;
  SightingMaker maker(21);
  seeDoor(bench, maker, 10);
  for (int i = 0; i < 5; ++i) scan(bench, Scene::kOpening, 0.0, 10.0 + 0.2 * i);
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_NE(doorOf(bench.entities()[0]).state, DoorState::kClosed);
  EXPECT_GE(bench.entities()[0].lastSeen, test::at(10.0));
  for (int i = 0; i < 5; ++i) scan(bench, Scene::kWall, 0.2, 20.0 + 0.2 * i);
  EXPECT_EQ(doorOf(bench.entities()[0]).state, DoorState::kClosed);
  for (int i = 0; i < 5; ++i) scan(bench, Scene::kAjarLeaf, 0.0, 30.0 + 0.2 * i);
  EXPECT_NE(doorOf(bench.entities()[0]).state, DoorState::kClosed);
}

TEST(EntityMemory, AScanThatDoesNotShowADoorTellsNothingOfIt) {
  MemoryBench bench;
  SightingMaker maker(22);
  seeDoor(bench, maker, 10);
  for (int i = 0; i < 5; ++i) {
    scan(bench, Scene::kSomebodyBefore, 0.0, 10.0 + 0.2 * i);
    scan(bench, Scene::kOpening, 12.0, 10.1 + 0.2 * i);
  }
  auto lost = geometry::Pose3::Identity();
  lost.translation().x() = std::numeric_limits<double>::quiet_NaN();
  bench.memory.look({0}, lost, {}, test::at(20.0), bench.poses());
  bench.memory.look({0}, geometry::Pose3::Identity(), {}, test::at(20.0), bench.poses());
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_EQ(doorOf(bench.entities()[0]).state, DoorState::kClosed);
  EXPECT_LT(bench.entities()[0].lastSeen, test::at(10.0));
}

TEST(EntityMemory, WhatOneLooksThroughIsNoClosedLeafWhateverAnImageSays) {
  MemoryBench bench;
  SightingMaker maker(11);
  for (int i = 0; i < 10; ++i) {
    const auto camera = cameraAt(-0.5 + 0.1 * i);
    bench.add(0, camera, {maker.see(kDoor, camera, 0.2 * i)});
    look(bench, Scene::kOpening, -0.5 + 0.1 * i, 0.2 * i);
  }
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_FALSE(doorOf(bench.entities()[0]).hasLeaf);
  EXPECT_EQ(doorOf(bench.entities()[0]).state, DoorState::kOpen);
}

TEST(EntityMemory, ASurfaceInTheOpeningClosesTheDoor) {
  MemoryBench bench;
  SightingMaker maker(2);
  seeDoor(bench, maker, 10, {.pose = kDoor.pose, .state = DoorState::kOpen});
  EXPECT_EQ(doorOf(bench.entities()[0]).state, DoorState::kOpen);
  for (int i = 0; i < 5; ++i) look(bench, Scene::kWall, 0.0, 10.0 + 0.2 * i);
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_EQ(doorOf(bench.entities()[0]).state, DoorState::kClosed);
}

TEST(EntityMemory, ALeafThatTurnsOutOfTheWallIsNotClosedWhateverAnImageSays) {
  MemoryBench bench;
  SightingMaker maker(12);
  for (int i = 0; i < 10; ++i) {
    const auto camera = cameraAt(-0.5 + 0.1 * i);
    bench.add(0, camera, {maker.see(kDoor, camera, 0.2 * i)});
    look(bench, Scene::kAjarLeaf, -0.5 + 0.1 * i, 0.2 * i);
  }
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_TRUE(doorOf(bench.entities()[0]).hasLeaf);
  EXPECT_NE(doorOf(bench.entities()[0]).state, DoorState::kClosed);
}

TEST(EntityMemory, AGridDoesNotTellWhenADoorStoodOpen) {
  MemoryBench bench;
  SightingMaker maker(13);
  seeDoor(bench, maker, 10);
  WorldDoor doorway = kDoor;
  doorway.hasLeaf = false;
  bench.addFromGrid(0, std::vector{maker.see(doorway, cameraAt(0.0), 60.0)});
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_EQ(doorOf(bench.entities()[0]).state, DoorState::kClosed);
  EXPECT_EQ(bench.entities()[0].lastSeen, test::at(1.8));
}

TEST(EntityMemory, WhatIsWellSeenAndNeverFoundAgainIsGivenUp) {
  MemoryBench bench;
  SightingMaker maker(3);
  seeDoor(bench, maker, 6);
  ASSERT_THAT(bench.entities(), SizeIs(1));
  bench.change();
  for (int i = 0; i < 30; ++i) look(bench, Scene::kWall, -0.3 + 0.02 * i, 10.0 + 0.2 * i);
  EXPECT_THAT(bench.entities(), IsEmpty());
  const auto change = bench.change();
  EXPECT_THAT(change.removedEntities, ElementsAre(base::EntityId{1}));
  EXPECT_THAT(change.events, testing::Contains(Field(&map::Event::kind, "entity_removed")));
}

TEST(EntityMemory, WhereThereIsNoWallThereIsNoDoor) {
  MemoryBench bench;
  SightingMaker maker(4);
  seeDoor(bench, maker, 6);
  ASSERT_THAT(bench.entities(), SizeIs(1));
  for (int i = 0; i < 8; ++i) look(bench, Scene::kNoWall, -0.3 + 0.1 * i, 10.0 + 0.2 * i);
  EXPECT_THAT(bench.entities(), IsEmpty());
}

TEST(EntityMemory, ADoorThatIsHiddenIsNoDoorThatIsMissing) {
  MemoryBench bench;
  SightingMaker maker(5);
  seeDoor(bench, maker, 6);
  const auto before = bench.entities();
  for (int i = 0; i < 30; ++i) look(bench, Scene::kSomebodyBefore, -0.3 + 0.02 * i, 10.0 + 0.2 * i);
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_EQ(bench.entities()[0].confidence, before[0].confidence);
  EXPECT_EQ(doorOf(bench.entities()[0]).state, DoorState::kClosed);
}

TEST(EntityMemory, BadViewsChangeNothing) {
  MemoryBench bench;
  SightingMaker maker(6);
  seeDoor(bench, maker, 10);
  const auto before = bench.entities();
  const Look good(Scene::kNoWall, cameraAt(0.0), 10.0);
  auto lost = *good.view;
  lost.T_submap_camera.translation().x() = std::nan("");
  auto turned = *good.view;  // upside down
  turned.T_submap_camera = turned.T_submap_camera * Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ());
  for (int i = 0; i < 20; ++i) {
    bench.memory.look({0}, lost, good.surfaces, bench.poses());
    bench.memory.look({0}, *good.view, Surfaces{}, bench.poses());
  }
  ASSERT_THAT(bench.entities(), SizeIs(1));
  EXPECT_EQ(bench.entities()[0].confidence, before[0].confidence);
  EXPECT_EQ(doorOf(bench.entities()[0]).state, DoorState::kClosed);
}

TEST(EntityMemory, TellsWhatChangedAndEachSightingOnce) {
  MemoryBench bench;
  SightingMaker maker(7);
  seeDoor(bench, maker, 5);
  auto change = bench.change();
  ASSERT_THAT(change.entities, SizeIs(1));
  std::size_t detected = 0;
  for (const auto& event : change.events) {
    EXPECT_EQ(event.subject, "o1");
    detected += event.kind == "detected" ? 1U : 0U;
    if (event.kind == "door_state") {
      EXPECT_EQ(event.payload, "{\"state\": \"closed\"}");
    }
  }
  EXPECT_EQ(detected, 5U) << "also those before it was sure";
  EXPECT_THAT(change.events, SizeIs(6));
  change = bench.change();
  EXPECT_THAT(change.entities, IsEmpty());
  EXPECT_THAT(change.events, IsEmpty());

  seeDoor(bench, maker, 5, {.pose = kDoor.pose, .state = DoorState::kOpen}, 10.0);
  change = bench.change();
  EXPECT_THAT(change.entities, ElementsAre(Field(&map::Entity::observations, 10)));
  EXPECT_THAT(change.events, testing::Contains(testing::AllOf(Field(&map::Event::kind, "door_state"),
                                                              Field(&map::Event::payload, "{\"state\": \"open\"}"),
                                                              Field(&map::Event::time, testing::Gt(test::at(10.0))))));
}

TEST(EntityMemory, GoesOnBitByBitAfterSavingAndLoading) {
  MemoryBench straight;
  MemoryBench first;
  MemoryBench resumed;
  const auto run = [](MemoryBench& bench, std::uint64_t seed, double begin) {
    SightingMaker maker(seed);
    seeDoor(bench, maker, 8, kDoor, begin);
    seeDoor(bench, maker, 1, {.pose = {2.0, 3.0, 0.1}}, begin + 5.0);
    look(bench, Scene::kOpening, 0.1, begin + 6.0);
  };
  run(straight, 8, 0.0);
  run(first, 8, 0.0);
  base::ByteWriter out;
  first.memory.save(out);
  base::ByteReader in(out.bytes());
  resumed.memory.load(in);
  EXPECT_EQ(in.left(), 0U);
  resumed.lastId = first.lastId;
  run(straight, 9, 20.0);
  run(resumed, 9, 20.0);

  base::ByteWriter one;
  base::ByteWriter two;
  straight.memory.save(one);
  resumed.memory.save(two);
  EXPECT_EQ(one.bytes(), two.bytes());
  EXPECT_EQ(straight.change().events.size(), resumed.change().events.size());
}

TEST(EntityMemory, RefusesBytesThatAreCut) {
  MemoryBench bench;
  SightingMaker maker(9);
  seeDoor(bench, maker, 8);
  base::ByteWriter out;
  bench.memory.save(out);
  for (const std::size_t size : {std::size_t{0}, std::size_t{9}, out.bytes().size() / 2, out.bytes().size() - 1}) {
    base::ByteReader in(std::span(out.bytes()).first(size));
    MemoryBench other;
    EXPECT_THROW(other.memory.load(in), base::Error) << size;
  }
}

TEST(EntityMemory, ForgetsWhatWasNeverSure) {
  MemoryBench bench;
  SightingMaker maker(10);
  base::ByteWriter early;
  for (int i = 0; i < 2000; ++i) {  // clutter, a minute's worth of which is remembered
    const auto camera = cameraAt(0.0);
    const WorldDoor nothing{.pose = {50.0 * std::sin(i), 50.0 * std::cos(i), 0.1 * i}};
    bench.add(0, camera, {maker.see(nothing, camera, 2.0 * i)});
    if (i == 200) bench.memory.save(early);
  }
  base::ByteWriter late;
  bench.memory.save(late);
  EXPECT_LT(late.bytes().size(), 1.5 * static_cast<double>(early.bytes().size()));
}

}  // namespace
}  // namespace prodomos::perception

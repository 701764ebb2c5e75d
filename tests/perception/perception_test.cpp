// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/perception.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/simulation/person.hpp"
#include "prodomos/simulation/renderer.hpp"

#include "support/simulated_rooms.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace prodomos::perception {
namespace {

using geometry::Pose3;
using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::Key;
using ::testing::SizeIs;

constexpr base::SubMapId kSubMap{1};
const EntityMemory::SubMapPoses kOneSubMap = [](base::SubMapId) { return Pose3::Identity(); };

base::Time at(double seconds) {
  return base::Time(base::fromSeconds(1000.0 + seconds));
}

/// A room with a closed door in the wall ahead, at (3, 0.4), and somebody who stands before it to the right.
class Room {
 public:
  Room() : scene_(surfaces()), renderer_(scene_, {}, {.lamps = {{-1.0, 0.0, 2.6}, {1.5, 0.0, 2.6}}}) {}

  static Pose3 T_room_body(double step) { return geometry::toPose3({-1.2 + 0.1 * step, -0.1, 0.05}); }

  sensors::Reading frame(double step) const {
    sensors::RgbdFrame frame;
    frame.T_body_camera = geometry::Pose3(Eigen::Translation3d(0.0, 0.0, 1.2)) * sensors::cameraAxesInBody();
    frame.camera = renderer_.camera().intrinsics;
    auto rendering = renderer_.render(T_room_body(step) * frame.T_body_camera);
    frame.depth = rendering.depth;
    frame.color = rendering.color;
    return {at(step), "camera", frame, ""};
  }

  static simulation::Person person() {
    return {.id = "someone", .height = 1.75, .heading = std::numbers::pi, .way = {{0.0, {1.8, -1.2}}}, .look = 3};
  }

  /// As a program that sees joints would write them.
  sensors::Reading joints(double step) const {
    const auto state = simulation::stateOf(person(), 0.0, 5.0);
    const Pose3 T_camera_room =
        (T_room_body(step) * std::get<sensors::RgbdFrame>(frame(step).data).T_body_camera).inverse();
    sensors::PersonKeyPoints seen;
    for (const auto& joint : state.joints) {
      const Eigen::Vector2d pixel = simulation::project(renderer_.camera(), T_camera_room * joint);
      seen.joints.push_back({pixel.x(), pixel.y(), 0.9});
    }
    return {at(step), "camera", sensors::KeyPoints{{seen}}, ""};
  }

 private:
  static std::vector<simulation::Surface> surfaces() {
    auto all = test::emptyRoom({6.0, 5.0, 2.8});
    const auto add = [&](const Eigen::Vector3d& middle, const Eigen::Vector3d& size, sensors::Rgb color) {
      all.push_back(simulation::boxSurface(geometry::fromYawPitchRoll(middle, 0.0, 0.0, 0.0), size, {.color = color},
                                           simulation::classId("door"), 1));
    };
    add({2.98, 0.4, 1.02}, {0.04, 0.9, 2.04}, {120, 84, 52});
    add({2.96, -0.09, 1.04}, {0.08, 0.08, 2.08}, {92, 94, 98});
    add({2.96, 0.89, 1.04}, {0.08, 0.08, 2.08}, {92, 94, 98});
    add({2.96, 0.4, 2.08}, {0.08, 0.9, 0.08}, {92, 94, 98});
    add({2.93, 0.05, 1.0}, {0.06, 0.12, 0.03}, {190, 190, 195});
    for (auto& part : simulation::bodyAt(person(), 0.0, 5.0, 2)) all.push_back(std::move(part));
    return all;
  }

  simulation::RayScene scene_;
  simulation::Renderer renderer_;
};

const Room& room() {
  static const Room kRoom;
  return kRoom;
}

struct Session {
  explicit Session(const PerceptionConfig& config = {}) : perception(config, {1}, {}, {{10}, {20}}) {
    submap.node.id = kSubMap;
  }

  Session& see(const sensors::Reading& reading, double step) {
    const map::PlacedReading placed{.reading = reading, .T_submap_body = Room::T_room_body(step)};
    perception.perceive({placed, submap, 0.0}, kOneSubMap, times, notLookedAt);
    return *this;
  }
  Session& see(int from, int to) {
    for (int step = from; step < to; ++step) see(room().frame(step), step);
    return *this;
  }
  std::vector<map::Entity> doors() const {
    auto found = perception.entities();
    std::erase_if(found, [](const auto& entity) { return !std::holds_alternative<map::Door>(entity.attributes); });
    return found;
  }

  map::SubMap submap;
  base::StageTimes times;
  Perception perception;
  std::map<std::string, std::int64_t> notLookedAt;
};

sensors::Reading changed(const sensors::Reading& reading, const std::function<void(sensors::RgbdFrame&)>& change) {
  auto copy = reading;
  auto& frame = std::get<sensors::RgbdFrame>(copy.data);
  frame.depth = frame.depth.clone();
  change(frame);
  return copy;
}

TEST(Perception, ADoorThatIsApproachedBecomesOneEntity) {
  Session session;
  session.see(0, 8);
  const auto doors = session.doors();
  ASSERT_THAT(doors, SizeIs(1));
  const auto& door = std::get<map::Door>(doors[0].attributes);
  EXPECT_EQ(doors[0].submap, kSubMap);
  EXPECT_EQ(doors[0].id, base::EntityId{10});
  EXPECT_NEAR(doors[0].T_submap_entity.translation().x(), 2.96, 0.08);
  EXPECT_NEAR(doors[0].T_submap_entity.translation().y(), 0.4, 0.08);
  EXPECT_NEAR(door.width, 0.9, 0.08);
  EXPECT_TRUE(door.hasLeaf);
  EXPECT_EQ(door.state, map::DoorState::kClosed);
}

TEST(Perception, WhatHasChangedGoesIntoTheMapOnce) {
  Session session;
  session.see(0, 8);
  map::MapChange first;
  session.perception.addTo(first);
  EXPECT_THAT(first.entities, SizeIs(1));
  map::MapChange second;
  session.perception.addTo(second);
  EXPECT_THAT(second.entities, IsEmpty());
}

TEST(Perception, GoesOnFromACheckpointAsIfNothingHadHappened) {
  Session whole;
  whole.see(0, 8);
  Session before;
  before.see(0, 4);
  base::ByteWriter out;
  before.perception.save(out);
  Session after;
  base::ByteReader in(out.bytes());
  after.perception.load(in);
  EXPECT_EQ(in.left(), 0U);
  after.see(4, 8);
  base::ByteWriter expected;
  base::ByteWriter found;
  whole.perception.save(expected);
  after.perception.save(found);
  EXPECT_EQ(found.bytes(), expected.bytes());
}

TEST(Perception, JointsOfASideFileBecomeAPersonWhoIsFollowed) {
  Session session;
  for (int step = 0; step < 6; ++step) {
    session.see(room().frame(step), step);
    EXPECT_TRUE(session.perception.takeSideFile(room().joints(step), session.submap));
  }
  map::MapChange change;
  session.perception.addTo(change);
  ASSERT_THAT(change.tracks, SizeIs(1));
  EXPECT_EQ(change.tracks[0].id, base::TrackId{20});
  const Eigen::Vector3d position = change.tracks[0].states.back().T_submap_thing.translation();
  EXPECT_LT((position.head<2>() - Eigen::Vector2d(1.8, -1.2)).norm(), 0.12);
}

TEST(Perception, JointsOfAnotherImageAreOfNoUse) {
  Session session;
  session.see(room().frame(0), 0);
  EXPECT_FALSE(session.perception.takeSideFile(room().joints(1), session.submap));
  auto ofAnotherCamera = room().joints(0);
  ofAnotherCamera.sensor = "rear";
  EXPECT_FALSE(session.perception.takeSideFile(ofAnotherCamera, session.submap));
}

TEST(Perception, BadImagesInventNothingAndAreCounted) {
  Session session;
  const auto good = room().frame(0);
  const auto zeros = changed(good, [](auto& frame) { std::fill_n(frame.depth.data(), frame.depth.size(), 0.0F); });
  const auto nan = changed(good, [](auto& frame) {
    std::fill_n(frame.depth.data(), frame.depth.size(), std::numeric_limits<float>::quiet_NaN());
  });
  const auto odd = changed(good, [](auto& frame) { frame.color = sensors::Image<sensors::Rgb>(32, 24); });
  for (int i = 0; i < 4; ++i) session.see(zeros, i).see(nan, i).see(odd, i);
  EXPECT_THAT(session.perception.entities(), IsEmpty());
  EXPECT_EQ(session.notLookedAt.at("an image without depth"), 8);
  EXPECT_EQ(session.notLookedAt.at("an image whose colour and depth differ in size"), 4);
}

TEST(Perception, WithoutColourSaysWhatItCouldNotLookFor) {
  Session session;
  session.see(changed(room().frame(0), [](auto& frame) { frame.color = {}; }), 0);
  EXPECT_THAT(session.doors(), IsEmpty());
  EXPECT_THAT(session.notLookedAt, Contains(Key("closed doors and people: an image without colour")));
}

TEST(Perception, AnUpsideDownCameraInventsNothing) {
  Session session;
  for (int step = 0; step < 6; ++step) {
    session.see(changed(room().frame(step),
                        [](auto& frame) {
                          frame.T_body_camera =
                              frame.T_body_camera * Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ());
                        }),
                step);
  }
  EXPECT_THAT(session.perception.entities(), IsEmpty());
}

TEST(Perception, LooksAtImagesNoMoreOftenThanItIsTold) {
  PerceptionConfig config;
  config.rate = 0.5;
  Session session(config);
  session.see(0, 8);
  Session half;
  for (int step = 0; step < 8; step += 2) half.see(room().frame(step), step);
  ASSERT_EQ(session.doors().size(), half.doors().size());
  EXPECT_EQ(session.doors().at(0).observations, half.doors().at(0).observations);
}

/// Two rooms of 6 m by 4 m, one above the other along y, as a grid shows them; the wall between them, at y = 0, has a
/// gap of 0.9 m in its middle, or none.
map::OccupancyGrid twoRooms(bool haveDoorway) {
  const auto isWall = [haveDoorway](double x, double y) {
    const bool isOutside = std::abs(x) > 3.0 || std::abs(y) > 4.0;
    const bool isBetween = std::abs(y) < 0.08 && !(haveDoorway && std::abs(x) < 0.45);
    return isOutside || isBetween;
  };
  map::OccupancyGrid grid;
  for (const double side : {-2.0, 2.0}) {
    const Eigen::Vector2d origin(0.3, side);
    std::vector<map::OccupancyGrid::Beam> beams;
    for (int i = 0; i < 1440; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / 1440;
      Eigen::Vector2d end = origin;
      while (!isWall(end.x(), end.y())) end += 0.01 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      beams.push_back({end, true});
    }
    for (int scan = 0; scan < 4; ++scan) grid.insert(origin, beams);
  }
  return grid;
}

TEST(Perception, FindsDoorwaysInWhatIsKnownAroundASubMap) {
  Session session;
  session.perception.lookAround({kSubMap, twoRooms(true), at(10.0), at(30.0)}, kOneSubMap);
  ASSERT_THAT(session.doors(), SizeIs(1));
  const auto doorway = session.doors().at(0);
  EXPECT_EQ(doorway.submap, kSubMap);
  EXPECT_LT(doorway.T_submap_entity.translation().head<2>().norm(), 0.1);
  EXPECT_NEAR(std::get<map::Door>(doorway.attributes).width, 0.9, 0.1);
  EXPECT_FALSE(std::get<map::Door>(doorway.attributes).hasLeaf);
  EXPECT_EQ(doorway.firstSeen, at(10.0)) << "when the oldest of the grids was begun";
  EXPECT_EQ(doorway.lastSeen, at(30.0));
}

TEST(Perception, TheLastLookAroundASubMapCounts) {
  Session session;
  session.perception.lookAround({kSubMap, twoRooms(true), at(10.0), at(30.0)}, kOneSubMap);
  session.perception.lookAround({kSubMap, twoRooms(false), at(10.0), at(50.0)}, kOneSubMap);
  EXPECT_THAT(session.doors(), IsEmpty());
  session.perception.lookAround({kSubMap, twoRooms(true), at(10.0), at(70.0)}, kOneSubMap);
  EXPECT_THAT(session.doors(), SizeIs(1));
}

TEST(Perception, ADoorwayIsInTheMapOnceHoweverManySubMapsKnowIt) {
  Session session;
  const auto poses = [](base::SubMapId submap) { return geometry::toPose3({0.0, submap == kSubMap ? 0.0 : 1.0, 0.0}); };
  session.perception.lookAround({kSubMap, twoRooms(true), at(10.0), at(30.0)}, poses);
  map::OccupancyGrid moved;  // the same rooms in the other one's frame
  const auto rooms = twoRooms(true);
  moved.merge(rooms, geometry::toPose3({0.0, -1.0, 0.0}));
  session.perception.lookAround({{2}, moved, at(30.0), at(50.0)}, poses);
  ASSERT_THAT(session.doors(), SizeIs(1));
  EXPECT_EQ(session.doors().at(0).observations, 2);
}

TEST(Perception, LooksAroundForNothingWhereItIsSwitchedOff) {
  PerceptionConfig config;
  config.doorways.enabled = false;
  Session without(config);
  config.doorways.enabled = true;
  config.enabled = false;
  Session off(config);
  for (auto* session : {&without, &off}) {
    session->perception.lookAround({kSubMap, twoRooms(true), at(10.0), at(30.0)}, kOneSubMap);
    EXPECT_THAT(session->perception.entities(), IsEmpty());
  }
}

TEST(Perception, AGridThatKnowsNothingHasNoDoorways) {
  Session session;
  session.perception.lookAround({kSubMap, map::OccupancyGrid(), at(10.0), at(30.0)}, kOneSubMap);
  EXPECT_THAT(session.perception.entities(), IsEmpty());
}

TEST(Perception, SwitchedOffFindsNothing) {
  PerceptionConfig config;
  config.enabled = false;
  Session session(config);
  session.see(0, 4);
  EXPECT_THAT(session.perception.entities(), IsEmpty());
  EXPECT_FALSE(session.perception.takeSideFile(room().joints(0), session.submap));
}

TEST(Perception, AFolderWithoutTheNetworksIsNamed) {
  PerceptionConfig config;
  config.people.models = "/nowhere/models";
  EXPECT_THAT([&] { Perception(config, {1}, {}, {}); },
              ::testing::ThrowsMessage<base::FileError>(::testing::HasSubstr("/nowhere/models")));
}

TEST(PerceptionConfig, EveryKeyIsPrintedAndReadBack) {
  PerceptionConfig config;
  config.rate = 7.5;
  config.people.rate = 3.0;
  const auto text = base::writeConfig(config, false);
  const auto again = base::readConfig<PerceptionConfig>({{}, text, {}});
  EXPECT_EQ(base::writeConfig(again, false), text);
  EXPECT_EQ(again.rate, 7.5);
}

}  // namespace
}  // namespace prodomos::perception

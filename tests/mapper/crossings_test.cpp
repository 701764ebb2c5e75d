// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/crossings.hpp"

#include "prodomos/base/random.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

namespace prodomos::mapper {
namespace {

using Way = std::vector<Eigen::Vector3d>;
using base::EntityId;
using testing::SizeIs;

Passage door(std::int64_t id, const geometry::Pose2& pose, double width = 0.9) {
  return {{id}, geometry::toPose3(pose), width / 2.0, 0.0};
}

const Passage kAhead = door(1, {2.0, 0.0, 0.0});  // in the wall x = 2

TEST(DoorCrossed, IsTheOneThatTheWayLeadsThrough) {
  const Way way{{0, 0, 0}, {1, 0.2, 0}, {3, 0.1, 0}};
  const auto crossed = doorCrossed(way, {{door(0, {2.0, 3.0, 0.0}), kAhead}});
  ASSERT_TRUE(crossed);
  EXPECT_EQ(crossed->entity, EntityId{1});
  EXPECT_NEAR(crossed->beyond, 1.0, 1e-9);
}

TEST(DoorCrossed, IsNoneBesideTheDoorBeforeItAndOnAnotherFloor) {
  EXPECT_FALSE(doorCrossed(Way{{0, 2, 0}, {3, 2, 0}}, {{kAhead}}));
  EXPECT_FALSE(doorCrossed(Way{{0, 0, 0}, {1.9, 0, 0}}, {{kAhead}}));
  EXPECT_FALSE(doorCrossed(Way{{0, 0, 3}, {3, 0, 3}}, {{kAhead}}));
  EXPECT_FALSE(doorCrossed(Way{}, {{kAhead}}));
  EXPECT_FALSE(doorCrossed(Way{{0, 0, 0}}, {{kAhead}}));
}

TEST(DoorCrossed, IsNoneWhereTheWayComesBack) {
  EXPECT_FALSE(doorCrossed(Way{{0, 0, 0}, {3, 0, 0}, {1, 0, 0}}, {{kAhead}}));
  EXPECT_TRUE(doorCrossed(Way{{0, 0, 0}, {3, 0, 0}, {1, 0, 0}, {3, 0.3, 0}}, {{kAhead}}));
}

TEST(DoorCrossed, IsTheLastOfSeveral) {
  const Way way{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}};
  const auto side = door(2, {3.0, 2.0, std::numbers::pi / 2.0});
  EXPECT_EQ(doorCrossed(way, {{kAhead, side}})->entity, EntityId{2});
  EXPECT_EQ(doorCrossed(way, {{side, kAhead}})->entity, EntityId{2});
}

TEST(DoorCrossed, IsTheSameWhicheverWayAllIsTurned) {
  base::Random random(11, "crossings");
  for (int run = 0; run < 200; ++run) {
    Way way{Eigen::Vector3d::Zero()};
    for (int i = 0; i < 12; ++i) way.push_back({random.uniform(-4.0, 4.0), random.uniform(-4.0, 4.0), 0.0});
    std::vector<Passage> doors;
    for (int i = 0; i < 5; ++i) {
      doors.push_back(door(i, {random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0)}, 1.5));
    }
    const auto before = doorCrossed(way, doors);
    const auto T = geometry::toPose3({random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0), random.uniform(-3.0, 3.0)});
    for (auto& spot : way) spot = T * spot;
    for (auto& passage : doors) passage.T_map_passage = T * passage.T_map_passage;
    const auto after = doorCrossed(way, doors);
    ASSERT_EQ(before.has_value(), after.has_value());
    if (before) {
      EXPECT_EQ(before->entity, after->entity);
    }
    // There and back again is no crossing.
    way.insert(way.end(), way.rbegin() + 1, way.rend());
    EXPECT_FALSE(doorCrossed(way, doors));
  }
}

TEST(Passages, AreDoorsAndStairsAndNothingElse) {
  std::vector<map::Entity> entities(4);
  for (std::size_t i = 0; i < entities.size(); ++i) {
    entities[i].id = {static_cast<std::int64_t>(i)};
    entities[i].submap = {1};
    entities[i].T_submap_entity = geometry::toPose3({1.0, 0.0, 0.0}, 1.1);
  }
  entities[0].attributes = map::Door{.width = 0.8};
  entities[1].attributes = map::Human{};
  entities[2].attributes =
      map::Staircase{.height = 1.7, .stepWidth = 1.2, .stepHeight = 0.17, .stepDepth = 0.3, .stepCount = 10};
  entities[3].attributes = map::Staircase{.height = 1.7, .stepWidth = 1.2};  // nobody knows where it ends
  const auto passages = passagesOf(entities, [](base::SubMapId) { return geometry::toPose3({5.0, 5.0, 0.0}); });
  ASSERT_THAT(passages, SizeIs(2));
  EXPECT_TRUE(passages[0].T_map_passage.translation().isApprox(Eigen::Vector3d(6.0, 5.0, 0.0))) << "on the floor";
  EXPECT_EQ(passages[0].halfWidth, 0.4);
  EXPECT_EQ(passages[1].entity, EntityId{2});
  EXPECT_GT(passages[1].halfRun, 1.0);
}

TEST(NameWay, TellsDoorsOfWaysAndOfLoops) {
  const Way through{{0, 0, 0}, {3, 0, 0}};
  const Way before{{0, 0, 0}, {1, 0, 0}};
  map::Edge edge;
  nameWay(edge, through, {{kAhead}});
  EXPECT_EQ(edge.kind, map::EdgeKind::kDoor);
  EXPECT_EQ(edge.cause, EntityId{1});
  nameWay(edge, through, {});  // the door was none
  EXPECT_EQ(edge.kind, map::EdgeKind::kTravelled);
  EXPECT_EQ(edge.cause, std::nullopt);
  edge.kind = map::EdgeKind::kLoop;
  nameWay(edge, through, {{kAhead}});
  EXPECT_EQ(edge.kind, map::EdgeKind::kLoop);
  EXPECT_EQ(edge.cause, EntityId{1});
  nameWay(edge, before, {{kAhead}});
  EXPECT_EQ(edge.cause, std::nullopt);
  edge.kind = map::EdgeKind::kStairs;
  nameWay(edge, through, {{kAhead}});
  EXPECT_EQ(edge.kind, map::EdgeKind::kStairs);
  EXPECT_EQ(edge.cause, std::nullopt) << "a door is no flight";
}

TEST(FlightClimbed, IsTheOneThatTheWayGoesAlong) {
  const Passage flight{{7}, geometry::toPose3({3.0, 0.0, 0.0}), 0.6, 1.5};
  const Passage beside{{8}, geometry::toPose3({3.0, 2.0, 0.0}), 0.6, 1.5};
  EXPECT_EQ(flightClimbed(Way{{0, 0, 0}, {2, 0, 0.5}, {4, 0.1, 1.5}, {6, 0, 1.7}}, {{beside, flight}}), EntityId{7});
  EXPECT_FALSE(flightClimbed(Way{{0, -1, 0}, {6, -1, 0}}, {{beside, flight}}));
  EXPECT_FALSE(flightClimbed(Way{{3, 0, 0}}, {{kAhead}}));
}

}  // namespace
}  // namespace prodomos::mapper

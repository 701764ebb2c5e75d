// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/worlds/room_outlines.hpp"

#include "tiny_world.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <numbers>

namespace prodomos::simulation {
namespace {

/// Walls of a rectangle, turned about the origin.
void addRectangleOf(std::vector<Segment>& walls, const Eigen::AlignedBox2d& box, double angle = 0.0) {
  auto corners = cornersOf(box);
  for (auto& corner : corners) corner = Eigen::Rotation2Dd(angle) * corner;
  for (std::size_t i = 0; i < corners.size(); ++i) walls.push_back({corners[i], corners[(i + 1) % corners.size()]});
}

Eigen::AlignedBox2d box(double x0, double y0, double x1, double y1) {
  return {Eigen::Vector2d(x0, y0), Eigen::Vector2d(x1, y1)};
}

TEST(RoomOutlines, FollowTheFacesOfTheWalls) {
  std::vector<Segment> walls;
  addRectangleOf(walls, box(-0.123, -0.123, 4.141, 3.131));
  addRectangleOf(walls, box(0.013, 0.017, 4.023, 3.019));
  const auto rooms = roomOutlines(walls, {});
  ASSERT_EQ(rooms.size(), 1U);
  EXPECT_EQ(rooms[0].size(), 4U);
  EXPECT_NEAR(signedArea(rooms[0]), 4.010 * 3.002, 1e-3);
}

TEST(RoomOutlines, WallsMayStandAtAnyAngle) {
  for (const double degrees : {7.0, 30.0, 45.0, 81.0}) {
    std::vector<Segment> walls;
    addRectangleOf(walls, box(0, 0, 5, 3), degrees * std::numbers::pi / 180.0);
    const auto rooms = roomOutlines(walls, {});
    ASSERT_EQ(rooms.size(), 1U) << degrees;
    EXPECT_EQ(rooms[0].size(), 4U) << degrees;
    EXPECT_NEAR(signedArea(rooms[0]), 15.0, 0.05) << degrees;
  }
}

TEST(RoomOutlines, AnOpenRoomIsOutsideUntilItsDoorIsClosed) {
  const std::vector<Segment> walls{
      {{0, 0}, {4, 0}}, {{4, 0}, {4, 3}}, {{4, 3}, {0, 3}}, {{0, 3}, {0, 2}}, {{0, 1}, {0, 0}}};
  EXPECT_TRUE(roomOutlines(walls, {}).empty());
  const std::vector<Polygon> closures{cornersOf(box(-0.08, 0.98, 0.08, 2.02))};
  const auto rooms = roomOutlines(walls, closures);
  ASSERT_EQ(rooms.size(), 1U);
  EXPECT_NEAR(signedArea(rooms[0]), 12.0, 0.1);
}

TEST(RoomOutlines, TheInsideOfAHollowWallIsNoRoom) {
  std::vector<Segment> walls;
  addRectangleOf(walls, box(0, 0, 30, 30));
  addRectangleOf(walls, box(-0.3, -0.3, 30.3, 30.3));
  EXPECT_EQ(roomOutlines(walls, {}).size(), 1U);
}

TEST(RoomOutlines, ARoomRoundOthersIsSimpleAndLeavesThemOut) {
  std::vector<Segment> walls;
  addRectangleOf(walls, box(0, 0, 20, 10));
  for (const double x : {3.0, 8.0, 13.0}) {
    addRectangleOf(walls, box(x, 3, x + 4, 7));
    addRectangleOf(walls, box(x + 0.12, 3.12, x + 3.88, 6.88));
  }
  const auto rooms = roomOutlines(walls, {});
  ASSERT_EQ(rooms.size(), 4U);
  EXPECT_NEAR(signedArea(rooms[0]), 200.0 - 3 * 16.0, 0.05);
  for (const auto& room : rooms) EXPECT_FALSE(findSelfCrossing(room));
  // One slit a block, each with two sides.
  int slits = 0;
  for (std::size_t i = 0; i < rooms[0].size(); ++i) slits += isSlit(rooms[0], i);
  EXPECT_EQ(slits, 6);
  EXPECT_TRUE(contains(rooms[0], {1, 1}));
  EXPECT_TRUE(contains(rooms[0], {7.5, 5}));
  EXPECT_FALSE(contains(rooms[0], {5, 5}));
  EXPECT_TRUE(contains(rooms[1], {5, 5}));
}

TEST(RoomOutlines, ClosetsAreLeftOut) {
  std::vector<Segment> walls;
  addRectangleOf(walls, box(0, 0, 1.2, 1.2));
  EXPECT_TRUE(roomOutlines(walls, {}).empty());
  EXPECT_TRUE(roomOutlines({}, {}).empty());
}

}  // namespace
}  // namespace prodomos::simulation

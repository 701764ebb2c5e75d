// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/footprint.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prodomos::exporter {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr map::Door kDoor{.width = 0.9, .hingeSide = map::HingeSide::kLeft, .state = map::DoorState::kClosed};

TEST(DoorPlan, AClosedLeafSpansItsOpeningFromTheHinge) {
  const auto plan = doorPlan(kDoor);
  ASSERT_THAT(plan.leaf, SizeIs(2));
  EXPECT_TRUE(plan.leaf[0].isApprox(Eigen::Vector2d(0.0, 0.45)));
  EXPECT_TRUE(plan.leaf[1].isApprox(Eigen::Vector2d(0.0, -0.45)));
}

TEST(DoorPlan, AnOpenLeafStandsAheadOfItsHinge) {
  auto door = kDoor;
  door.state = map::DoorState::kOpen;
  EXPECT_TRUE(doorPlan(door).leaf[1].isApprox(Eigen::Vector2d(0.9, 0.45)));
  door.hingeSide = map::HingeSide::kRight;
  EXPECT_TRUE(doorPlan(door).leaf[1].isApprox(Eigen::Vector2d(0.9, -0.45)));
}

TEST(DoorPlan, TheLeafSwingsAboutItsHinge) {
  for (const auto& point : doorPlan(kDoor).swing) {
    EXPECT_NEAR((point - Eigen::Vector2d(0.0, 0.45)).norm(), 0.9, 1e-12);
    EXPECT_GE(point.x(), 0.0);
  }
}

TEST(DoorPlan, WithoutKnownHingesThereIsNoSwing) {
  auto door = kDoor;
  door.hingeSide = map::HingeSide::kUnknown;
  EXPECT_THAT(doorPlan(door).swing, IsEmpty());
  EXPECT_THAT(doorPlan(door).leaf, SizeIs(2));
}

TEST(DoorPlan, ADoorwayIsItsThreshold) {
  auto doorway = kDoor;
  doorway.hasLeaf = false;
  doorway.state = map::DoorState::kOpen;
  const auto plan = doorPlan(doorway);
  EXPECT_THAT(plan.swing, IsEmpty());
  EXPECT_EQ(plan.leaf[0].x(), 0.0);
  EXPECT_EQ(plan.leaf[1].x(), 0.0);
}

TEST(Footprint, LiesWhereItsSubMapDoes) {
  map::Entity entity;
  entity.attributes = kDoor;
  entity.T_submap_entity = geometry::toPose3({1.0, 0.0, 0.0});
  const auto lines = footprint(entity, geometry::toPose3({10.0, 20.0, 1.5707963267948966}));
  ASSERT_FALSE(lines.empty());
  EXPECT_TRUE(lines[0][0].isApprox(Eigen::Vector2d(9.55, 21.0), 1e-9));
}

}  // namespace
}  // namespace prodomos::exporter

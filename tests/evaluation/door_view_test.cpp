// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/door_view.hpp"

#include "prodomos/evaluation/baselines.hpp"

#include "evaluation/small_building.hpp"

#include <gtest/gtest.h>

namespace prodomos::evaluation {
namespace {

using test::kQuarter;
using test::rectangle;

bool nothing(const Eigen::Vector2d& /*point*/) {
  return false;
}

/// Of a door at the origin that looks along x.
DoorView viewOf(const Polygon& room, const std::function<bool(const Eigen::Vector2d&)>& isKnown = nothing) {
  return {{}, room, isKnown};
}

TEST(DoorView, OverlapsAreWhatOneReckonsByHand) {
  const auto view = viewOf(rectangle(0.1, -2, 4.1, 2));
  EXPECT_NEAR(view.roomArea(), 16.0, 1e-6);
  EXPECT_NEAR(view.iou(DoorBox{2, 2, 4.1}), 1.0, 1e-6);
  EXPECT_NEAR(view.iou(DoorBox{2, 0, 4.1}), 0.5, 1e-6);
  EXPECT_NEAR(view.iou(DoorBox{2, 2, 8.1}), 0.5, 1e-6);
  EXPECT_NEAR(view.iou(DoorBox{1, 1, 2.1}), 4.0 / 16.0, 1e-6);
  EXPECT_NEAR(view.iou(rectangle(0.1, -2, 4.1, 2)), 1.0, 1e-6);
  EXPECT_NEAR(view.iou(rectangle(-7.9, -2, 4.1, 2)), 1.0 / 3.0, 1e-6);
  EXPECT_EQ(view.iou(rectangle(-3, -2, -1, 2)), 0.0);
  EXPECT_EQ(view.iou(Polygon{}), 0.0);
  EXPECT_EQ(view.iou(DoorBox{0, 0, 3}), 0.0);
}

TEST(DoorView, IsTheSameFromEverywhere) {
  const geometry::Pose2 T_world_door{10, -3, 2.0};
  const auto room = transformed(T_world_door, rectangle(0.1, -1, 4.1, 3));
  const DoorView view(T_world_door, room, nothing);
  EXPECT_NEAR(view.iou(DoorBox{2, 2, 4.1}), 12.0 / 20.0, 0.01);  // 3 of 4 m of either
  EXPECT_NEAR(view.iou(room), 1.0, 1e-9);
}

TEST(DoorView, ARoomMayBeToldAsCells) {
  const geometry::Pose2 door{3.0, -2.0, 0.7};
  const auto room = geometry::transformed(door, test::rectangle(0.1, -2, 4.1, 3));
  CellMap<std::uint8_t> cells(geometry::boxOf({room}), 0);
  cells.fill(room, 2);
  const auto nothing = [](const Eigen::Vector2d&) { return false; };
  const DoorView asPolygon(door, room, nothing);
  const DoorView asCells(door, cells, nothing);
  EXPECT_NEAR(asCells.roomArea(), asPolygon.roomArea(), 0.1);
  const DoorBox box{1.0, 1.0, 2.0};
  EXPECT_NEAR(asCells.iou(box), asPolygon.iou(box), 0.01);
  EXPECT_GT(asCells.iou(room), 0.97);
}

TEST(DoorView, OfARoomThatReachesFarCountsAllOfIt) {
  const auto view = viewOf(rectangle(0.1, -30, 4.1, 30));
  EXPECT_NEAR(view.roomArea(), 240.0, 1e-6);
  EXPECT_NEAR(view.iou(DoorBox{2, 2, 4.1}), 16.0 / 240.0, 1e-6);
}

TEST(DoorView, HalfDiscsGrowIntoTheRoomAndBeyond) {
  const auto ious = viewOf(rectangle(0.1, -2, 4.1, 2)).iousOfHalfDiscs();
  const auto of = [&](double radius) { return ious[radiusIndex(radius) - 1]; };
  // From 0.1 m on, so a little less than half a disc.
  EXPECT_NEAR(of(1.0), (std::numbers::pi / 2 - 0.2) / 16.0, 0.01);
  EXPECT_NEAR(of(2.0), (2 * std::numbers::pi - 0.4) / 16.0, 0.02);
  EXPECT_GT(of(3.0), of(2.0));
  EXPECT_LT(of(6.0), of(3.0));
  EXPECT_NEAR(of(15.0), 16.0 / (112.5 * std::numbers::pi), 0.01);
}

TEST(DoorView, ClipsAtWhatIsKnown) {
  const auto beyond = [](const Eigen::Vector2d& point) { return point.x() > 4.1 || point.y() > 2.0; };
  const auto view = viewOf(rectangle(0.1, -2, 4.1, 2), beyond);
  EXPECT_NEAR(view.iouClipped({5, 2, 9}), 1.0, 1e-6);
  EXPECT_NEAR(view.iouClipped({5, 6, 9}), 0.5, 1e-6);  // nothing is known on the right
  EXPECT_NEAR(viewOf(rectangle(0.1, -2, 4.1, 2)).iouClipped({2, 2, 8.1}), 0.5, 1e-6);
}

TEST(DoorView, KeepsWhatHangsTogetherWithTheDoor) {
  // A known wall across, thinner than the box is deep.
  const auto wall = [](const Eigen::Vector2d& point) { return point.x() > 2.1 && point.x() < 2.2; };
  const auto view = viewOf(rectangle(0.1, -2, 2.1, 2), wall);
  EXPECT_NEAR(view.iouClipped({2, 2, 6}), 1.0, 1e-6);
  const auto withGap = [&](const Eigen::Vector2d& point) { return wall(point) && std::abs(point.y()) > 0.2; };
  EXPECT_LT(viewOf(rectangle(0.1, -2, 2.1, 2), withGap).iouClipped({2, 2, 6}), 0.4);
}

TEST(DoorView, WhereAllIsKnownNothingIsLeft) {
  const auto view = viewOf(rectangle(0.1, -2, 4.1, 2), [](const Eigen::Vector2d&) { return true; });
  EXPECT_EQ(view.iouClipped({2, 2, 4}), 0.0);
}

TEST(DoorView, FindsTheBestBox) {
  const auto view = viewOf(rectangle(0.1, -1.35, 3.4, 2.6));
  const auto best = view.bestBox();
  EXPECT_NEAR(best.left, 2.6, 1e-6);
  EXPECT_NEAR(best.right, 1.35, 1e-6);
  EXPECT_NEAR(best.depth, 3.4, 1e-6);
  EXPECT_NEAR(view.iou(best), 1.0, 1e-9);
}

TEST(DoorView, TheBestBoxOfAnAngledRoomIsNoWorseThanOthers) {
  const Polygon room = {{0.1, -1}, {3, -1}, {3, -4}, {6, -4}, {6, 2}, {0.1, 2}};
  const auto view = viewOf(room);
  const double best = view.iou(view.bestBox());
  for (double left = 0.5; left < 5; left += 0.37) {
    for (double right = 0.5; right < 5; right += 0.41) {
      for (double depth = 1; depth < 8; depth += 0.53) EXPECT_GE(best, view.iou(DoorBox{left, right, depth}));
    }
  }
}

TEST(BaselineFit, FindsTheSizeThatAllRoomsHave) {
  BaselineFit fit;
  for (const double shift : {-0.5, 0.0, 0.5}) {
    fit.add({{}, rectangle(0.1, -2 + shift, 3.6, 2 + shift), nothing, 0.1});
  }
  const auto best = fit.best();
  EXPECT_EQ(fit.count(), 3U);
  EXPECT_NEAR(best.sizes.fixedBox.depth, 3.6, 1e-9);
  EXPECT_NEAR(best.sizes.fixedBox.left, 2.0, 0.31);
  EXPECT_EQ(best.sizes.fixedBox.left, best.sizes.fixedBox.right);
  EXPECT_NEAR(best.sizes.clippedBox.depth, 3.5, 1e-9);
  EXPECT_GT(best.fixedBox, best.halfDisc);
  EXPECT_GT(best.sizes.halfDiscRadius, 2.0);
  EXPECT_LT(best.sizes.halfDiscRadius, 4.0);
}

TEST(BaselineFit, ABoxThatIsClippedMayBeTooGreat) {
  BaselineFit fit;
  for (const double half : {1.0, 1.5, 2.5}) {
    const auto beyond = [half](const Eigen::Vector2d& point) {
      return point.x() > 2 * half || std::abs(point.y()) > half;
    };
    fit.add({{}, rectangle(0.1, -half, 2 * half, half), beyond, 0.1});
  }
  const auto best = fit.best();
  EXPECT_NEAR(best.clippedBox, 1.0, 1e-9);
  EXPECT_GE(best.sizes.clippedBox.depth, 5.0);
  EXPECT_LT(best.fixedBox, 0.8);
}

TEST(TrainedBaselines, AreSensible) {
  const auto& trained = trainedBaselines();
  EXPECT_GT(trained.halfDiscRadius, 1.0);
  EXPECT_LT(trained.halfDiscRadius, 10.0);
  EXPECT_EQ(trained.fixedBox.left, trained.fixedBox.right);
  EXPECT_GE(trained.clippedBox.depth, trained.fixedBox.depth);
}

}  // namespace
}  // namespace prodomos::evaluation

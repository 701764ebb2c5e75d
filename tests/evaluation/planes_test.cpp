// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/planes.hpp"

#include "evaluation/flat.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prodomos::evaluation {
namespace {

using test::FlatMap;
using test::flat::kFloor;
using Polygon = std::vector<Eigen::Vector2d>;

Polygon rectangle(double x, double y, double width, double height) {
  return {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
}

/// The wall at the end of the flat; plane's x along it, y up, normal into room a. 4 x 2.8 m.
geometry::Pose3 farWall() {
  geometry::Pose3 T_world_plane = geometry::Pose3::Identity();
  T_world_plane.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  T_world_plane.translation() << 0.0, 0.0, kFloor;
  return T_world_plane;
}

TruePlane planeOf(const std::string& id, const geometry::Pose3& T_world_plane, const Polygon& outline) {
  return {
      .id = id, .classId = 1, .storey = 1, .T_world_plane = T_world_plane, .outline_in_plane = outline, .seen = 100.0};
}

/// That wall, and the floor of room a.
Truth walled() {
  auto truth = test::flat::truth();
  truth.planes = {planeOf("wall", farWall(), rectangle(0, 0, 4, 2.8)),
                  planeOf("floor", geometry::toPose3({0, 0, 0}, kFloor), rectangle(0, 0, 4, 4))};
  return truth;
}

MappedPlane mapped(const geometry::Pose3& T_world_patch, const Polygon& outline) {
  return {T_world_patch, outline};
}

PlaneCounts at80(const PlaneScore& score) {
  return *score.at(0.8);
}

TEST(Planes, ThatAreAsTheyAreScorePerfectly) {
  const auto truth = walled();
  FlatMap map;
  for (const auto& plane : truth.planes) {
    map.add(1, plane.T_world_plane, map::PlanePatch{.area = 9.0, .outline_in_patch = plane.outline_in_plane});
  }
  const auto score = scorePlanes(planesOf(map.view(), truth), truth);
  EXPECT_EQ(score.truth, 2U);
  EXPECT_EQ(score.mapped, 2U);
  ASSERT_EQ(score.curve.size(), 10U);
  for (const auto& counts : score.curve) {
    EXPECT_EQ(counts.correct, 2U) << counts.threshold;
    EXPECT_EQ(counts.over + counts.under + counts.missed + counts.noise, 0U) << counts.threshold;
  }
  ASSERT_EQ(score.angleErrors.size(), 2U);
  for (const double error : score.angleErrors) EXPECT_NEAR(error, 0.0, 1e-6);
  for (const double error : score.offsetErrors) EXPECT_NEAR(error, 0.0, 1e-6);
}

TEST(Planes, AreTheSameWithTheirNormalsTurnedOver) {
  const auto truth = walled();
  FlatMap map;
  const geometry::Pose3 turned = farWall() * Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX());
  map.add(1, turned, map::PlanePatch{.area = 11.2, .outline_in_patch = rectangle(0, -2.8, 4, 2.8)});
  const auto score = scorePlanes(planesOf(map.view(), truth), truth);
  EXPECT_EQ(at80(score).correct, 1U);
  EXPECT_EQ(at80(score).missed, 1U);
}

TEST(Planes, OfWhichAWallHasTwoAreToldApartByTheSideTheyWereSeenFrom) {
  auto truth = test::flat::truth();
  const geometry::Pose3 other =
      Eigen::Translation3d(-0.1, 0, 0) * farWall() * Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitY());
  truth.planes = {planeOf("inside", farWall(), rectangle(0, 0, 4, 2.8)),
                  planeOf("outside", other, rectangle(-4, 0, 4, 2.8))};
  const auto score = scorePlanes({mapped(farWall(), rectangle(0, 0, 4, 2.8))}, truth);
  EXPECT_EQ(at80(score).correct, 1U);
  EXPECT_EQ(at80(score).under, 0U);
  EXPECT_EQ(at80(score).missed, 1U);
}

TEST(Planes, InTwoPiecesAreOverSegmented) {
  auto truth = walled();
  truth.planes.pop_back();
  const auto score =
      scorePlanes({mapped(farWall(), rectangle(0, 0, 2, 2.8)), mapped(farWall(), rectangle(2, 0, 2, 2.8))}, truth);
  const auto counts = at80(score);
  EXPECT_EQ(counts.over, 1U);
  EXPECT_EQ(counts.correct + counts.under + counts.missed + counts.noise, 0U);
}

TEST(Planes, HeldByOnePatchAreUnderSegmented) {
  auto truth = test::flat::truth();
  truth.planes = {planeOf("left", farWall(), rectangle(0, 0, 1.9, 2.8)),
                  planeOf("right", farWall(), rectangle(2.1, 0, 1.9, 2.8))};
  const auto score = scorePlanes({mapped(farWall(), rectangle(0, 0, 4, 2.8))}, truth);
  const auto counts = at80(score);
  EXPECT_EQ(counts.under, 1U);
  EXPECT_EQ(counts.correct + counts.over + counts.missed + counts.noise, 0U);
}

TEST(Planes, CoveredInPartAreCorrectUpToThatShare) {
  auto truth = walled();
  truth.planes.pop_back();
  const auto score = scorePlanes({mapped(farWall(), rectangle(0, 0, 2.72, 2.8))}, truth);  // 68 % of it
  for (const auto& counts : score.curve) {
    const bool enough = counts.threshold < 0.68;
    EXPECT_EQ(counts.correct, enough ? 1U : 0U) << counts.threshold;
    EXPECT_EQ(counts.missed, enough ? 0U : 1U) << counts.threshold;
    EXPECT_EQ(counts.noise, enough ? 0U : 1U) << counts.threshold;
  }
}

TEST(Planes, AreMeasuredByWhatWasSeenOfThem) {
  auto truth = walled();
  truth.planes.pop_back();
  truth.planes[0].seen = 2.72 * 2.8;
  const auto score = scorePlanes({mapped(farWall(), rectangle(0, 0, 2.72, 2.8))}, truth);
  EXPECT_EQ(score.at(0.95)->correct, 1U);
}

TEST(Planes, BarelySeenCountNeitherWay) {
  auto truth = walled();
  truth.planes[0].seen = 0.3;
  const auto score = scorePlanes({mapped(farWall(), rectangle(0, 0, 0.6, 0.5))}, truth);
  EXPECT_EQ(score.truth, 1U);  // the floor
  EXPECT_EQ(score.mapped, 0U);
  EXPECT_EQ(at80(score).noise, 0U);
  EXPECT_EQ(at80(score).missed, 1U);
}

TEST(Planes, ErrorsAreThoseThatWerePutIn) {
  const auto truth = walled();
  const double tilt = 2.0 * std::numbers::pi / 180.0;
  // Tilted about its middle, and 4 cm in front of the wall.
  const geometry::Pose3 T_world_patch =
      farWall() * Eigen::Translation3d(2.0, 1.4, 0.04) * Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX());
  const auto score = scorePlanes({mapped(T_world_patch, rectangle(-2, -1.4, 4, 2.8))}, truth);
  ASSERT_EQ(score.angleErrors.size(), 1U);
  EXPECT_NEAR(score.angleErrors[0], tilt, 1e-9);
  EXPECT_NEAR(score.offsetErrors[0], 0.04, 1e-9);
}

TEST(Planes, TooFarOrTooSteepAreNoise) {
  auto truth = walled();
  truth.planes.pop_back();
  const geometry::Pose3 before = farWall() * Eigen::Translation3d(0, 0, 0.2);
  const geometry::Pose3 steep =
      farWall() * Eigen::Translation3d(2, 1.4, 0) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY());
  const auto score =
      scorePlanes({mapped(before, rectangle(0, 0, 4, 2.8)), mapped(steep, rectangle(-2, -1.4, 4, 2.8))}, truth);
  EXPECT_EQ(at80(score).noise, 2U);
  EXPECT_EQ(at80(score).missed, 1U);
}

TEST(Planes, OfAnEmptyMapAreAllMissed) {
  const auto truth = walled();
  FlatMap map;
  const auto score = scorePlanes(planesOf(map.view(), truth), truth);
  EXPECT_EQ(at80(score).missed, 2U);
  EXPECT_EQ(score.mapped, 0U);
  EXPECT_TRUE(score.angleErrors.empty());
  EXPECT_EQ(score.at(0.81), nullptr);
}

TEST(Planes, OfSeveralMapsAreAddedUp) {
  const auto truth = walled();
  PlaneScore sum;
  sum += scorePlanes({mapped(farWall(), rectangle(0, 0, 4, 2.8))}, truth);
  sum += scorePlanes({}, truth);
  EXPECT_EQ(sum.truth, 4U);
  EXPECT_EQ(at80(sum).correct, 1U);
  EXPECT_EQ(at80(sum).missed, 3U);
  EXPECT_EQ(sum.angleErrors.size(), 1U);
}

}  // namespace
}  // namespace prodomos::evaluation

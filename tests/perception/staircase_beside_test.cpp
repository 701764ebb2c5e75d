// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/staircase_beside.hpp"

#include "prodomos/perception/staircase_detector.hpp"

#include "perception/depth_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prodomos::perception {
namespace {

using geometry::Pose3;
using test::cameraAt;
using test::DepthScene;

constexpr double kDegree = std::numbers::pi / 180.0;

Pose3 at(double x, double y, double yaw, double z = 0.0) {
  return geometry::fromYawPitchRoll({x, y, z}, yaw, 0.0, 0.0);
}

/// A flight that one looks under: each step as thick as the riser and a slab below it.
struct OpenFlight {
  Pose3 T_world_foot = Pose3::Identity();
  int steps = 9;
  double rise = 0.17;
  double depth = 0.28;
  double width = 1.2;
};

void add(DepthScene& scene, const OpenFlight& flight) {
  constexpr double kSlab = 0.15;
  for (int i = 0; i < flight.steps; ++i) {
    const double base = flight.T_world_foot.translation().z();
    const double thick = std::min(flight.rise + kSlab, base + (i + 1) * flight.rise);
    scene.addBlock(flight.T_world_foot * at(i * flight.depth, 0.0, 0.0, (i + 1) * flight.rise - thick),
                   {flight.depth, flight.width, thick});
  }
}

RgbdView viewOf(const sensors::RgbdFrame& frame, const Pose3& T_world_camera) {
  return {.frame = frame, .T_submap_camera = T_world_camera};
}

std::vector<StaircaseSighting> beside(const DepthScene& scene, const Pose3& T_world_camera) {
  const auto frame = scene.look(T_world_camera);
  const auto view = viewOf(frame, T_world_camera);
  return findFlightsBeside(view, findSurfaces(view, {}));
}

std::vector<StaircaseSighting> all(const DepthScene& scene, const Pose3& T_world_camera) {
  const auto frame = scene.look(T_world_camera);
  const auto view = viewOf(frame, T_world_camera);
  return findStaircases(view, findSurfaces(view, {}), {});
}

double turnBetween(const StaircaseSighting& sighting, const OpenFlight& flight) {
  return std::abs(
      geometry::normalizeAngle(geometry::yaw(sighting.T_submap_stairs) - geometry::yaw(flight.T_world_foot)));
}

TEST(FlightBeside, IsFoundFromItsSideWhicheverWayItLeads) {
  for (const bool isToTheLeft : {true, false}) {
    DepthScene scene;
    const double way = isToTheLeft ? 1.0 : -1.0;
    const OpenFlight flight{.T_world_foot = at(3.2, -1.2 * way, 90.0 * kDegree * way)};
    add(scene, flight);
    const auto found = beside(scene, cameraAt({0.0, 0.0, 1.2}, 0.0));
    ASSERT_EQ(found.size(), 1U) << way;
    EXPECT_LT(turnBetween(found[0], flight), 3.0 * kDegree) << way;
    EXPECT_GE(found[0].steps.size(), 5U) << way;
    EXPECT_NEAR(found[0].slope, flight.rise / flight.depth, 0.05) << way;
    const Eigen::Vector3d foot = flight.T_world_foot.inverse() * found[0].T_submap_stairs.translation();
    EXPECT_NEAR(foot.x(), 0.0, 0.1) << way;
    EXPECT_NEAR(foot.y(), 0.0, 0.4) << way;
    EXPECT_NEAR(foot.z(), 0.0, 0.03) << way;
    EXPECT_GT(found[0].evidence, 1.0) << way;
    EXPECT_FALSE(found[0].widthIsWhole) << way;
  }
}

TEST(FlightBeside, IsFoundThoughAPostCoversAStep) {
  DepthScene scene;
  const OpenFlight flight{.T_world_foot = at(3.2, -1.0, 90.0 * kDegree), .steps = 7};
  add(scene, flight);
  constexpr double kBeforeRiser = 2.7;  // of the fourth: three steps are left on either side of the post
  scene.addBlock(flight.T_world_foot * at(kBeforeRiser * flight.depth, flight.width / 2.0, 0.0), {0.17, 0.04, 1.7});
  const auto found = beside(scene, cameraAt({0.0, 0.0, 1.2}, 0.0));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_GE(found[0].steps.size(), 5U);
  EXPECT_LT(turnBetween(found[0], flight), 3.0 * kDegree);
}

TEST(FlightBeside, IsFoundFromBehindWhereNoRiserIsSeen) {
  DepthScene scene;
  const OpenFlight flight{.T_world_foot = at(3.0, 2.2, -100.0 * kDegree)};
  add(scene, flight);
  const auto found = all(scene, cameraAt({0.8, -1.5, 1.2}, 45.0 * kDegree));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT(turnBetween(found[0], flight), 4.0 * kDegree);
  EXPECT_LT((found[0].T_submap_stairs.translation() - flight.T_world_foot.translation()).norm(), 0.5);
}

TEST(FlightBeside, OfADogLegBeginsAtItsLanding) {
  DepthScene scene;
  const OpenFlight first{.T_world_foot = at(4.2, -1.4, 90.0 * kDegree), .steps = 8};
  const double landing_z = 8 * first.rise;
  scene.addBox(at(3.6, 1.44, 0.0, landing_z - 0.1), {2.4, 1.2, 0.2});
  const OpenFlight second{.T_world_foot = at(3.0, 0.84, -90.0 * kDegree, landing_z), .steps = 7};
  add(scene, first);
  add(scene, second);
  const auto found = all(scene, cameraAt({0.0, 0.0, 1.2}, 0.0, -0.05));
  ASSERT_EQ(found.size(), 2U);
  for (const OpenFlight& flight : {first, second}) {
    const auto sighting = std::ranges::min_element(found, {}, [&](const auto& s) { return turnBetween(s, flight); });
    EXPECT_LT(turnBetween(*sighting, flight), 4.0 * kDegree);
    EXPECT_NEAR(sighting->T_submap_stairs.translation().y(), flight.T_world_foot.translation().y(), 0.15);
    EXPECT_NEAR(sighting->T_submap_stairs.translation().z(), flight.T_world_foot.translation().z(), 0.04);
  }
}

TEST(FlightBeside, IsToldOnceWhereItsStepsAreSeenToo) {
  DepthScene scene;
  add(scene, {.T_world_foot = at(2.4, -0.6, 50.0 * kDegree)});
  EXPECT_EQ(all(scene, cameraAt({0.0, 0.0, 1.3}, 0.0, 0.1)).size(), 1U);
}

TEST(FlightBeside, ShelvesSeenObliquelyAreNone) {
  for (const double degrees : {0.0, 25.0, 45.0, 60.0, 75.0}) {
    DepthScene scene;
    const Pose3 shelf = at(2.6, 0.0, degrees * kDegree);
    scene.addBox(shelf * at(0.2, 0.0, 0.0, 0.9), {0.03, 1.6, 1.8});  // back
    for (const double side : {-0.8, 0.8}) scene.addBox(shelf * at(0.0, side, 0.0, 0.9), {0.4, 0.03, 1.8});
    for (int i = 0; i < 6; ++i) scene.addBox(shelf * at(0.0, 0.0, 0.0, 0.1 + 0.33 * i), {0.4, 1.6, 0.03});
    base::Random random(static_cast<std::uint64_t>(degrees) + 1, "books");
    for (int i = 0; i < 40; ++i) {
      const double tall = random.uniform(0.12, 0.28);
      scene.addBox(shelf * at(0.05, -0.7 + 0.18 * (i % 8), 0.0, 0.12 + 0.33 * (i / 8) + 0.5 * tall), {0.2, 0.15, tall});
    }
    EXPECT_TRUE(all(scene, cameraAt({0.0, 0.2, 1.2}, -0.05)).empty()) << degrees;
  }
}

TEST(FlightBeside, RailsAreNone) {
  DepthScene scene;
  for (const double up : {0.1, 0.5, 0.9}) {
    scene.addBox(geometry::fromYawPitchRoll({3.0, 0.0, 0.6 + up}, 90.0 * kDegree, -32.0 * kDegree, 0.0),
                 {3.0, 0.05, 0.05});
  }
  for (int i = 0; i < 8; ++i) scene.addBox(at(3.0, -1.05 + 0.3 * i, 0.0, 0.2 + 0.19 * i + 0.5), {0.03, 0.03, 1.0});
  EXPECT_TRUE(all(scene, cameraAt({0.0, 0.0, 1.2}, 0.0)).empty());
}

TEST(FlightBeside, TheSideOfARampOrALeaningBoardIsNone) {
  for (const double degrees : {20.0, 33.0, 42.0}) {
    for (const double thick : {0.04, 0.3}) {
      DepthScene scene;
      scene.addBox(geometry::fromYawPitchRoll({3.0, 0.0, 0.9}, 90.0 * kDegree, -degrees * kDegree, 0.0),
                   {2.4, 1.0, thick});
      EXPECT_TRUE(all(scene, cameraAt({0.0, 0.3, 1.2}, 0.0)).empty()) << degrees << ' ' << thick;
    }
  }
}

TEST(FlightBeside, ARowOfThingsOfAnyHeightsIsNone) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    DepthScene scene;
    base::Random random(seed, "row");
    for (double y = -1.4; y < 1.4;) {
      const double wide = random.uniform(0.15, 0.45);
      scene.addBlock(at(2.8, y + 0.5 * wide, 0.0), {0.4, wide, random.uniform(0.4, 1.6)});
      y += wide;
    }
    EXPECT_TRUE(beside(scene, cameraAt({0.0, 0.0, 1.2}, 0.1)).empty()) << seed;
  }
}

TEST(FlightBeside, NothingIsInventedOfBadInput) {
  const Pose3 T_world_camera = cameraAt({0.0, 0.0, 1.2}, 0.0);
  sensors::RgbdFrame frame;
  frame.camera = {525.0, 525.0, 319.5, 239.5, {}};
  frame.depth = sensors::Image<float>(640, 480, 0.0F);
  const auto isEmpty = [&] {
    const auto view = viewOf(frame, T_world_camera);
    return findFlightsBeside(view, findSurfaces(view, {})).empty();
  };
  EXPECT_TRUE(isEmpty());
  base::Random random(1, "rubbish");
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    frame.depth.data()[i] = static_cast<float>(random.uniform(0.5, 5.0));
  }
  EXPECT_TRUE(isEmpty());
}

}  // namespace
}  // namespace prodomos::perception

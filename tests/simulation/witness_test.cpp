// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/witness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace prodomos::simulation {
namespace {

using namespace std::chrono_literals;
using geometry::Pose3;

constexpr base::Time kBegin{100s};

base::Time at(double seconds) {
  return kBegin + base::fromSeconds(seconds);
}

/// A hall of 10 m by 10 m; in the middle of its west wall a door into a closet.
Building hallWithADoor() {
  Building building{.name = "hall", .storeys = {{0.0, 3.0}}};
  building.rooms = {{.id = "hall",
                     .storey = 0,
                     .label = "HALL",
                     .use = RoomUse::kCorridor,
                     .outline = {{0.0, -5.0}, {10.0, -5.0}, {10.0, 5.0}, {0.0, 5.0}}},
                    {.id = "closet",
                     .storey = 0,
                     .label = "CLOSET",
                     .outline = {{-2.2, -1.0}, {-0.2, -1.0}, {-0.2, 1.0}, {-2.2, 1.0}}}};
  building.doors = {{.id = "d", .storey = 0, .rooms = {0, 1}, .pose = {-0.1, 0.0, std::numbers::pi}}};
  return building;
}

/// A panel across the x-axis, 2 cm thick, seen from both sides.
Surface panel(double x, double y, double z, double width, double height, std::uint16_t instance) {
  Pose3 pose = Pose3::Identity();
  pose.translation() = Eigen::Vector3d(x, y, z + height / 2.0);
  return boxSurface(pose, {0.02, width, height}, {}, classId("door"), instance);
}

Surface closedLeaf() {
  return panel(-0.1, 0.0, 0.0, 0.9, 2.05, doorInstance(0));
}

/// Looks from a spot to another, level.
Pose3 cameraFrom(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double height = 1.2) {
  const Eigen::Vector2d ahead = to - from;
  return geometry::fromYawPitchRoll({from.x(), from.y(), height}, std::atan2(ahead.y(), ahead.x()), 0.0, 0.0) *
         sensors::cameraAxesInBody();
}

class WitnessTest : public ::testing::Test {
 protected:
  void build(Building building, std::vector<Surface> surfaces) {
    building_ = std::move(building);
    building_.lighting.lamps = {{5.0, 0.0, 2.9}};
    truth_ = truthOf(building_, kBegin, 1);
    scene_ = std::make_unique<RayScene>(std::move(surfaces));
    witness_ = std::make_unique<Witness>(building_, CameraModel{}, truth_);
  }

  void look(double seconds, const Pose3& T_world_camera) {
    const Renderer renderer(*scene_, {}, building_.lighting);
    witness_->look(at(seconds), seconds, T_world_camera, renderer.render(T_world_camera, 1));
  }

  const evaluation::Sighting& door() const { return truth_.doors.at(0).sighting; }

  Building building_;
  evaluation::Truth truth_;
  std::unique_ptr<RayScene> scene_;
  std::unique_ptr<Witness> witness_;
};

TEST_F(WitnessTest, ADoorSeenWholeFromTheFrontIsVisibleFromThenOn) {
  build(hallWithADoor(), {closedLeaf()});
  look(1.0, cameraFrom({3.5, 0.0}, {0.0, 0.0}));
  look(2.0, cameraFrom({3.5, 0.0}, {10.0, 0.0}));
  EXPECT_TRUE(door().visible);
  EXPECT_GT(door().share, 0.95);
  EXPECT_EQ(door().since, at(1.0));
  EXPECT_EQ(door().images, std::vector{at(1.0)});
}

TEST_F(WitnessTest, ADoorSeenTooObliquelyOrFromTooFarIsNotVisible) {
  build(hallWithADoor(), {closedLeaf()});
  look(1.0, cameraFrom({0.4, -4.0}, {-0.1, 0.0}));  // 83° off its normal
  look(2.0, cameraFrom({5.5, 0.0}, {0.0, 0.0}));
  EXPECT_FALSE(door().visible);
  EXPECT_EQ(door().share, 0.0);
  EXPECT_TRUE(door().images.empty());
}

TEST_F(WitnessTest, PartsOfADoorAddUpOverFrames) {
  build(hallWithADoor(), {closedLeaf()});
  // Near by, the camera sees no more than the middle of the leaf's height; looking up and down it sees the rest.
  const auto near = cameraFrom({1.0, 0.0}, {0.0, 0.0});
  const auto pitched = [&](double angle) { return near * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()); };
  look(1.0, near);
  EXPECT_GT(door().share, 0.2);
  EXPECT_FALSE(door().visible);
  look(2.0, pitched(0.7));
  look(3.0, pitched(-0.7));
  EXPECT_TRUE(door().visible);
  EXPECT_EQ(door().since, at(3.0));
  EXPECT_TRUE(door().images.empty());
}

TEST_F(WitnessTest, WhatStandsBeforeADoorHidesItsPart) {
  build(hallWithADoor(), {closedLeaf(), panel(0.2, 0.0, 0.0, 3.0, 1.0, 0)});
  look(1.0, cameraFrom({3.5, 0.0}, {0.0, 0.0}));
  EXPECT_FALSE(door().visible);
  EXPECT_GT(door().share, 0.35);
  EXPECT_LT(door().share, 0.65);
}

TEST_F(WitnessTest, ADoorOfAnotherStoreyIsNotLookedFor) {
  auto building = hallWithADoor();
  building.storeys.push_back({3.3, 3.0});
  building.doors[0].storey = 1;
  build(building, {closedLeaf()});
  look(1.0, cameraFrom({3.5, 0.0}, {0.0, 0.0}));
  EXPECT_EQ(door().share, 0.0);
}

TEST_F(WitnessTest, AnOpenLeafIsLookedForWhereItStands) {
  auto building = hallWithADoor();
  building.doors[0].swings = {{0.0, std::numbers::pi / 2.0}};
  building.doors[0].opensAlongNormal = false;  // into the hall
  // The hinge is on the left along the normal, at y = -0.45; the leaf stands out into the hall along x.
  Pose3 pose = Pose3::Identity();
  pose.translation() = Eigen::Vector3d(-0.1 + 0.45, -0.45, 1.025);
  build(building, {boxSurface(pose, {0.9, 0.02, 2.05}, {}, classId("door"), doorInstance(0))});
  look(1.0, cameraFrom({0.35, 3.5}, {0.35, 0.0}));
  EXPECT_TRUE(door().visible);
}

TEST_F(WitnessTest, ADoorwayIsSeenWhereOneLooksThroughIt) {
  auto building = hallWithADoor();
  building.doors[0].leaves = 0;
  build(building, {});
  look(1.0, cameraFrom({3.5, 0.0}, {0.0, 0.0}));
  EXPECT_TRUE(door().visible);

  build(building, {panel(0.5, 0.0, 0.0, 4.0, 3.0, 0)});
  look(1.0, cameraFrom({3.5, 0.0}, {0.0, 0.0}));
  EXPECT_EQ(door().share, 0.0);
}

/// In the hall: five steps up to the west, from its foot at (2, 0).
Building hallWithAFlight() {
  auto building = hallWithADoor();
  building.stairs = {{.id = "s",
                      .rooms = {0, 0},
                      .foot = {2.0, 0.0, 0.0},
                      .direction = std::numbers::pi,
                      .width = 1.2,
                      .stepDepth = 0.3,
                      .stepHeight = 0.18,
                      .stepCount = 5}};
  return building;
}

/// Its step i, a block `thick` metres high below the tread.
Surface step(const Building& building, int i, double thick) {
  Pose3 pose = Pose3::Identity();
  pose.translation() = Eigen::Vector3d(2.0 - 0.3 * i - 0.15, 0.0, 0.18 * (i + 1) - thick / 2.0);
  return boxSurface(pose, {0.3, 1.2, thick}, {}, classId("stairs"), stairsInstance(building, 0));
}

TEST_F(WitnessTest, ThreeStepsMakeAFlightVisible) {
  const auto building = hallWithAFlight();
  const auto solid = [&](int i) { return step(building, i, 0.18 * (i + 1)); };
  build(building, {solid(0), solid(1)});
  look(1.0, cameraFrom({5.0, 0.0}, {0.0, 0.0}));
  EXPECT_FALSE(truth_.stairs[0].sighting.visible);

  build(building, {solid(0), solid(1), solid(2), solid(3), solid(4)});
  look(1.0, cameraFrom({5.0, 0.0}, {0.0, 0.0}));
  EXPECT_TRUE(truth_.stairs[0].sighting.visible);
  EXPECT_GE(truth_.stairs[0].sighting.share, 0.6);
  EXPECT_EQ(truth_.stairs[0].sighting.images.size(), 1U);
}

TEST_F(WitnessTest, AFlightIsSeenFromItsSideButNotFromBehindNorThroughItself) {
  auto building = hallWithAFlight();
  std::vector<Surface> steps;
  for (int i = 0; i < 5; ++i) steps.push_back(step(building, i, 0.3));
  build(building, steps);
  look(1.0, cameraFrom({1.2, 4.0}, {1.2, 0.0}));
  EXPECT_TRUE(truth_.stairs[0].sighting.visible);
  EXPECT_EQ(truth_.stairs[0].sighting.share, 1.0);

  // From behind and below, pixels of the flight's underside are where the camera would see risers through them.
  for (auto& block : steps) {
    for (auto& vertex : block.vertices) vertex.z() += 1.5F;
  }
  building.stairs[0].foot.z() = 1.5;
  build(building, steps);
  look(1.0, cameraFrom({-1.5, 0.0}, {2.0, 0.0}));
  EXPECT_EQ(truth_.stairs[0].sighting.share, 0.0);
}

TEST_F(WitnessTest, WhatIsPassedLiesWithinThreeMetresAndNotBehindAWall) {
  build(hallWithADoor(), {});
  witness_->walk(at(0.0), geometry::toPose3({4.0, 0.0, 0.0}));
  EXPECT_FALSE(door().passed);
  witness_->walk(at(1.0), geometry::toPose3({-1.0, 3.0, 0.0}));  // near, but in no room
  EXPECT_FALSE(door().passed);
  witness_->walk(at(2.0), geometry::toPose3({2.0, 1.0, 0.0}));
  EXPECT_TRUE(door().passed);
}

TEST_F(WitnessTest, ARoomIsEnteredOnce) {
  build(hallWithADoor(), {});
  for (const double time : {1.0, 2.0}) witness_->walk(at(time), geometry::toPose3({4.0, 0.0, 0.0}));
  EXPECT_EQ(truth_.rooms[0].entered, at(1.0));
  EXPECT_FALSE(truth_.rooms[1].entered.has_value());
  EXPECT_EQ(truth_.trajectory.size(), 2U);
}

TEST_F(WitnessTest, AThingsSeenAreaIsMeasuredInSquareMetres) {
  auto building = hallWithADoor();
  building.things = {{.id = "board", .kind = "noticeboard", .size = {0.02, 1.0, 1.0}}};
  const auto instance = thingInstance(building, 0);
  for (const double x : {0.0, 1.5}) {  // from 3 m and from 1.5 m
    build(building, {panel(x, 0.0, 0.7, 1.0, 1.0, instance)});
    look(1.0, cameraFrom({3.0, 0.0}, {0.0, 0.0}));
    EXPECT_NEAR(truth_.objects[0].seen, 1.0, 0.01);
  }
}

TEST_F(WitnessTest, OfAWallTheSeenPartCounts) {
  auto wall = panel(-0.01, 0.0, 0.0, 10.0, 3.0, 0);
  wall.classId = classId("wall");
  build(hallWithADoor(), {wall});
  look(1.0, cameraFrom({3.0, 0.0}, {0.0, 0.0}));
  double west = 0.0;
  for (const auto& plane : truth_.planes) {
    if (plane.T_world_plane.linear().col(2).x() > 0.9 && std::abs(plane.T_world_plane.translation().x()) < 0.1) {
      west = plane.seen;
    } else if (plane.storey == 0 && plane.T_world_plane.linear().col(2).x() < 0.5) {
      EXPECT_EQ(plane.seen, 0.0) << plane.id;
    }
  }
  // 640 by 480 pixels at three metres: 3.66 m by 2.74 m, of which 1.2 m below the eye and 1.37 m above.
  EXPECT_NEAR(west, 3.66 * 2.57, 1.0);
}

TEST(Truth, OfABuildingHasEveryWallFloorAndCeiling) {
  const auto truth = truthOf(hallWithADoor(), kBegin, 1);
  EXPECT_EQ(truth.planes.size(), 2U * 6U);
  for (const auto& plane : truth.planes) {
    EXPECT_NEAR(plane.T_world_plane.linear().determinant(), 1.0, 1e-12) << plane.id;
    // Seen from its plane's middle, the normal points into the room.
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const auto& corner : plane.outline_in_plane)
      middle += corner / static_cast<double>(plane.outline_in_plane.size());
    const Eigen::Vector3d inside = plane.T_world_plane * Eigen::Vector3d(middle.x(), middle.y(), 0.5);
    const auto& room = truth.rooms[plane.id.starts_with("hall") ? 0 : 1];
    EXPECT_TRUE(contains(room.outline, inside.head<2>())) << plane.id;
    EXPECT_GT(inside.z(), 0.0) << plane.id;
    EXPECT_LT(inside.z(), 3.0) << plane.id;
  }
}

TEST(Truth, OfADoorTellsItsStatesAsItSwings) {
  auto building = hallWithADoor();
  building.doors[0].swings = {{10.0, 0.0}, {12.0, std::numbers::pi / 2.0}, {20.0, std::numbers::pi / 2.0}, {22.0, 0.0}};
  const auto truth = truthOf(building, kBegin, 1);
  std::vector<map::DoorState> states;
  for (const auto& state : truth.doors[0].states) states.push_back(state.state);
  using enum map::DoorState;
  EXPECT_EQ(states, (std::vector{kClosed, kAjar, kOpen, kAjar, kClosed}));
  EXPECT_EQ(truth.doors[0].states[0].time, kBegin);
  EXPECT_NEAR(base::seconds(truth.doors[0].states[2].time - kBegin), 10.0 + 2.0 * 60.0 / 90.0, 0.01);
}

TEST(Truth, OfADoubleDoorTellsNoHinge) {
  auto building = hallWithADoor();
  EXPECT_EQ(truthOf(building, kBegin, 1).doors[0].hingeSide, map::HingeSide::kLeft);
  building.doors[0].leaves = 2;
  EXPECT_EQ(truthOf(building, kBegin, 1).doors[0].hingeSide, map::HingeSide::kUnknown);
}

}  // namespace
}  // namespace prodomos::simulation

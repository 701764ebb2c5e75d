// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/door_detector.hpp"

#include "prodomos/io/open_source.hpp"

#include "support/corridor_doors.hpp"
#include "support/datasets.hpp"
#include "support/door_scene.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace prodomos::perception {
namespace {

using test::DoorScene;
using test::DrawnDoor;

constexpr double kPi = std::numbers::pi;
constexpr double kStraight = kPi / 2.0;

/// Where the sub-map lies is of no matter.
geometry::Pose3 somewhere() {
  return geometry::toPose3({3.0, -7.0, 2.1}, 0.4);
}

struct Look {
  double x = 0.0;
  double y = -3.2;
  double yaw = kStraight;
};

RgbdView viewOf(const sensors::RgbdFrame& frame, const Look& look, const geometry::Pose3& T_submap_world) {
  return {.time = base::Time{std::chrono::seconds(5)},
          .frame = frame,
          .T_submap_camera = T_submap_world * DoorScene::cameraPose(look.x, look.y, look.yaw),
          .floor_z = T_submap_world.translation().z()};
}

std::vector<DoorSighting> find(const sensors::RgbdFrame& frame, const Look& look,
                               const geometry::Pose3& T_submap_world = geometry::Pose3::Identity(),
                               const DoorDetectorConfig& config = {}) {
  const RgbdView view = viewOf(frame, look, T_submap_world);
  return findDoors(view, findSurfaces(view, SurfacesConfig{}), config);
}

std::vector<DoorSighting> findIn(const DoorScene& scene, const Look& look = {}) {
  return find(scene.see(look.x, look.y, look.yaw), look);
}

/// Looking along the wall, the door some way ahead on the left: seen at `degrees` from its normal.
Look oblique(double degrees, double distance) {
  const double angle = degrees * kPi / 180.0;
  return {-distance * std::tan(angle), -distance, std::atan2(distance, distance * std::tan(angle)) - 0.25};
}

TEST(DoorDetector, FindsAClosedDoorFromTheFront) {
  const DrawnDoor door{.left = -0.2, .width = 0.9};
  const auto doors = findIn(DoorScene({door}));
  ASSERT_EQ(doors.size(), 1U);
  const auto& found = doors[0];
  EXPECT_NEAR(found.T_submap_door.translation().x(), 0.25, 0.04);
  EXPECT_NEAR(found.T_submap_door.translation().y(), door.recess, 0.03);
  EXPECT_NEAR(found.T_submap_door.translation().z(), 0.0, 0.03);
  EXPECT_NEAR(found.door.width, 0.9, 0.06);
  EXPECT_NEAR(found.door.height, DoorScene::kHeight, 0.06);
  EXPECT_TRUE(found.door.hasLeaf);
  EXPECT_EQ(found.door.state, map::DoorState::kClosed);
  EXPECT_TRUE(found.whole);
  EXPECT_GT(found.evidence, 1.0);
}

TEST(DoorDetector, NormalPointsAwayFromTheObserver) {
  const auto doors = findIn(DoorScene({DrawnDoor{}}));
  ASSERT_EQ(doors.size(), 1U);
  EXPECT_NEAR(geometry::yaw(doors[0].T_submap_door), kStraight, 0.03);
}

TEST(DoorDetector, FindsClosedDoorSeenAtSixtyFiveDegrees) {
  const auto doors = findIn(DoorScene({DrawnDoor{}}), oblique(65.0, 1.5));
  ASSERT_EQ(doors.size(), 1U);
  EXPECT_NEAR(doors[0].T_submap_door.translation().x(), 0.0, 0.08);
  EXPECT_NEAR(doors[0].door.width, 0.9, 0.1);
}

TEST(DoorDetector, RecessDoesNotShiftADoorSeenObliquely) {
  for (const double recess : {0.0, 0.06, 0.12}) {
    const auto doors = findIn(DoorScene({DrawnDoor{.recess = recess}}), oblique(55.0, 1.8));
    ASSERT_EQ(doors.size(), 1U) << recess;
    EXPECT_NEAR(doors[0].T_submap_door.translation().x(), 0.0, 0.06) << recess;
    EXPECT_NEAR(doors[0].T_submap_door.translation().y(), recess, 0.03) << recess;
    EXPECT_NEAR(doors[0].door.width, 0.9, 0.1) << recess;
  }
}

TEST(DoorDetector, HandleTellsTheHinge) {
  for (const bool hingeIsLeft : {true, false}) {
    const auto doors = findIn(DoorScene({DrawnDoor{.hingeIsLeft = hingeIsLeft}}), {0.4, -3.0, kStraight + 0.1});
    ASSERT_EQ(doors.size(), 1U);
    EXPECT_EQ(doors[0].door.hingeSide, hingeIsLeft ? map::HingeSide::kLeft : map::HingeSide::kRight);
    EXPECT_EQ(doors[0].hingeEvidence > 0.0, hingeIsLeft);
  }
}

TEST(DoorDetector, FindsADoubleDoorAsOne) {
  const auto doors = findIn(DoorScene({DrawnDoor{.left = -0.8, .width = 1.6, .leaves = 2}}), {0.2, -3.6, kStraight});
  ASSERT_EQ(doors.size(), 1U);
  EXPECT_NEAR(doors[0].T_submap_door.translation().x(), 0.0, 0.06);
  EXPECT_NEAR(doors[0].door.width, 1.6, 0.1);
  EXPECT_EQ(doors[0].door.hingeSide, map::HingeSide::kUnknown);
}

TEST(DoorDetector, TellsTwoDoorsApart) {
  const auto doors =
      findIn(DoorScene({DrawnDoor{.left = -1.3}, DrawnDoor{.left = 0.3, .width = 0.8}}), {-0.2, -3.6, kStraight});
  EXPECT_EQ(doors.size(), 2U);
}

TEST(DoorDetector, PlaceOfTheSubMapDoesNotMatter) {
  const DoorScene scene({DrawnDoor{}});
  const Look look{0.3, -3.0, kStraight + 0.2};
  const auto frame = scene.see(look.x, look.y, look.yaw);
  const auto here = find(frame, look);
  const auto there = find(frame, look, somewhere());
  ASSERT_EQ(here.size(), 1U);
  ASSERT_EQ(there.size(), 1U);
  const geometry::Pose3 back = somewhere().inverse() * there[0].T_submap_door;
  EXPECT_LT((back.translation() - here[0].T_submap_door.translation()).norm(), 0.03);
  EXPECT_NEAR(there[0].door.width, here[0].door.width, 0.03);
}

TEST(DoorDetector, NothingOnWallsIsADoor) {
  DoorScene scene({});
  scene.addPoster(-1.4, -0.5, 0.12, 2.0);                                   // a tall poster
  scene.add({0.3, -0.03, 0.1}, {1.2, 0.0, 2.05}, {150, 110, 80}, "board");  // a panel
  scene.addPoster(1.8, 3.2, 0.9, 1.9);
  for (const Look& look : {Look{}, Look{-1.0, -2.5, kStraight - 0.4}, oblique(60.0, 1.5)}) {
    EXPECT_TRUE(findIn(scene, look).empty()) << look.x << ' ' << look.y;
  }
}

TEST(DoorDetector, CupboardIsNoDoor) {
  DoorScene scene({});
  scene.add({-0.45, -0.5, 0.0}, {0.45, 0.0, 2.0}, {168, 118, 72}, "cupboard");
  scene.add({-0.005, -0.502, 0.0}, {0.005, -0.5, 2.0}, {60, 50, 40}, "cupboard");
  for (const Look& look : {Look{}, Look{1.2, -3.0, kStraight + 0.4}, oblique(55.0, 2.2)}) {
    EXPECT_TRUE(findIn(scene, look).empty()) << look.x << ' ' << look.y;
  }
}

TEST(DoorDetector, OpeningWithoutALeafIsNotClosed) {
  const DoorScene scene({DrawnDoor{.leaves = 0}});
  for (const Look& look : {Look{}, oblique(50.0, 2.0)}) EXPECT_TRUE(findIn(scene, look).empty()) << look.x;
}

TEST(DoorDetector, LeafThatStandsOpenIsNotClosed) {
  for (const double degrees : {0.0, 45.0, 60.0, 70.0}) {
    DoorScene scene({DrawnDoor{.leaves = 0}});
    scene.add({0.41, 0.05, 0.0}, {0.45, 0.95, DoorScene::kHeight}, {168, 118, 72}, "door");
    EXPECT_TRUE(findIn(scene, oblique(degrees, 1.5)).empty()) << degrees;
  }
}

TEST(DoorDetector, CovarianceCoversTheErrors) {
  for (const double degrees : {0.0, 40.0, 60.0}) {
    const auto doors = findIn(DoorScene({DrawnDoor{}}), oblique(degrees, 2.0 + 1.0 * std::cos(degrees * kPi / 180.0)));
    ASSERT_EQ(doors.size(), 1U) << degrees;
    const Eigen::Vector2d error = doors[0].T_submap_door.translation().head<2>() - Eigen::Vector2d(0.0, 0.05);
    const Eigen::Matrix2d covariance = doors[0].covariance.topLeftCorner<2, 2>();
    EXPECT_LT(error.dot(covariance.inverse() * error), 11.8) << degrees;  // 3 sigma of two degrees of freedom
    EXPECT_LT(std::abs(doors[0].door.width - 0.9), 3.0 * doors[0].widthSigma) << degrees;
  }
}

TEST(DoorDetector, SameViewGivesTheSame) {
  const DoorScene scene({DrawnDoor{}});
  const auto frame = scene.see(0.0, -3.2, kStraight);
  const auto first = find(frame, {});
  const auto second = find(frame, {});
  ASSERT_EQ(first.size(), 1U);
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(first[0].T_submap_door.matrix(), second[0].T_submap_door.matrix());
  EXPECT_EQ(first[0].evidence, second[0].evidence);
}

TEST(DoorDetector, MoversAreNotLookedAt) {
  const DoorScene scene({DrawnDoor{}});
  const Look look;
  const auto frame = scene.see(look.x, look.y, look.yaw);
  const sensors::Mask all(frame.depth.width(), frame.depth.height(), 1);
  RgbdView view = viewOf(frame, look, geometry::Pose3::Identity());
  view.movers = &all;
  EXPECT_TRUE(findDoors(view, findSurfaces(view, SurfacesConfig{}), {}).empty());
  // Who stands before the leaf leaves no more of it than a strip.
  sensors::Mask person(frame.depth.width(), frame.depth.height(), 0);
  for (int y = 0; y < person.height(); ++y) std::fill_n(person.row(y) + 270, 100, std::uint8_t{1});
  view.movers = &person;
  for (const auto& door : findDoors(view, findSurfaces(view, SurfacesConfig{}), {})) EXPECT_FALSE(door.whole);
}

TEST(DoorDetector, BadInputInventsNothing) {
  const DoorScene scene({DrawnDoor{}});
  const Look look;
  const auto good = scene.see(look.x, look.y, look.yaw);
  auto noColor = good;
  noColor.color = {};
  EXPECT_TRUE(find(noColor, look).empty());
  auto zeros = good;
  zeros.depth = sensors::Image<float>(640, 480, 0.0F);
  EXPECT_TRUE(find(zeros, look).empty());
  auto nan = good;
  nan.depth = sensors::Image<float>(640, 480, std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(find(nan, look).empty());
  auto small = good;
  small.color = sensors::Image<sensors::Rgb>(320, 240);
  EXPECT_TRUE(find(small, look).empty());
  // The camera's picture turned by half: what was above is below.
  RgbdView view = viewOf(good, look, geometry::Pose3::Identity());
  view.T_submap_camera = view.T_submap_camera * geometry::Pose3(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(findDoors(view, findSurfaces(view, SurfacesConfig{}), {}).empty());
  DoorDetectorConfig off;
  off.enabled = false;
  EXPECT_TRUE(find(good, look, geometry::Pose3::Identity(), off).empty());
}

TEST(DoorDetector, PaperMethodPairsSalientPoints) {
  DoorDetectorConfig config;
  config.method = static_cast<int>(DoorMethod::kPaper);
  const DoorScene scene({DrawnDoor{.recess = 0.0}});
  const auto doors = find(scene.see(0.0, -3.2, kStraight), {}, geometry::Pose3::Identity(), config);
  ASSERT_FALSE(doors.empty());
  EXPECT_NEAR(doors[0].T_submap_door.translation().x(), 0.0, 0.15);
}

TEST(DoorDetector, DrawsWhatItDid) {
  const test::TemporaryFolder folder;
  DebugImages debug(folder.path() / "pictures");
  debug.beginFrame(3);
  const DoorScene scene({DrawnDoor{}});
  const Look look;
  const auto frame = scene.see(look.x, look.y, look.yaw);
  const RgbdView view = viewOf(frame, look, geometry::Pose3::Identity());
  findDoors(view, findSurfaces(view, SurfacesConfig{}), {}, &debug);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "pictures" / "000003_doors_wall_0.png"));
}

/// A regression check: thresholds are those of simulated logs.
TEST(DoorDetector, FindsTheDoorsOfTheCorridor) {
  const auto folder = test::dataset("rgbd/icsl_corridor");
  if (!folder) GTEST_SKIP() << "needs rgbd/icsl_corridor";
  const auto marked = test::readMarkedDoors(*folder / "doors.json");
  const auto source = io::openSource(*folder);
  std::map<std::string, int> found;
  int wrong = 0;
  constexpr int kEvery = 3;
  for (int frame = 0;;) {
    const auto item = source->next();
    if (std::holds_alternative<sensors::EndOfLog>(item)) break;
    const auto* reading = std::get_if<sensors::Reading>(&item);
    if (reading == nullptr || frame++ % kEvery != 0) continue;
    const auto& image = std::get<sensors::RgbdFrame>(reading->data);
    const auto T_level_camera = test::levelByFloor(image);
    if (!T_level_camera) continue;
    const RgbdView view{.time = reading->time, .frame = image, .T_submap_camera = *T_level_camera, .floor_z = 0.0};
    for (const auto& sighting : findDoors(view, findSurfaces(view, SurfacesConfig{}), {})) {
      const auto name = test::nameOf(sighting, view, frame - 1, marked);
      if (name) {
        ++found[*name];
      } else {
        ++wrong;
      }
    }
  }
  for (const char* door : {"D1", "D6", "D8"}) EXPECT_GE(found[door], 2) << door;
  EXPECT_LE(wrong, 4);  // D3 stands open, D6 is found before it was marked
}

}  // namespace
}  // namespace prodomos::perception

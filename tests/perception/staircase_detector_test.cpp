// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/staircase_detector.hpp"

#include "prodomos/io/open_source.hpp"

#include "perception/depth_scene.hpp"
#include "support/corridor_doors.hpp"
#include "support/datasets.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <optional>

namespace prodomos::perception {
namespace {

using geometry::Pose3;
using test::cameraAt;
using test::DepthScene;

/// A straight flight of blocks; its foot at the pose's origin, uphill along its x-axis.
struct TrueFlight {
  Pose3 T_world_foot = Pose3::Identity();
  int steps = 10;
  double rise = 0.17;
  double depth = 0.28;
  double width = 1.2;
  double landing = 0.0;  ///< metres that the last tread is longer
};

Pose3 at(double x, double y, double yaw, double z = 0.0) {
  return geometry::fromYawPitchRoll({x, y, z}, yaw, 0.0, 0.0);
}

void add(DepthScene& scene, const TrueFlight& flight) {
  for (int i = 0; i < flight.steps; ++i) {
    const double extra = i + 1 == flight.steps ? flight.landing : 0.0;
    scene.addBlock(flight.T_world_foot * at(i * flight.depth, 0.0, 0.0),
                   {flight.depth + extra, flight.width, (i + 1) * flight.rise});
  }
}

std::vector<StaircaseSighting> sightings(const sensors::RgbdFrame& frame, const Pose3& T_submap_camera,
                                         double floor_z = 0.0) {
  const RgbdView view{.frame = frame, .T_submap_camera = T_submap_camera, .floor_z = floor_z};
  return findStaircases(view, findSurfaces(view, {}), {});
}

std::vector<StaircaseSighting> sightings(const DepthScene& scene, const Pose3& T_world_camera) {
  return sightings(scene.look(T_world_camera), T_world_camera);
}

double directionError(const StaircaseSighting& sighting, const TrueFlight& flight) {
  return std::abs(
      geometry::normalizeAngle(geometry::yaw(sighting.T_submap_stairs) - geometry::yaw(flight.T_world_foot)));
}

double footError(const StaircaseSighting& sighting, const TrueFlight& flight) {
  return (sighting.T_submap_stairs.translation() - flight.T_world_foot.translation()).norm();
}

constexpr double kDegree = std::numbers::pi / 180.0;

TEST(StaircaseDetector, FindsAFlightFromTheFront) {
  DepthScene scene;
  const TrueFlight flight{.T_world_foot = at(2.2, 0.1, 0.0)};
  add(scene, flight);
  const auto found = sightings(scene, cameraAt({0.0, 0.0, 1.2}, 0.0));
  ASSERT_EQ(found.size(), 1U);
  const StaircaseSighting& stairs = found[0];
  EXPECT_LT(footError(stairs, flight), 0.10);
  EXPECT_LT(directionError(stairs, flight), 2.5 * kDegree);
  EXPECT_NEAR(stairs.width, flight.width, 0.08);
  EXPECT_TRUE(stairs.widthIsWhole);
  EXPECT_FALSE(stairs.descends);
  EXPECT_NEAR(stairs.slope, flight.rise / flight.depth, 0.03);
  ASSERT_GE(stairs.steps.size(), 6U);
  for (const Step& step : stairs.steps) {
    const double index = std::round(step.z / flight.rise);
    EXPECT_NEAR(step.z, index * flight.rise, 0.03);
    EXPECT_NEAR(step.along, (index - 1.0) * flight.depth, 0.08);
    EXPECT_NEAR(step.depth, flight.depth, 0.02);
  }
  EXPECT_GT(stairs.evidence, 3.0);
  EXPECT_FALSE(stairs.points_in_submap.empty());
}

TEST(StaircaseDetector, FindsAFlightObliquelyAndFromTheSide) {
  for (const double degrees : {30.0, 60.0, 85.0}) {
    DepthScene scene;
    const TrueFlight flight{.T_world_foot = at(2.4, 0.0, degrees * kDegree)};
    add(scene, flight);
    const auto found = sightings(scene, cameraAt({0.0, 0.0, 1.2}, 0.1, 0.1));
    ASSERT_EQ(found.size(), 1U) << degrees;
    EXPECT_LT(directionError(found[0], flight), 3.0 * kDegree) << degrees;
    EXPECT_LT(footError(found[0], flight), 0.25) << degrees;
  }
}

TEST(StaircaseDetector, FindsTheSameInAMovedAndTurnedSubmap) {
  DepthScene scene;
  const TrueFlight flight{.T_world_foot = at(2.2, 0.0, 0.3)};
  add(scene, flight);
  const Pose3 T_world_camera = cameraAt({0.0, 0.0, 1.1}, 0.1, 0.15, 0.5);
  const Pose3 T_submap_world = at(-4.0, 9.0, 2.5, 3.2);
  const auto found = sightings(scene.look(T_world_camera), T_submap_world * T_world_camera, 3.2);
  ASSERT_EQ(found.size(), 1U);
  TrueFlight inSubmap = flight;
  inSubmap.T_world_foot = T_submap_world * flight.T_world_foot;
  EXPECT_LT(footError(found[0], inSubmap), 0.12);
  EXPECT_LT(directionError(found[0], inSubmap), 2.5 * kDegree);
}

TEST(StaircaseDetector, SeesWhereAFlightEnds) {
  DepthScene scene;
  const TrueFlight flight{.T_world_foot = at(1.8, 0.0, 0.0), .steps = 5, .landing = 1.5};
  add(scene, flight);
  const auto found = sightings(scene, cameraAt({0.0, 0.0, 1.3}, 0.0, 0.2));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].headIsSeen);
  EXPECT_TRUE(found[0].footIsSeen);
  EXPECT_EQ(found[0].steps.size(), 5U);
  EXPECT_NEAR(found[0].newFloor_z, 5 * flight.rise, 0.03);
  EXPECT_LT(found[0].newFloorSigma, 0.1);
}

TEST(StaircaseDetector, TellsTheNewFloorByTheCeilingWhereTheHeadIsNotSeen) {
  DepthScene scene({12.0, 12.0, 2.6});
  add(scene, {.T_world_foot = at(2.6, 0.8, 0.0), .steps = 15});
  const auto found = sightings(scene, cameraAt({-0.6, -0.6, 1.2}, 0.2, -0.1));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_FALSE(found[0].headIsSeen);
  EXPECT_NEAR(found[0].newFloor_z, 2.8, 0.2);
  EXPECT_GT(found[0].newFloorSigma, 0.2);
}

TEST(StaircaseDetector, FindsLowSteps) {
  DepthScene scene;
  const TrueFlight flight{.T_world_foot = at(1.6, 0.0, 0.0), .steps = 4, .rise = 0.08, .depth = 0.30, .width = 0.9};
  add(scene, flight);
  const auto found = sightings(scene, cameraAt({0.0, 0.0, 1.0}, 0.0, 0.45));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].slope, 0.27, 0.05);
  EXPECT_LT(directionError(found[0], flight), 5.0 * kDegree);
}

TEST(StaircaseDetector, FindsADescendingFlightFromItsHead) {
  // The robot stands on a platform 2 m above the floor; the flight leads down ahead of it.
  DepthScene scene({14.0, 8.0, 5.0});
  const TrueFlight flight{.T_world_foot = at(4.5, 0.0, std::numbers::pi), .steps = 12, .landing = 3.0};
  add(scene, flight);
  const double top_z = 12 * flight.rise;
  const Pose3 T_world_camera = cameraAt({0.7, 0.0, top_z + 1.2}, 0.0, 0.75);
  const auto found = sightings(scene.look(T_world_camera), T_world_camera, top_z);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].descends);
  EXPECT_LT(directionError(found[0], flight), 5.0 * kDegree);
  EXPECT_NEAR(found[0].slope, flight.rise / flight.depth, 0.08);
  for (const Step& step : found[0].steps) EXPECT_LT(step.z, top_z + 0.02);
}

TEST(StaircaseDetector, TakesAFlightCutByTheImageForASightingWithFewSteps) {
  DepthScene scene;
  const TrueFlight flight{.T_world_foot = at(1.9, 0.0, 0.0)};
  add(scene, flight);
  // Only its right half is in the picture.
  const auto found = sightings(scene, cameraAt({0.0, 0.0, 1.2}, -0.62));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_FALSE(found[0].widthIsWhole);
  EXPECT_LT(found[0].width, flight.width);
  EXPECT_LT(directionError(found[0], flight), 5.0 * kDegree);
  const Eigen::Vector3d across = found[0].T_submap_stairs.linear().col(1);
  const Eigen::Vector3d along = found[0].T_submap_stairs.linear().col(0);
  const Eigen::Matrix3d covariance = found[0].covariance.topLeftCorner<3, 3>();
  EXPECT_GT(across.dot(covariance * across), 4.0 * along.dot(covariance * along));
}

TEST(StaircaseDetector, FindsTwoFlightsSideBySide) {
  DepthScene scene;
  add(scene, {.T_world_foot = at(2.5, 0.9, 0.0), .width = 1.0});
  add(scene, {.T_world_foot = at(2.5, -0.9, 0.0), .width = 1.0});
  EXPECT_EQ(sightings(scene, cameraAt({0.0, 0.0, 1.2}, 0.0)).size(), 2U);
}

TEST(StaircaseDetector, IsTheSameEachTime) {
  DepthScene scene;
  add(scene, {.T_world_foot = at(2.2, 0.1, 0.0)});
  const Pose3 T_world_camera = cameraAt({0.0, 0.0, 1.2}, 0.0);
  const sensors::RgbdFrame frame = scene.look(T_world_camera);
  const auto once = sightings(frame, T_world_camera);
  const auto again = sightings(frame, T_world_camera);
  ASSERT_EQ(once.size(), 1U);
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(once[0].T_submap_stairs.matrix(), again[0].T_submap_stairs.matrix());
  EXPECT_EQ(once[0].evidence, again[0].evidence);
}

TEST(StaircaseDetector, ARampIsNoStaircase) {
  for (const double degrees : {10.0, 20.0, 33.0}) {
    DepthScene scene;
    scene.addBox(geometry::fromYawPitchRoll({3.4, 0.0, 0.4}, 0.0, -degrees * kDegree, 0.0), {3.0, 1.2, 0.1});
    EXPECT_TRUE(sightings(scene, cameraAt({0.0, 0.0, 1.2}, 0.0)).empty()) << degrees;
  }
}

TEST(StaircaseDetector, ALeaningBoardIsNoStaircase) {
  DepthScene scene;
  scene.addBox(geometry::fromYawPitchRoll({3.0, 0.0, 0.9}, 0.2, -45.0 * kDegree, 0.0), {2.4, 0.8, 0.03});
  EXPECT_TRUE(sightings(scene, cameraAt({0.0, 0.0, 1.2}, 0.0)).empty());
}

TEST(StaircaseDetector, PilesOfBoxesAreNoStaircase) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    DepthScene scene;
    base::Random random(seed, "boxes");
    for (int i = 0; i < 8; ++i) {
      scene.addBox(geometry::fromYawPitchRoll({random.uniform(1.8, 3.2), random.uniform(-0.8, 0.8), 0.3},
                                              random.uniform(0.0, 1.5), 0.0, 0.0),
                   {random.uniform(0.3, 0.6), random.uniform(0.3, 0.6), random.uniform(0.2, 1.2)});
    }
    EXPECT_TRUE(sightings(scene, cameraAt({0.0, 0.0, 1.2}, 0.0, 0.1)).empty()) << seed;
  }
}

TEST(StaircaseDetector, BoxesPiledUpLikeStepsAreTooLongForAPace) {
  DepthScene scene;
  for (int i = 0; i < 4; ++i) {
    scene.addBlock(at(1.8 + 0.38 * i, 0.0, 0.0), {0.38, 0.9, 0.24 * (i + 1)});
  }
  for (const auto& sighting : sightings(scene, cameraAt({0.0, 0.0, 1.2}, 0.0, 0.1))) EXPECT_LT(sighting.evidence, 0.0);
}

TEST(StaircaseDetector, WhatIsSteeperThanAnyStairsIsNoStaircase) {
  for (const double depth : {0.19, 0.21}) {  // as boxes on shelves may lie by chance
    DepthScene scene;
    add(scene, {.T_world_foot = at(1.8, 0.0, 0.3), .steps = 7, .rise = 0.23, .depth = depth, .width = 0.6});
    EXPECT_TRUE(sightings(scene, cameraAt({0.0, 0.0, 1.2}, 0.0)).empty()) << depth;
  }
}

TEST(StaircaseDetector, ShelvesAreNoStaircase) {
  DepthScene scene;
  scene.addBox(at(2.9, 0.0, 0.0, 0.9), {0.03, 1.6, 1.8});  // back
  for (int i = 0; i < 6; ++i) scene.addBox(at(2.7, 0.0, 0.0, 0.1 + 0.33 * i), {0.4, 1.6, 0.03});
  EXPECT_TRUE(sightings(scene, cameraAt({0.0, 0.0, 1.2}, 0.0)).empty());
  EXPECT_TRUE(sightings(scene, cameraAt({0.6, 1.5, 1.2}, -0.6)).empty());
}

TEST(StaircaseDetector, SofasAndChairsAreNoStaircase) {
  for (const double yaw : {0.0, 0.5, -0.8}) {
    DepthScene scene;
    const Pose3 sofa = at(2.4, 0.3, yaw);
    scene.addBlock(sofa, {0.6, 1.8, 0.42});
    scene.addBlock(sofa * at(0.6, 0.0, 0.0), {0.2, 1.8, 0.82});
    const Pose3 chair = at(1.8, -1.2, yaw);
    scene.addBlock(chair * at(0.0, 0.0, 0.0, 0.42), {0.45, 0.45, 0.04});
    scene.addBlock(chair * at(0.43, 0.0, 0.0, 0.46), {0.04, 0.45, 0.45});
    EXPECT_TRUE(sightings(scene, cameraAt({0.0, 0.0, 1.2}, 0.0, 0.1)).empty()) << yaw;
  }
}

TEST(StaircaseDetector, ARadiatorIsNoStaircase) {
  DepthScene scene;
  for (int i = 0; i < 20; ++i) scene.addBox(at(3.0, -0.6 + 0.06 * i, 0.0, 0.45), {0.1, 0.03, 0.6});
  EXPECT_TRUE(sightings(scene, cameraAt({0.5, 0.0, 1.2}, 0.0)).empty());
}

TEST(StaircaseDetector, InventsNothingOfBadInput) {
  const Pose3 T_world_camera = cameraAt({0.0, 0.0, 1.2}, 0.0);
  sensors::RgbdFrame frame;
  frame.camera = {525.0, 525.0, 319.5, 239.5, {}};
  EXPECT_TRUE(sightings(frame, T_world_camera).empty());
  for (const float depth : {0.0F, 2.0F, std::numeric_limits<float>::quiet_NaN()}) {
    frame.depth = sensors::Image<float>(640, 480, depth);
    EXPECT_TRUE(sightings(frame, T_world_camera).empty()) << depth;
  }
  base::Random random(1, "rubbish");
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    frame.depth.data()[i] = static_cast<float>(random.uniform(0.5, 5.0));
  }
  EXPECT_TRUE(sightings(frame, T_world_camera).empty());
}

TEST(StaircaseDetector, InventsNothingUpsideDown) {
  DepthScene scene;
  const TrueFlight flight{.T_world_foot = at(2.2, 0.0, 0.0)};
  add(scene, flight);
  const sensors::RgbdFrame frame = scene.look(cameraAt({0.0, 0.0, 1.2}, 0.0, 0.0, std::numbers::pi));
  EXPECT_TRUE(sightings(frame, cameraAt({0.0, 0.0, 1.2}, 0.0)).empty());
  // In its true pose it is as good as any.
  EXPECT_EQ(sightings(frame, cameraAt({0.0, 0.0, 1.2}, 0.0, 0.0, std::numbers::pi)).size(), 1U);
}

TEST(StaircaseDetector, LooksForNothingWhereItIsNotEnabled) {
  DepthScene scene;
  add(scene, {.T_world_foot = at(2.2, 0.0, 0.0)});
  const Pose3 T_world_camera = cameraAt({0.0, 0.0, 1.2}, 0.0);
  const sensors::RgbdFrame frame = scene.look(T_world_camera);
  const RgbdView view{.frame = frame, .T_submap_camera = T_world_camera};
  EXPECT_TRUE(findStaircases(view, findSurfaces(view, {}), {.enabled = false}).empty());
}

TEST(StaircaseDetector, DrawsWhatItFinds) {
  const test::TemporaryFolder folder;
  DepthScene scene;
  add(scene, {.T_world_foot = at(2.2, 0.0, 0.0)});
  const Pose3 T_world_camera = cameraAt({0.0, 0.0, 1.2}, 0.0);
  const sensors::RgbdFrame frame = scene.look(T_world_camera);
  const RgbdView view{.frame = frame, .T_submap_camera = T_world_camera};
  DebugImages debug(folder.path());
  debug.beginFrame(0);
  findStaircases(view, findSurfaces(view, {}), {}, &debug);
  ASSERT_FALSE(std::filesystem::is_empty(folder.path()));
  const cv::Mat picture = cv::imread(std::filesystem::directory_iterator(folder.path())->path().string());
  EXPECT_EQ(picture.cols, 640);
  EXPECT_EQ(picture.rows, 480);
}

/// A depth image of the Kinect v2 (millimetres; intrinsics as the set's clouds have them) and the direction of its
/// treads' normals, which is up.
struct KinectView {
  const char* file;
  Eigen::Vector3d up_in_camera;
  double floor_z;  ///< seen from the camera
  int leastSteps;
};

TEST(StaircaseDetector, FindsTheLowRealStaircaseInBothViews) {
  for (const KinectView& kinect :
       {KinectView{"rgbd/stairs_kinect2/0000_depth.png", {-0.037, -0.220, -0.975}, -0.96, 3},
        KinectView{"rgbd/stairs_kinect2/0001_depth.png", {-0.035, -0.923, -0.383}, -0.66, 4}}) {
    const auto file = test::dataset(kinect.file);
    if (!file) GTEST_SKIP() << "needs " << kinect.file;
    const cv::Mat millimetres = cv::imread(file->string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(millimetres.type(), CV_16UC1);
    sensors::RgbdFrame frame;
    frame.camera = {365.0, 365.0, 256.0, 206.0, {}};
    frame.depth = sensors::Image<float>(millimetres.cols, millimetres.rows);
    for (int y = 0; y < millimetres.rows; ++y) {
      for (int x = 0; x < millimetres.cols; ++x) {
        frame.depth(x, y) = 0.001F * static_cast<float>(millimetres.at<std::uint16_t>(y, x));
      }
    }
    const Eigen::Quaterniond level = Eigen::Quaterniond::FromTwoVectors(kinect.up_in_camera, Eigen::Vector3d::UnitZ());
    const auto found = sightings(frame, Pose3(level), kinect.floor_z);
    ASSERT_EQ(found.size(), 1U) << kinect.file;
    EXPECT_GE(static_cast<int>(found[0].steps.size()), kinect.leastSteps) << kinect.file;
    EXPECT_NEAR(found[0].slope, 0.35, 0.1) << kinect.file;
    EXPECT_NEAR(found[0].width, 0.83, 0.15) << kinect.file;
    EXPECT_GT(found[0].evidence, 0.0) << kinect.file;
  }
}

/// Where a frame was taken, over a floor of height 0: as recorded before it, else by the floor that it shows.
std::optional<Pose3> placeOf(const sensors::RgbdFrame& frame, const std::optional<Pose3>& T_world_body) {
  if (T_world_body) return *T_world_body * frame.T_body_camera;
  return test::levelByFloor(frame);
}

TEST(StaircaseDetector, FindsNoneInRealRoomsAndCorridorsWithoutAny) {
  constexpr int kEvery = 10;
  for (const char* name : {"rgbd/icsl_corridor", "rgbd/tum_fr1_rpy", "rgbd/tum_fr3_structure"}) {
    const auto log = test::dataset(name);
    if (!log) GTEST_SKIP() << "needs " << name;
    const auto source = io::openSource(*log);
    std::optional<Pose3> T_world_body;
    int frames = 0;
    int looked = 0;
    for (auto item = source->next(); !std::holds_alternative<sensors::EndOfLog>(item); item = source->next()) {
      const auto* reading = std::get_if<sensors::Reading>(&item);
      if (reading == nullptr) continue;
      if (const auto* pose = std::get_if<sensors::RecordedPose>(&reading->data)) T_world_body = pose->T_world_body;
      const auto* frame = std::get_if<sensors::RgbdFrame>(&reading->data);
      if (frame == nullptr || frames++ % kEvery != 0) continue;
      const auto T_world_camera = placeOf(*frame, T_world_body);
      if (!T_world_camera) continue;
      EXPECT_TRUE(sightings(*frame, *T_world_camera, 0.0).empty()) << name << ", frame " << frames - 1;
      ++looked;
    }
    EXPECT_GT(looked, frames / kEvery / 2) << name;
  }
}

}  // namespace
}  // namespace prodomos::perception

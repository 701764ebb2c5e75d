// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/staircase_detector.hpp"
#include "prodomos/simulation/furniture.hpp"
#include "prodomos/simulation/shell.hpp"
#include "prodomos/simulation/simulator.hpp"

#include "perception/depth_scene.hpp"
#include "support/datasets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <iterator>
#include <numbers>
#include <utility>

namespace prodomos::perception {
namespace {

using geometry::Pose3;
using simulation::Building;
using simulation::Staircase;
using test::DepthScene;

constexpr double kCameraHeight = 1.2;

DepthScene sceneOf(const Building& building, std::uint64_t seed) {
  auto surfaces = simulation::shellOf(building, seed);
  const auto add = [&](std::vector<simulation::Surface> more) {
    std::ranges::move(more, std::back_inserter(surfaces));
  };
  add(building.imported);
  for (std::size_t i = 0; i < building.things.size(); ++i) add(simulation::surfacesOf(building, i, seed));
  for (std::size_t i = 0; i < building.doors.size(); ++i) add(simulation::leavesAt(building, i, 0.0, seed));
  return DepthScene(std::move(surfaces));
}

/// Steps of which the camera sees half of the riser or half of the tread, as docs/truth.md counts them.
int visibleSteps(const DepthScene& scene, const Staircase& stairs, const Pose3& T_world_camera) {
  const simulation::CameraModel camera;
  const Pose3 T_world_foot = geometry::fromYawPitchRoll(stairs.foot, stairs.direction, 0.0, 0.0);
  const Eigen::Vector3d eye = T_world_camera.translation();
  const auto isSeen = [&](const Eigen::Vector3d& spot, const Eigen::Vector3d& normal) {
    const Eigen::Vector3d to = spot - eye;
    const double range = to.norm();
    if (range < 0.6 || range > 4.5 || -normal.dot(to) < std::cos(75.0 * std::numbers::pi / 180.0) * range) return false;
    const Eigen::Vector3d inCamera = T_world_camera.inverse() * spot;
    if (inCamera.z() < 0.1) return false;
    const Eigen::Vector2d pixel = simulation::project(camera, inCamera);
    if (pixel.minCoeff() < 0.0 || pixel.x() > camera.width - 1 || pixel.y() > camera.height - 1) return false;
    return !scene.rayScene().isOccluded(eye, to, 0.98);
  };
  int visible = 0;
  for (int step = 0; step < stairs.stepCount; ++step) {
    int riser = 0;
    int tread = 0;
    for (int i = 0; i < 20; ++i) {
      const double y = stairs.width * ((i / 2 + 0.5) / 10.0 - 0.5);
      const double share = i % 2 == 0 ? 0.25 : 0.75;
      const double x = step * stairs.stepDepth;
      riser += isSeen(T_world_foot * Eigen::Vector3d(x, y, (step + share) * stairs.stepHeight),
                      T_world_foot.linear() * -Eigen::Vector3d::UnitX());
      tread += isSeen(T_world_foot * Eigen::Vector3d(x + share * stairs.stepDepth, y, (step + 1) * stairs.stepHeight),
                      Eigen::Vector3d::UnitZ());
    }
    if (riser >= 10 || tread >= 10) ++visible;
  }
  return visible;
}

struct Tally {
  int visible = 0;
  int found = 0;
  int wrong = 0;
  std::vector<double> foot;       ///< metres, where foot and both sides are told
  std::vector<double> direction;  ///< degrees
  std::vector<double> width;      ///< metres, where both sides are seen
  std::vector<double> newFloor;   ///< metres, where the head is seen

  void add(const StaircaseSighting& sighting, const Staircase& stairs);
};

double medianOf(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

double turnBetween(const StaircaseSighting& sighting, const Staircase& stairs) {
  return std::abs(geometry::normalizeAngle(geometry::yaw(sighting.T_submap_stairs) - stairs.direction));
}

void Tally::add(const StaircaseSighting& sighting, const Staircase& stairs) {
  direction.push_back(turnBetween(sighting, stairs) * 180.0 / std::numbers::pi);
  if (sighting.widthIsWhole) width.push_back(std::abs(sighting.width - stairs.width));
  if (sighting.headIsSeen) newFloor.push_back(std::abs(sighting.newFloor_z - simulation::headOf(stairs).z()));
  if (sighting.footIsSeen && sighting.widthIsWhole) {
    foot.push_back((sighting.T_submap_stairs.translation() - stairs.foot).norm());
  }
}

/// Its foot lies on the true flight, and it leads the same way.
bool isOf(const StaircaseSighting& sighting, const Staircase& stairs) {
  const Pose3 T_world_foot = geometry::fromYawPitchRoll(stairs.foot, stairs.direction, 0.0, 0.0);
  const Eigen::Vector3d foot = T_world_foot.inverse() * sighting.T_submap_stairs.translation();
  const double run = stairs.stepCount * stairs.stepDepth;
  return turnBetween(sighting, stairs) < 0.5 && foot.x() > -0.5 && foot.x() < run &&
         std::abs(foot.y()) < 0.5 * stairs.width &&
         std::abs(foot.z() - foot.x() * stairs.stepHeight / stairs.stepDepth) < 0.5;
}

void judge(Tally& tally, std::vector<StaircaseSighting> sightings, const Building& building, const DepthScene& scene,
           const Pose3& T_world_camera) {
  for (const Staircase& stairs : building.stairs) {
    const auto found = std::ranges::find_if(sightings, [&](const auto& sighting) { return isOf(sighting, stairs); });
    const bool isVisible = visibleSteps(scene, stairs, T_world_camera) >= 3;
    tally.visible += isVisible ? 1 : 0;
    if (found == sightings.end()) continue;
    tally.found += isVisible ? 1 : 0;
    tally.add(*found, stairs);
    sightings.erase(found);
  }
  tally.wrong += static_cast<int>(sightings.size());
}

/// Somewhere on a floor 1 to 5 m from a flight, looking its way or past it.
std::optional<Pose3> drawView(const Building& building, const DepthScene& scene, base::Random& random) {
  const auto index = static_cast<std::size_t>(random.integer(0, static_cast<int>(building.stairs.size()) - 1));
  const Staircase& stairs = building.stairs[index];
  const Eigen::Vector3d target = stairs.foot + random.uniform(0.0, 0.6) * (simulation::headOf(stairs) - stairs.foot);
  const double bearing = random.uniform(-std::numbers::pi, std::numbers::pi);
  const double range = random.uniform(1.0, 5.0);
  const double yaw = bearing + std::numbers::pi + random.uniform(-0.5, 0.5);
  if (stairs.lowerStorey < 0) return std::nullopt;
  const double floor_z = building.storeys[static_cast<std::size_t>(stairs.lowerStorey)].floor_z;
  const Eigen::Vector3d eye(target.x() + range * std::cos(bearing), target.y() + range * std::sin(bearing),
                            floor_z + kCameraHeight);
  if (simulation::roomAt(building, stairs.lowerStorey, eye.head<2>()) < 0) return std::nullopt;
  const auto below = scene.rayScene().cast(eye, -Eigen::Vector3d::UnitZ());
  if (!below || std::abs(static_cast<double>(below.distance) - kCameraHeight) > 0.02) return std::nullopt;
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d around(std::cos(0.5236 * i), std::sin(0.5236 * i), 0.0);
    if (scene.rayScene().isOccluded(eye, around, 0.35)) return std::nullopt;
  }
  const Pose3 T_world_camera = test::cameraAt(eye, yaw);
  if (visibleSteps(scene, stairs, T_world_camera) < 2) return std::nullopt;
  return T_world_camera;
}

TEST(StaircaseViews, OfBuildingsAreFoundAndMeasured) {
  constexpr int kViews = 12;
  Tally tally;
  for (const char* name : {"buildings/plans/school/plans1_updated.xml", "buildings/plans/school/Histor4_updated.xml",
                           "buildings/plans/school/bronxville_updated.xml"}) {
    const auto file = test::dataset(name);
    if (!file) GTEST_SKIP() << "needs " << name;
    Building building = simulation::openScene(*file, 3);
    simulation::furnish(building, 3);
    const DepthScene scene = sceneOf(building, 3);
    base::Random random(3, name);
    for (int view = 0; view < kViews;) {
      const auto T_world_camera = drawView(building, scene, random);
      if (!T_world_camera) continue;
      const auto frame = scene.look(*T_world_camera, true, static_cast<std::uint64_t>(++view));
      const RgbdView rgbd{.frame = frame,
                          .T_submap_camera = *T_world_camera,
                          .floor_z = T_world_camera->translation().z() - kCameraHeight};
      judge(tally, findStaircases(rgbd, findSurfaces(rgbd, {}), {}), building, scene, *T_world_camera);
    }
  }
  std::cout << "visible " << tally.visible << ", found " << tally.found << ", wrong " << tally.wrong
            << "; medians: foot " << medianOf(tally.foot) << " m, direction " << medianOf(tally.direction)
            << " deg, width " << medianOf(tally.width) << " m, new floor " << medianOf(tally.newFloor) << " m\n";
  EXPECT_GT(tally.visible, 25);
  EXPECT_GE(tally.found, 0.95 * tally.visible);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_LT(medianOf(tally.foot), 0.10);
  EXPECT_LT(medianOf(tally.direction), 1.0);
  EXPECT_LT(medianOf(tally.width), 0.075);
  EXPECT_LT(medianOf(tally.newFloor), 0.10);
}

}  // namespace
}  // namespace prodomos::perception

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/tour.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/base/random.hpp"
#include "prodomos/simulation/navigation.hpp"
#include "prodomos/simulation/population.hpp"

#include "simulation/ways/driver.hpp"
#include "simulation/ways/explorer.hpp"
#include "simulation/ways/given_path.hpp"
#include "simulation/ways/passing.hpp"
#include "simulation/ways/stepping_aside.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

namespace prodomos::simulation {

namespace {

/// Kept free beyond the robot's radius, for bends that it does not take quite as its way has them, metres.
constexpr double kReserve = 0.05;

void check(const TourOptions& options) {
  std::vector<std::string> faults;
  const auto mustBePositive = [&](double value, const char* name) {
    if (std::isfinite(value) && value > 0.0) return;
    faults.push_back(base::expectedFound(name, "a positive number", std::to_string(value)));
  };
  mustBePositive(options.duration, "the tour's duration");
  mustBePositive(options.speed, "the robot's speed");
  mustBePositive(options.turnRate, "the robot's turn rate");
  mustBePositive(options.acceleration, "the robot's acceleration");
  mustBePositive(options.turnAcceleration, "the robot's turn acceleration");
  mustBePositive(options.robotRadius, "the robot's radius");
  if (!faults.empty()) throw base::UsageError(std::move(faults));
}

/// Is someone who walks or stands in the way of the robot, or about to be? People on chairs are furniture.
bool someoneIsAhead(const Building& building, const DrivenPose& now, double distance) {
  constexpr double kAside = 0.5;
  const Eigen::Rotation2Dd R_robot_world(-now.pose.theta);
  return std::ranges::any_of(building.people, [&](const Person& person) {
    if (person.sits || person.storey != now.storey) return false;
    return std::ranges::any_of(std::array{0.0, 0.4, 0.8}, [&](double later) {
      const Eigen::Vector2d offset = positionAt(person, now.time + later) - Eigen::Vector2d(now.pose.x, now.pose.y);
      const Eigen::Vector2d inRobot = R_robot_world * offset;
      return inRobot.x() > 0.0 && inRobot.x() < distance && std::abs(inRobot.y()) < kAside;
    });
  });
}

struct Stay {
  double from;
  double to;
};

/// While the robot is around a door that it passes. A lift rides with its doors closed.
std::vector<Stay> passages(const Door& door, const std::vector<DrivenPose>& driven) {
  constexpr double kAround = 1.4;  // metres: a leaf and a robot
  const Eigen::Vector2d middle(door.pose.x, door.pose.y);
  std::vector<Stay> stays;
  std::optional<Stay> stay;
  bool passed = false;
  int storey = driven.front().storey;
  for (const auto& now : driven) {
    const int before = std::exchange(storey, now.storey);
    const Eigen::Vector2d position(now.pose.x, now.pose.y);
    if (now.storey == door.storey && (position - middle).norm() < kAround) {
      if (!stay) stay = {before == kBetweenStoreys ? now.time + kSwingTime : now.time, now.time};
      stay->to = now.time;
      passed = passed || liesInOpening(door, position);
      continue;
    }
    if (stay && now.storey == kBetweenStoreys) stay->to -= Driver::kLiftDoors - kSwingTime;
    if (passed) stays.push_back(*stay);
    stay.reset();
    passed = false;
  }
  if (passed) stays.push_back(*stay);
  return stays;
}

/// Between two times at which the robot comes by: it finds the door closed, and later open.
std::optional<Stay> absence(const Door& door, const std::vector<DrivenPose>& driven) {
  constexpr double kSeen = 3.0;    // metres
  constexpr double kLeast = 12.0;  // seconds
  const Eigen::Vector2d middle(door.pose.x, door.pose.y);
  std::optional<double> last;
  for (const auto& now : driven) {
    if (now.storey != door.storey || (Eigen::Vector2d(now.pose.x, now.pose.y) - middle).norm() > kSeen) continue;
    if (last && now.time - *last > kLeast) return Stay{*last, now.time};
    last = now.time;
  }
  return std::nullopt;
}

/// Doors open for the robot, and some others while it is elsewhere.
void openDoors(Building& building, const std::vector<DrivenPose>& driven, const TourOptions& options) {
  constexpr double kStaysOpen = 0.25;
  constexpr double kOpensLater = 0.35;
  base::Random random(options.seed, "doors of the tour");
  for (auto& door : building.doors) {
    const bool isLift = isLiftDoor(building, door);
    const bool staysOpen = random.uniform() < kStaysOpen && !isLift;
    const double hold = isLift ? 0.0 : random.uniform(0.5, 4.0);
    const bool opensLater = random.uniform() < kOpensLater && !isLift;
    if (door.leaves == 0 || !canBePassed(building, door)) continue;
    const double angle = passingAngle(building, door);
    const auto passed = passages(door, driven);
    for (const auto& [from, to] : passed) openFor(door, from, to + hold, angle);
    if (!passed.empty() && staysOpen) openFor(door, passed.back().from, options.duration + kSwingTime, angle);
    const auto away = passed.empty() && opensLater ? absence(door, driven) : std::nullopt;
    if (away) openFor(door, std::midpoint(away->from, away->to), options.duration + kSwingTime, angle);
  }
}

geometry::Pose3 toPose3(const DrivenPose& driven) {
  return geometry::toPose3(driven.pose, driven.z);
}

}  // namespace

geometry::Pose3 poseAt(const Tour& tour, double time) {
  const auto& poses = tour.poses;
  if (poses.empty()) return geometry::Pose3::Identity();
  const auto next = std::ranges::upper_bound(poses, time, {}, &TourPose::time);
  if (next == poses.begin()) return poses.front().T_world_body;
  if (next == poses.end()) return poses.back().T_world_body;
  const auto& before = *std::prev(next);
  return geometry::interpolate(before.T_world_body, next->T_world_body,
                               (time - before.time) / (next->time - before.time));
}

Tour planTour(Building& building, const TourOptions& options) {
  check(options);
  const Floors floors(building, options.robotRadius + kReserve);
  constexpr double kKept = 0.8;  // between robot and person, metres
  const double braking = options.speed * options.speed / (2.0 * options.acceleration);
  const auto mustWait = [&](const DrivenPose& now) {
    return someoneIsAhead(building, now, kKept + options.robotRadius + braking);
  };
  Tour tour;
  const auto start =
      options.path.empty() ? startOf(building, floors, options) : startOf(building, floors, options.path);
  Driver driver(options, start, mustWait);
  if (options.path.empty()) {
    Explorer explorer(building, floors, options, driver);
    explorer.explore();
    tour.remarks = explorer.remarks();
  } else {
    tour.remarks = driveAlong(options.path, floors, driver);
  }
  for (auto& person : building.people) stepAside(driver.driven(), floors.grids, person);
  openDoors(building, driver.driven(), options);
  for (const auto& driven : driver.driven()) tour.poses.push_back({driven.time, toPose3(driven)});
  // The last tick goes beyond the end where the duration is no multiple of it.
  tour.poses.back() = {options.duration, poseAt(tour, options.duration)};
  return tour;
}

}  // namespace prodomos::simulation

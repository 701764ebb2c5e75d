// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pose.hpp"
#include "prodomos/simulation/navigation.hpp"
#include "prodomos/simulation/tour.hpp"

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace prodomos::simulation {

inline constexpr int kBetweenStoreys = -1;

/// Where a robot is at one time.
struct DrivenPose {
  double time = 0.0;
  geometry::Pose2 pose;
  double z = 0.0;
  int storey = 0;  ///< or kBetweenStoreys
};

/// Must the robot wait, here and now?
using WaitRule = std::function<bool(const DrivenPose& now)>;

/// A robot on two wheels that follows ways within its limits of speed and acceleration, until its time is over.
class Driver {
 public:
  Driver(const TourOptions& limits, const DrivenPose& start, WaitRule mustWait);

  const DrivenPose& now() const { return driven_.back(); }
  Eigen::Vector2d position() const { return {now().pose.x, now().pose.y}; }
  bool isOver() const { return now().time >= limits_.duration; }
  /// One each kTick, from time 0 on.
  const std::vector<DrivenPose>& driven() const { return driven_; }

  /// Does the way begin so far to the side that the robot would first turn on the spot?
  bool mustTurnFor(const Polyline& way) const;

  enum class AtEnd { kStop, kGoOn };
  /// kGoOn: is back shortly before the end, still rolling. On the spot it turns only where the way begins or bends
  /// sharply.
  void follow(const Polyline& way, AtEnd atEnd);
  /// Straight from point to point, turning on the spot at each.
  void followExactly(const Polyline& way);
  /// On the spot; beyond ±π it goes round.
  void turnBy(double angle);
  void turnTo(double heading);
  void stand(double seconds);
  /// Along a flight of stairs: straight from point to point, turning where they stand level, up and down as they say.
  void carryAlong(const std::vector<Eigen::Vector3d>& way, int toStorey);
  void ride(double z, int toStorey);

  static constexpr double kTick = 0.02;  ///< seconds
  /// How long it stands in a lift before and after the ride, until the doors have closed or opened; seconds.
  static constexpr double kLiftDoors = 2.5;

 private:
  struct Track;

  void step(double speed, double turnRate);
  void stop();
  void straightTo(const Eigen::Vector3d& goal, double speed);
  bool waits();
  double fastestBefore(double distance) const;
  double fastestTurnBefore(double angle) const;

  TourOptions limits_;
  WaitRule mustWait_;
  std::vector<DrivenPose> driven_;
  double speed_ = 0.0;
  double turnRate_ = 0.0;
  double waited_ = 0.0;
};

}  // namespace prodomos::simulation

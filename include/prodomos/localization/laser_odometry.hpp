// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/bytes.hpp"
#include "prodomos/base/config.hpp"
#include "prodomos/localization/scan_matcher.hpp"
#include "prodomos/map/surface_layer.hpp"

#include <Eigen/Core>

#include <deque>
#include <optional>
#include <span>

namespace prodomos::localization {

struct LaserOdometryConfig {
  double reach = 16.0;          ///< metres of way that the local map holds at most; at least half of it
  double keyDistance = 0.1;     ///< metres between scans that are added to the local map
  double keyTurn = 0.05;        ///< radians, the same
  double maxRange = 30.0;       ///< metres; farther points are not matched
  double slip = 0.1;            ///< of wheel odometry: standard deviation over the way and the turn it tells
  double leastExplained = 0.2;  ///< share of a scan's points that must lie on the local map's surfaces
  ScanMatcherConfig match;
};

void describe(base::ConfigVisitor& visitor, LaserOdometryConfig& config);

/// Where a robot with a laser goes: each scan is matched with a local map of the scans before. Drifts slowly, and not
/// at all while the robot stays within its local map.
class LaserOdometry {
 public:
  struct Estimate {
    geometry::Pose2 T_travel_body;  ///< `travel` is the body at the first scan
    /// Of the way since the last estimate, in the axes of the body now: metres, radians.
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    bool isLost = false;  ///< the scan did not fit: the pose is no more than the prior's
  };

  explicit LaserOdometry(const LaserOdometryConfig& config = {});

  /// Scans in the order of their time, seen from above in the body's frame. `T_last_body`: the way since the last scan
  /// as wheel odometry tells it; without, the robot is taken to go on as it did.
  Estimate track(std::span<const Eigen::Vector2d> points_in_body, const std::optional<geometry::Pose2>& T_last_body);

  /// Bit by bit, so that a resumed run goes on exactly as the one that was interrupted.
  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);

 private:
  /// A scan's pose, and where the wheels alone would have led.
  struct Step {
    geometry::Pose2 T_travel_body;
    geometry::Pose2 T_wheels_body;
  };

  PosePrior predict(const Step& from) const;
  Match find(std::span<const Eigen::Vector2d> points_in_body) const;
  double gained();
  void remember(std::span<const Eigen::Vector2d> points_in_body);

  LaserOdometryConfig config_;
  map::SurfaceLayer older_;    // what scans are matched with
  map::SurfaceLayer younger_;  // takes its place once that has grown to config_.reach
  std::deque<Step> steps_;     // the latest last
  geometry::Pose2 T_wheels_body_;
  geometry::Pose2 T_travel_key_;
  bool hasWheels_ = false;
  double way_ = 0.0;       // metres that older_ has grown along
  double farthest_ = 0.0;  // metres from the key, of the scans since
};

}  // namespace prodomos::localization

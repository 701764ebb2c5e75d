// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/laser_odometry.hpp"

#include "prodomos/localization/pose_search.hpp"

#include <Eigen/LU>

#include <cmath>

namespace prodomos::localization {

namespace {

constexpr double kMetresPerRadian = 0.3;  // turning shows new things too
// What is known of the next pose without wheels: a person or robot changes its speed no faster between two scans.
constexpr double kFreeStep = 0.1;   // metres
constexpr double kFreeTurn = 0.1;   // radians
constexpr double kLeastStep = 5e-3;  // metres, radians; no wheel tells better

// Errors of one match are as good as independent of those of a match one metre on, where other points see other parts
// of the map. Points of one scan are not independent: kAlike of them count as one.
constexpr double kAlike = 20.0;

// Looked for around the prior, where what the prior leads to does not fit.
constexpr double kSearchReach = 0.6;  // metres
constexpr double kSearchTurn = 0.5;   // radians
constexpr double kSearchResolution = 0.1;
constexpr int kSearchLevels = 4;
constexpr double kBetter = 0.1;  // share of points that another place must explain more
constexpr std::size_t kLeastPoints = 10;

double wayOf(const geometry::Pose2& step) {
  return std::hypot(step.x, step.y) + kMetresPerRadian * std::abs(step.theta);
}

Eigen::Vector2d operator*(const geometry::Pose2& T_a_b, const Eigen::Vector2d& point_in_b) {
  return Eigen::Rotation2Dd(T_a_b.theta) * point_in_b + Eigen::Vector2d(T_a_b.x, T_a_b.y);
}

}  // namespace

void describe(base::ConfigVisitor& visitor, LaserOdometryConfig& config) {
  visitor.section("laser_odometry", "where a robot with a laser goes, scan by scan");
  visitor.key("reach", config.reach, "m", {1.0, 1000.0}, "way that the local map holds, which scans are matched with");
  visitor.key("key_distance", config.keyDistance, "m", {0.0, 10.0}, "way between scans that are added to the local map");
  visitor.key("key_turn", config.keyTurn, "rad", {0.0, 3.2}, "… or turn");
  visitor.key("max_range", config.maxRange, "m", {1.0, 500.0}, "farther points are not matched");
  visitor.key("slip", config.slip, "", {0.001, 1.0}, "standard deviation of wheel odometry over the way it tells");
  visitor.key("least_explained", config.leastExplained, "", {0.0, 1.0},
              "share of a scan's points that must fit the local map; else wheel odometry alone is followed");
  visitor.key("noise", config.match.noise, "m", {0.001, 1.0}, "standard deviation of an end point from the surface");
  visitor.key("outlier", config.match.outlier, "m", {0.01, 1.0}, "points farther from the surface count ever less");
  visitor.key("iterations", config.match.iterations, "", {1, 1000}, "of Gauss-Newton, at most");
  visitor.endSection();
}

LaserOdometry::LaserOdometry(const LaserOdometryConfig& config) : config_(config) {}

LaserOdometry::Estimate LaserOdometry::track(std::span<const Eigen::Vector2d> points_in_body,
                                             const std::optional<geometry::Pose2>& T_last_body) {
  Estimate estimate;
  if (hasBegun_) {
    const auto prior = predict(T_last_body);
    const auto match = find(points_in_body, prior);
    estimate.isLost = points_in_body.size() < kLeastPoints || match.explained < config_.leastExplained;
    const auto& T_travel_now = estimate.isLost ? prior.T_map_body : match.T_map_body;
    lastStep_ = geometry::inverse(T_travel_body_) * T_travel_now;
    T_travel_body_ = T_travel_now;

    const double way = wayOf(lastStep_);
    way_ += way;
    const double metre = config_.slip * config_.slip;
    const Eigen::Matrix3d wheels = Eigen::Vector3d::Constant(1.0 / metre).asDiagonal();
    const Eigen::Matrix3d known = estimate.isLost ? wheels : Eigen::Matrix3d(wheels + match.information / kAlike);
    estimate.covariance = way * known.inverse();
    if (estimate.isLost) estimate.covariance += prior.information.inverse();
  }
  estimate.T_travel_body = T_travel_body_;
  // A robot that is lost goes on mapping from where it believes to be, or it would never find itself again.
  remember(points_in_body);
  return estimate;
}

PosePrior LaserOdometry::predict(const std::optional<geometry::Pose2>& T_last_body) const {
  const auto step = T_last_body.value_or(lastStep_);
  double translation = kFreeStep;
  double rotation = kFreeTurn;
  if (T_last_body) {
    const double slip = config_.slip * wayOf(step);
    translation = kLeastStep + slip;
    rotation = kLeastStep + slip + config_.slip * std::abs(step.theta);
  }
  PosePrior prior{.T_map_body = T_travel_body_ * step};
  prior.information.diagonal() << 1.0 / (translation * translation), 1.0 / (translation * translation),
      1.0 / (rotation * rotation);
  return prior;
}

/// From the prior on; where that leads nowhere, from the best place around it.
Match LaserOdometry::find(std::span<const Eigen::Vector2d> points_in_body, const PosePrior& prior) const {
  const auto match = matchScan(points_in_body, older_, prior, config_.match);
  if (match.explained >= 2.0 * config_.leastExplained || points_in_body.size() < kLeastPoints) return match;
  const LikelihoodField field(older_, kSearchResolution, kSearchLevels);
  const auto found =
      searchPose(points_in_body, field, {prior.T_map_body, kSearchReach, kSearchTurn}, config_.leastExplained);
  if (!found) return match;
  const PosePrior loose{.T_map_body = found->T_map_body};
  const auto other = matchScan(points_in_body, older_, loose, config_.match);
  return other.explained > match.explained + kBetter ? other : match;
}

void LaserOdometry::remember(std::span<const Eigen::Vector2d> points_in_body) {
  const auto step = geometry::inverse(T_travel_key_) * T_travel_body_;
  const bool isKey = !hasBegun_ || std::hypot(step.x, step.y) > config_.keyDistance ||
                     std::abs(step.theta) > config_.keyTurn;
  if (!isKey) return;
  hasBegun_ = true;
  T_travel_key_ = T_travel_body_;
  if (way_ > config_.reach) {
    older_ = std::move(younger_);
    younger_ = map::SurfaceLayer();
    way_ -= 0.5 * config_.reach;
  }
  for (const auto& point : points_in_body) {
    const Eigen::Vector2d place = T_travel_body_ * point;
    older_.insert(place);
    if (way_ > 0.5 * config_.reach) younger_.insert(place);
  }
}

void LaserOdometry::save(base::ByteWriter& out) const {
  older_.save(out);
  younger_.save(out);
  for (const auto& pose : {T_travel_body_, T_travel_key_, lastStep_}) out << pose.x << pose.y << pose.theta;
  out << way_ << hasBegun_;
}

void LaserOdometry::load(base::ByteReader& in) {
  older_.load(in, older_.version());
  younger_.load(in, younger_.version());
  for (auto* pose : {&T_travel_body_, &T_travel_key_, &lastStep_}) in >> pose->x >> pose->y >> pose->theta;
  in >> way_ >> hasBegun_;
}

}  // namespace prodomos::localization

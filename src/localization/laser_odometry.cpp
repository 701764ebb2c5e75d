// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/laser_odometry.hpp"

#include "prodomos/localization/pose_search.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace prodomos::localization {

namespace {

constexpr double kMetresPerRadian = 0.3;  // turning shows new things too
// What is known of the next pose without wheels: a person or robot changes its speed no faster between two scans.
constexpr double kFreeStep = 0.1;    // metres
constexpr double kFreeTurn = 0.1;    // radians
constexpr double kLeastStep = 5e-3;  // metres, radians; no wheel tells better

// Errors of one match are as good as independent of those of a match one metre on, where other points see other parts
// of the map. Points of one scan are not independent: kAlike of them count as one.
constexpr double kAlike = 20.0;

// Looked for around the prior, where what the prior leads to does not fit.
constexpr double kSearchReach = 0.6;  // metres
constexpr double kSearchTurn = 0.5;   // radians
constexpr double kLostTurn = std::numbers::pi;
constexpr double kSearchResolution = 0.1;
constexpr int kSearchLevels = 4;
constexpr double kBetter = 0.1;  // share of points that another place must explain more
constexpr std::size_t kLeastPoints = 10;
constexpr std::size_t kSteps = 6;     // scans over which the wheels are asked, too
constexpr double kLateWheels = 0.05;  // metres between what they tell over one step and over all

double wayOf(const geometry::Pose2& step) {
  return std::hypot(step.x, step.y) + kMetresPerRadian * std::abs(step.theta);
}

void savePose(base::ByteWriter& out, const geometry::Pose2& pose) {
  out << pose.x << pose.y << pose.theta;
}
geometry::Pose2 loadPose(base::ByteReader& in) {
  geometry::Pose2 pose;
  in >> pose.x >> pose.y >> pose.theta;
  return pose;
}

}  // namespace

void describe(base::ConfigVisitor& visitor, LaserOdometryConfig& config) {
  visitor.section("laser_odometry", "where a robot with a laser goes, scan by scan");
  visitor.key("reach", config.reach, "m", {1.0, 1000.0}, "way that the local map holds, which scans are matched with");
  visitor.key("key_distance", config.keyDistance, "m", {0.0, 10.0},
              "way between scans that are added to the local map");
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
  if (steps_.empty()) {
    steps_.emplace_back();
    remember(points_in_body);
    return estimate;
  }
  const auto last = steps_.back().T_travel_body;
  // Without wheels, the robot is taken to go on as it did.
  hasWheels_ = T_last_body.has_value();
  const auto before = steps_.size() > 1 ? steps_[steps_.size() - 2].T_travel_body : last;
  T_wheels_body_ = T_wheels_body_ * T_last_body.value_or(geometry::inverse(before) * last);

  const auto match = find(points_in_body);
  estimate.isLost = points_in_body.size() < kLeastPoints || match.explained < config_.leastExplained;
  estimate.T_travel_body = match.T_map_body;
  steps_.push_back({match.T_map_body, T_wheels_body_});
  if (steps_.size() > kSteps) steps_.pop_front();

  const double way = estimate.isLost ? wayOf(geometry::inverse(last) * match.T_map_body) : gained();
  way_ += way;
  const Eigen::Matrix3d wheels = Eigen::Matrix3d::Identity() / (config_.slip * config_.slip);
  const Eigen::Matrix3d known = estimate.isLost ? wheels : Eigen::Matrix3d(wheels + match.information / kAlike);
  estimate.covariance = way * known.inverse();
  // A robot that is lost goes on mapping from where it believes to be, or it would never find itself again.
  remember(points_in_body);
  return estimate;
}

/// Where the wheels lead from an earlier scan on.
PosePrior LaserOdometry::predict(const Step& from) const {
  const auto step = geometry::inverse(from.T_wheels_body) * T_wheels_body_;
  double translation = kFreeStep;
  double rotation = kFreeTurn;
  if (hasWheels_) {
    const double slip = config_.slip * wayOf(step);
    translation = kLeastStep + slip;
    rotation = kLeastStep + slip + config_.slip * std::abs(step.theta);
  }
  PosePrior prior{.T_map_body = from.T_travel_body * step};
  prior.information.diagonal() << 1.0 / (translation * translation), 1.0 / (translation * translation),
      1.0 / (rotation * rotation);
  return prior;
}

/// From where the wheels lead; where that does not fit, from the best place around. What is no better than the wheels'
/// word gives that.
Match LaserOdometry::find(std::span<const Eigen::Vector2d> points_in_body) const {
  const auto prior = predict(steps_.back());
  auto best = matchScan(points_in_body, older_, prior, config_.match);
  if (points_in_body.size() < kLeastPoints) return {.T_map_body = prior.T_map_body};
  const auto take = [&](const Match& other) {
    if (other.explained > best.explained + kBetter) best = other;
  };
  // Wheels are read late at times, and then tell two steps at once: over several steps they are right again.
  const auto longPrior = predict(steps_.front());
  const auto difference = geometry::inverse(prior.T_map_body) * longPrior.T_map_body;
  if (hasWheels_ && wayOf(difference) > kLateWheels) take(matchScan(points_in_body, older_, longPrior, config_.match));

  // Wheels lead near enough, but where they have lost it.
  const double leastExplained = hasWheels_ ? config_.leastExplained : 2.0 * config_.leastExplained;
  if (best.explained < leastExplained) {
    const LikelihoodField field(older_, kSearchResolution, kSearchLevels);
    const double turn = best.explained < config_.leastExplained ? kLostTurn : kSearchTurn;
    if (const auto found = searchPose(points_in_body, field, {best.T_map_body, kSearchReach, turn}, best.explained)) {
      take(matchScan(points_in_body, older_, {.T_map_body = found->T_map_body}, config_.match));
    }
  }
  if (best.explained < config_.leastExplained) best.T_map_body = longPrior.T_map_body;
  return best;
}

/// What the latest scan lies farther from the key than all since. Who stands still or goes to and fro errs no more for
/// it: the map that scans are matched with stays the same.
double LaserOdometry::gained() {
  const double distance = wayOf(geometry::inverse(T_travel_key_) * steps_.back().T_travel_body);
  const double before = std::exchange(farthest_, std::max(farthest_, distance));
  return farthest_ - before;
}

void LaserOdometry::remember(std::span<const Eigen::Vector2d> points_in_body) {
  const auto& T_travel_body = steps_.back().T_travel_body;
  const auto step = geometry::inverse(T_travel_key_) * T_travel_body;
  const bool isKey = older_.points().empty() || std::hypot(step.x, step.y) > config_.keyDistance ||
                     std::abs(step.theta) > config_.keyTurn;
  if (!isKey) return;
  T_travel_key_ = T_travel_body;
  farthest_ = 0.0;
  if (way_ > config_.reach) {
    older_ = std::move(younger_);
    younger_ = map::SurfaceLayer();
    way_ -= 0.5 * config_.reach;
  }
  for (const auto& point : points_in_body) {
    const Eigen::Vector2d place = T_travel_body * point;
    older_.insert(place);
    if (way_ > 0.5 * config_.reach) younger_.insert(place);
  }
}

void LaserOdometry::save(base::ByteWriter& out) const {
  older_.save(out);
  younger_.save(out);
  out << static_cast<std::uint64_t>(steps_.size());
  for (const auto& step : steps_) {
    savePose(out, step.T_travel_body);
    savePose(out, step.T_wheels_body);
  }
  savePose(out, T_wheels_body_);
  savePose(out, T_travel_key_);
  out << hasWheels_ << way_ << farthest_;
}

void LaserOdometry::load(base::ByteReader& in) {
  older_.load(in, older_.version());
  younger_.load(in, younger_.version());
  const auto count = in.read<std::uint64_t>();
  if (count > kSteps)
    throw base::Error("expected at most " + std::to_string(kSteps) + " steps, found " + std::to_string(count));
  steps_.resize(count);
  for (auto& step : steps_) step = {loadPose(in), loadPose(in)};
  T_wheels_body_ = loadPose(in);
  T_travel_key_ = loadPose(in);
  in >> hasWheels_ >> way_ >> farthest_;
}

}  // namespace prodomos::localization

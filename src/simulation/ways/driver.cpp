// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/ways/driver.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace prodomos::simulation {

namespace {

/// A way that begins or bends farther to the side than this is first turned to on the spot, until it lies ahead.
constexpr double kSharp = 50.0 * std::numbers::pi / 180.0;
constexpr double kAhead = 8.0 * std::numbers::pi / 180.0;

/// How far ahead on its way the robot aims, metres.
constexpr double kLeastAim = 0.2;
constexpr double kAimPerSpeed = 0.4;

/// Close enough to where a way or a turn ends, metres and radians.
constexpr double kArrived = 0.02;
constexpr double kExactlyThere = 0.004;
constexpr double kTurned = 0.01;

/// For how long a robot waits for people, and then does not, seconds.
constexpr double kPatience = 6.0;
constexpr double kImpatience = 4.0;

/// On stairs and in lifts, m/s.
constexpr double kCarrySpeed = 0.4;
constexpr double kLiftSpeed = 0.8;

double headingTo(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  return std::atan2(to.y() - from.y(), to.x() - from.x());
}

}  // namespace

/// Where on its way the robot is.
struct Driver::Track {
  const Polyline& way;
  std::vector<double> lengths;  ///< up to each point
  double done = 0.0;            ///< metres

  explicit Track(const Polyline& polyline) : way(polyline), lengths{0.0} {
    for (std::size_t i = 1; i < way.size(); ++i) lengths.push_back(lengths.back() + (way[i] - way[i - 1]).norm());
  }

  double left() const { return lengths.back() - done; }

  /// Beyond its end the way goes straight on.
  Eigen::Vector2d at(double length) const {
    if (length >= lengths.back()) {
      const Eigen::Vector2d last = way.back() - way[way.size() - 2];
      return way.back() + (length - lengths.back()) * last.stableNormalized();
    }
    const auto next = std::ranges::upper_bound(lengths, length) - lengths.begin();
    const auto i = static_cast<std::size_t>(next);
    return way[i - 1] + (way[i] - way[i - 1]) * (length - lengths[i - 1]) / (lengths[i] - lengths[i - 1]);
  }

  /// Goes on to the point of the way that is nearest, of those ahead and near.
  void advance(const Eigen::Vector2d& position) {
    constexpr double kWindow = 0.6;
    constexpr double kStep = 0.02;
    double best = done;
    for (double s = done; s <= std::min(done + kWindow, lengths.back()); s += kStep) {
      if ((at(s) - position).norm() < (at(best) - position).norm()) best = s;
    }
    done = best;
  }

  /// By how much the way turns within the next metres, radians.
  double bend(double ahead) const {
    constexpr double kPiece = 0.15;
    const double first = headingTo(at(done), at(done + kPiece));
    double most = 0.0;
    for (double s = done + kPiece; s + kPiece <= std::min(done + ahead, lengths.back()); s += kPiece) {
      most = std::max(most, std::abs(geometry::normalizeAngle(headingTo(at(s), at(s + kPiece)) - first)));
    }
    return most;
  }
};

Driver::Driver(const TourOptions& limits, const DrivenPose& start, WaitRule mustWait)
    : limits_(limits), mustWait_(std::move(mustWait)), driven_{start} {}

bool Driver::mustTurnFor(const Polyline& way) const {
  const auto aim = Track(way).at(kLeastAim + kAimPerSpeed * speed_);
  return std::abs(geometry::normalizeAngle(headingTo(position(), aim) - now().pose.theta)) > kSharp;
}

void Driver::follow(const Polyline& way, AtEnd atEnd) {
  constexpr double kGoOnBefore = 0.6;  // metres
  constexpr double kBendAhead = 0.8;   // metres
  Track track(way);
  bool turning = false;
  while (!isOver()) {
    track.advance(position());
    if (atEnd == AtEnd::kGoOn && track.left() < kGoOnBefore) return;
    if (track.left() < kArrived) break;
    const auto aim = track.at(track.done + kLeastAim + kAimPerSpeed * speed_);
    const double aside = geometry::normalizeAngle(headingTo(position(), aim) - now().pose.theta);
    turning = std::abs(aside) > (turning ? kAhead : kSharp);
    if (turning) {
      step(0.0, std::copysign(fastestTurnBefore(std::abs(aside)), aside));
      continue;
    }
    if (waits()) {
      step(0.0, 0.0);
      continue;
    }
    const double curvature = 2.0 * std::sin(aside) / std::max((aim - position()).norm(), kLeastAim);
    const double inBend =
        limits_.speed * (1.0 - 0.7 * std::min(1.0, track.bend(kBendAhead) / (std::numbers::pi / 2.0)));
    const double byTurnRate = limits_.turnRate / std::max(std::abs(curvature), 1e-6);
    const double atTheEnd = atEnd == AtEnd::kStop ? fastestBefore(track.left()) : limits_.speed;
    step(std::min({inBend, byTurnRate, atTheEnd}), curvature * speed_);
  }
  stop();
}

void Driver::followExactly(const Polyline& way) {
  for (const auto& point : way) straightTo({point.x(), point.y(), now().z}, limits_.speed);
}

void Driver::turnBy(double angle) {
  stop();
  double left = angle;
  while (!isOver() && (std::abs(left) > kTurned || turnRate_ != 0.0)) {
    const double wanted = std::abs(left) > kTurned ? std::copysign(fastestTurnBefore(std::abs(left)), left) : 0.0;
    const double before = now().pose.theta;
    step(0.0, wanted);
    left -= geometry::normalizeAngle(now().pose.theta - before);
  }
}

void Driver::turnTo(double heading) {
  stop();
  turnBy(geometry::normalizeAngle(heading - now().pose.theta));
}

void Driver::stand(double seconds) {
  stop();
  const double until = now().time + seconds;
  while (!isOver() && now().time < until) step(0.0, 0.0);
}

void Driver::carryAlong(const std::vector<Eigen::Vector3d>& way, int toStorey) {
  stop();
  for (const auto& point : way) {
    straightTo(point, kCarrySpeed);
    driven_.back().storey = kBetweenStoreys;
  }
  driven_.back().storey = toStorey;
}

void Driver::ride(double z, int toStorey) {
  stand(kLiftDoors);
  driven_.back().storey = kBetweenStoreys;
  const double from = now().z;
  const double begin = now().time;
  const double seconds = std::max(3.0, 1.5 * std::abs(z - from) / kLiftSpeed);
  while (!isOver() && now().time < begin + seconds) {
    step(0.0, 0.0);
    // It starts and stops gently.
    const double share = std::min(1.0, (now().time - begin) / seconds);
    driven_.back().z = from + (z - from) * share * share * (3.0 - 2.0 * share);
  }
  if (isOver()) return;
  driven_.back().storey = toStorey;
  stand(kLiftDoors);
}

/// Towards these speeds, as far as the accelerations allow; one tick.
void Driver::step(double speed, double turnRate) {
  const double mostFaster = limits_.acceleration * kTick;
  const double mostTurn = limits_.turnAcceleration * kTick;
  speed_ += std::clamp(speed - speed_, -mostFaster, mostFaster);
  turnRate_ += std::clamp(std::clamp(turnRate, -limits_.turnRate, limits_.turnRate) - turnRate_, -mostTurn, mostTurn);
  DrivenPose next = now();
  next.time = static_cast<double>(driven_.size()) * kTick;
  const double heading = next.pose.theta + turnRate_ * kTick / 2.0;
  next.pose.x += speed_ * kTick * std::cos(heading);
  next.pose.y += speed_ * kTick * std::sin(heading);
  next.pose.theta = geometry::normalizeAngle(next.pose.theta + turnRate_ * kTick);
  driven_.push_back(next);
}

void Driver::stop() {
  while (!isOver() && (speed_ != 0.0 || turnRate_ != 0.0)) step(0.0, 0.0);
}

void Driver::straightTo(const Eigen::Vector3d& goal, double speed) {
  const Eigen::Vector2d from = position();
  const double from_z = now().z;
  const double length = (goal.head<2>() - from).norm();
  if (length < kArrived) return;
  turnTo(headingTo(from, goal.head<2>()));
  while (!isOver()) {
    const double done = (position() - from).norm();
    driven_.back().z = std::lerp(from_z, goal.z(), std::min(1.0, done / length));
    const double left = length - done;
    if (left < kExactlyThere) break;
    // Small errors of heading are steered away.
    const double aside = geometry::normalizeAngle(headingTo(position(), goal.head<2>()) - now().pose.theta);
    step(waits() ? 0.0 : std::min(speed, fastestBefore(left)), left > kLeastAim ? aside : 0.0);
  }
  stop();
  if (!isOver()) driven_.back().z = goal.z();
}

bool Driver::waits() {
  if (waited_ < 0.0) {
    waited_ = std::min(0.0, waited_ + kTick);
    return false;
  }
  if (!mustWait_(now())) {
    waited_ = 0.0;
    return false;
  }
  waited_ += kTick;
  if (waited_ > kPatience) waited_ = -kImpatience;
  return true;
}

// So that it can still stop in time; braking is a bit gentler than it might be, as ticks are not infinitely short.

double Driver::fastestBefore(double distance) const {
  constexpr double kCrawl = 0.03;
  return std::max(kCrawl, std::sqrt(1.6 * limits_.acceleration * distance));
}

double Driver::fastestTurnBefore(double angle) const {
  return std::min(limits_.turnRate, std::sqrt(1.6 * limits_.turnAcceleration * angle));
}

}  // namespace prodomos::simulation

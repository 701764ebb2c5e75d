// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/people/gait.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace prodomos::simulation {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kDegree = std::numbers::pi / 180.0;

/// Seconds to either side over which the way is averaged: a turn takes twice that.
constexpr double kSmoothing = 0.3;
/// Length of a step times its duration, m·s, of a person of kMeanHeight: the same at all speeds that one chooses
/// (Sekiya and Nagasaki 1998: 0.0064 m per step a minute).
constexpr double kWalkRatio = 0.384;
constexpr double kMeanHeight = 1.72;
/// What can be turned in passing; beyond it, each step turns as much.
constexpr double kTurnPerStep = 90.0 * kDegree;

/// A step's share before its foot leaves the floor, and after it is down again.
constexpr double kDoubleSupport = 0.1;
/// A foot's n-th step sets it down for the steps n + 0.9 to n + 2.1. It stands a little behind the body's way, since
/// its ankle goes ahead while the heel rises.
constexpr double kMiddleOfStance = 1.40;
constexpr double kHeelStrike = 16.0 * kDegree;
constexpr double kToeOff = 50.0 * kDegree;
constexpr double kToesOut = 7.0 * kDegree;
/// Lengths of a person of 1 m: from the middle to the ankle, from the ankle back to the heel and ahead to the ball.
constexpr double kHalfTrack = 0.042;
constexpr double kHeel = 0.036;
constexpr double kBall = 0.072;
/// The ankle stands a little behind the body's middle.
constexpr double kBehind = 0.008;
/// A stride (two steps) of this length has the full play of the foot.
constexpr double kFullStride = 0.75;

constexpr double kStance = 1.0 + 2.0 * kDoubleSupport;  // of a step's duration

/// Which foot takes that step.
Side sideOf(int step) {
  return step % 2 == 0 ? kRight : kLeft;
}

double smoothStep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

double distance(const geometry::Pose2& a, const geometry::Pose2& b) {
  return std::hypot(b.x - a.x, b.y - a.y);
}

geometry::Pose2 between(const geometry::Pose2& a, const geometry::Pose2& b, double share) {
  return {std::lerp(a.x, b.x, share), std::lerp(a.y, b.y, share), std::lerp(a.theta, b.theta, share)};
}

/// Toes up positive, radians, of a foot on the floor; `progress` from its heel's strike (0) to its toes' leaving (1).
/// `before` and `after` are the shares of a full stride that bring it here and away.
double stancePitch(double progress, double before, double after) {
  return kHeelStrike * before * (1.0 - smoothStep(0.0, 0.08, progress)) -
         kToeOff * after * smoothStep(0.45, 1.0, progress);
}

double swingPitch(double progress, double share) {
  return share * (kHeelStrike * smoothStep(0.5, 1.0, progress) - kToeOff * (1.0 - smoothStep(0.05, 0.75, progress)));
}

/// A pitched foot stands on its heel or on its ball.
Foot footOn(const geometry::Pose2& print, Side side, double pitch, double lift, double height) {
  const geometry::Pose2 offset{-kBehind * height, signOf(side) * kHalfTrack * height, signOf(side) * kToesOut};
  const Eigen::Vector3d pivot((pitch > 0.0 ? -kHeel : kBall) * height, 0.0, 0.0);
  Foot foot;
  foot.T_floor_sole = geometry::toPose3(print * offset, lift);
  foot.T_floor_sole.translate(pivot);
  foot.T_floor_sole.rotate(Eigen::AngleAxisd(-pitch, Eigen::Vector3d::UnitY()));
  foot.T_floor_sole.translate(Eigen::Vector3d(-pivot));
  foot.toeBend = std::max(-pitch, 0.0);
  return foot;
}

}  // namespace

Gait::Progress Gait::Leg::at(double time) const {
  return moves() ? Progress(first + (last - first) * ((time - begin) / (end - begin))) : first;
}

Gait::Gait(const Person& person) : height_(person.height) {
  addLegs(person);
  joinWalks();
}

void Gait::addLegs(const Person& person) {
  Leg rest{.begin = -kInfinity, .end = person.way.front().time};
  rest.first << person.way.front().position, person.heading, 0.0, 0.0;
  rest.last = rest.first;
  legs_.push_back(rest);
  for (std::size_t i = 0; i + 1 < person.way.size(); ++i) {
    const auto& from = person.way[i];
    const auto& to = person.way[i + 1];
    const Eigen::Vector2d motion = to.position - from.position;
    Leg leg{.begin = from.time, .end = to.time};
    const double before = legs_.back().last[2];
    double heading = before;
    double stepLength = 0.0;
    if (!motion.isZero(0.0)) {
      const double speed = motion.norm() / (to.time - from.time);
      const double turn = geometry::normalizeAngle(std::atan2(motion.y(), motion.x()) - before);
      heading += turn;
      stepLength = std::sqrt(kWalkRatio * speed) * height_ / kMeanHeight;
      leg.turningSteps = std::max(std::abs(turn) / kTurnPerStep - 1.0, 0.0);
      leg.steps = leg.turningSteps + motion.norm() / stepLength;
    }
    leg.first << from.position, heading, 0.0, stepLength;
    leg.last << to.position, heading, 0.0, stepLength;
    legs_.push_back(leg);
  }
  rest = {.begin = person.way.back().time, .end = kInfinity};
  rest.first << person.way.back().position, legs_.back().last[2], 0.0, 0.0;
  rest.last = rest.first;
  legs_.push_back(rest);
}

/// One stands between two walks where the average comes to rest.
void Gait::joinWalks() {
  for (std::size_t first = 0; first < legs_.size();) {
    if (!legs_[first].moves()) {
      const double steps = walks_.empty() ? 0.0 : walks_.back().endStep;
      legs_[first].first[3] = legs_[first].last[3] = steps;
      ++first;
      continue;
    }
    std::size_t end = first + 1;
    for (std::size_t next = end; legs_[next].begin - legs_[end - 1].end < 2.0 * kSmoothing; ++next) {
      if (legs_[next].moves()) end = next + 1;
      if (next + 1 == legs_.size()) break;
    }
    numberSteps(first, end);
    first = end;
  }
}

/// A walk takes a whole number of steps, and at least one with each foot.
void Gait::numberSteps(std::size_t firstLeg, std::size_t endLeg) {
  const auto begin = legs_.begin() + static_cast<std::ptrdiff_t>(firstLeg);
  const auto end = legs_.begin() + static_cast<std::ptrdiff_t>(endLeg);
  // The first and the last step are half ones: they begin and end beside the other foot.
  double wanted = 1.0;
  for (auto leg = begin; leg != end; ++leg) wanted += leg->steps;
  Walk walk{.begin = begin->begin - kSmoothing, .end = std::prev(end)->end + kSmoothing};
  walk.firstStep = walks_.empty() ? 0 : walks_.back().endStep;
  walk.endStep = walk.firstStep + std::max(2, static_cast<int>(std::lround(wanted)));
  const double scale = (walk.endStep - walk.firstStep) / wanted;
  double steps = walk.firstStep + 0.5 * scale;
  for (auto leg = begin; leg != end; ++leg) {
    leg->first[3] = steps + leg->turningSteps * scale;
    steps += leg->steps * scale;
    leg->last[3] = steps;
  }
  walks_.push_back(walk);
}

Gait::Progress Gait::rawAt(double time) const {
  return std::ranges::upper_bound(legs_, time, {}, &Leg::end)->at(time);
}

Gait::Progress Gait::smoothedAt(double time) const {
  const double from = time - kSmoothing;
  const double to = time + kSmoothing;
  Progress sum = Progress::Zero();
  for (auto leg = std::ranges::upper_bound(legs_, from, {}, &Leg::end); leg != legs_.end() && leg->begin < to; ++leg) {
    const double begin = std::max(leg->begin, from);
    const double end = std::min(leg->end, to);
    sum += (end - begin) / 2.0 * (leg->at(begin) + leg->at(end));
  }
  return sum / (to - from);
}

geometry::Pose2 Gait::poseAt(double time) const {
  const Progress progress = smoothedAt(time);
  return {progress[0], progress[1], progress[2]};
}

double Gait::timeOfStep(const Walk& walk, double steps) const {
  double early = walk.begin;
  double late = walk.end;
  for (int i = 0; i < 40; ++i) {
    const double middle = std::midpoint(early, late);
    (smoothedAt(middle)[3] < steps ? early : late) = middle;
  }
  return late;
}

/// Where the body is in the middle of the time that the foot of that step stands there.
geometry::Pose2 Gait::footprint(int step) const {
  const auto walk = std::ranges::upper_bound(walks_, step, {}, &Walk::endStep);
  if (step < 0 || walk == walks_.end()) {
    const Progress& rest = step < 0 ? legs_.front().first : legs_.back().last;
    return {rest[0], rest[1], rest[2]};
  }
  if (step + 2 >= walk->endStep) return poseAt(walk->end);
  return poseAt(timeOfStep(*walk, step + kMiddleOfStance));
}

bool Gait::beginsWalk(int step) const {
  return std::ranges::binary_search(walks_, step, {}, &Walk::firstStep);
}

/// Of the two steps that end with it, of a full stride.
double Gait::strideShare(int step) const {
  return std::min(distance(footprint(step - 2), footprint(step)) / (kFullStride * height_), 1.0);
}

/// The foot that carries while the other one takes that step.
Foot Gait::carryingFoot(int step, double phase) const {
  // It rests where the next step, its own, begins another walk.
  const double after = beginsWalk(step + 1) ? 0.0 : strideShare(step + 1);
  const double pitch = stancePitch((phase + kDoubleSupport) / kStance, strideShare(step - 1), after);
  return footOn(footprint(step - 1), sideOf(step - 1), pitch, 0.0, height_);
}

Foot Gait::steppingFoot(int step, double phase) const {
  const geometry::Pose2 from = footprint(step - 2);
  const geometry::Pose2 to = footprint(step);
  const double share = strideShare(step);
  const double swing = std::clamp((phase - kDoubleSupport) / (1.0 - 2.0 * kDoubleSupport), 0.0, 1.0);
  double pitch = swingPitch(swing, share);
  if (swing == 0.0 && beginsWalk(step)) {
    // Out of rest the heel rises within the double support.
    pitch = -kToeOff * share * smoothStep(0.0, kDoubleSupport, phase);
  } else if (swing == 0.0) {
    pitch = stancePitch((phase + 1.0 + kDoubleSupport) / kStance, 0.0, share);
  } else if (swing == 1.0) {
    pitch = stancePitch((phase - 1.0 + kDoubleSupport) / kStance, share, 0.0);
  }
  const double way = std::lerp(swing, smoothStep(0.0, 1.0, swing), 0.7);
  const double sine = std::sin(std::numbers::pi * swing);
  const double lift = from == to ? 0.0 : (0.02 + 0.015 * share) * height_ * sine * sine;
  return footOn(between(from, to, way), sideOf(step), pitch, lift, height_);
}

Stride Gait::at(double time) const {
  const Progress progress = smoothedAt(time);
  Stride stride;
  stride.pose = {progress[0], progress[1], progress[2]};
  stride.velocity =
      (rawAt(time + kSmoothing) - rawAt(time - kSmoothing)).head<2>() / ((time + kSmoothing) - (time - kSmoothing));
  stride.steps = progress[3];
  stride.stepLength = progress[4];
  const int step = static_cast<int>(std::floor(stride.steps));
  stride.feet[sideOf(step)] = steppingFoot(step, stride.steps - step);
  stride.feet[sideOf(step - 1)] = carryingFoot(step, stride.steps - step);
  return stride;
}

}  // namespace prodomos::simulation

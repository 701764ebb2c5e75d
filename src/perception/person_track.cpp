// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/person_track.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>

namespace prodomos::perception {

namespace {

using Eigen::Matrix2d;
using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

constexpr double kAcceleration = 0.4;     ///< m²/s³, spectral density of a walker's accelerations
constexpr double kWalkingSpeed = 1.0;     ///< m/s, of someone of whom one knows nothing else
constexpr double kLongestStride = 1.0;    ///< seconds that somebody unseen is believed to go on as before
constexpr double kTurnRate = 3.0;         ///< rad/s, of a torso
constexpr double kLeastSpeed = 0.35;      ///< m/s, of who walks ahead rather than shifts
constexpr double kMostSureOfFront = 3.0;  ///< log-odds
/// People walk ahead; what they look like errs alike in one image after the other.
constexpr double kSureOfWalk = 1.5;
constexpr double kShareOfLook = 0.5;
constexpr base::Duration kLongestGap = std::chrono::milliseconds(1000);
constexpr int kLeastSightings = 3;
constexpr double kMostDoubt = 0.2;                                    ///< of who is told
constexpr double kLeastWay = 1.0;                                     ///< metres, of who must move,
constexpr base::Duration kWayTime = std::chrono::milliseconds(2500);  ///< in no more than that
constexpr double kLateralReach = 3.0;                                 ///< metres that sides are looked at
constexpr double kBodyRadius = 0.35;                                  ///< metres; cells nearer are the person's own
constexpr double kSideDifference = 0.1;                               ///< metres, between the clearances of two sides

bool isKnown(const Appearance& appearance) {
  return std::ranges::any_of(appearance, [](float share) { return share > 0.0F; });
}

/// Distance along a direction to the first occupied cell.
double clearance(const map::OccupancyGrid& grid, const Vector2d& from, const Vector2d& direction) {
  for (double d = kBodyRadius; d < kLateralReach; d += 0.5 * grid.resolution()) {
    if (grid.state(grid.cellAt(from + d * direction)) == map::CellState::kOccupied) return d;
  }
  return kLateralReach;
}

/// {"joints": [[x, y, z] or null, …]}, millimetres are enough; {} where none was seen.
std::string attributesOf(const FollowedState& state) {
  const auto& joints = state.joints_in_submap;
  if (std::ranges::none_of(joints, [](const auto& joint) { return joint.has_value(); })) return "{}";
  std::string text;
  for (const auto& joint : joints) {
    std::array<char, 96> item{"null"};
    if (joint) std::snprintf(item.data(), item.size(), "[%.3f, %.3f, %.3f]", joint->x(), joint->y(), joint->z());
    text += (text.empty() ? "" : ", ") + std::string(item.data());
  }
  return "{\"joints\": [" + text + "]}";
}

geometry::Pose3 poseOf(const FollowedState& state) {
  return geometry::toPose3({state.position_in_submap.x(), state.position_in_submap.y(), state.heading},
                           state.position_in_submap.z());
}

FollowedState between(const FollowedState& from, const FollowedState& to, base::Time time) {
  const double share = base::seconds(time - from.time) / base::seconds(to.time - from.time);
  FollowedState state = from;
  state.time = time;
  state.position_in_submap += share * (to.position_in_submap - from.position_in_submap);
  state.velocity += share * (to.velocity - from.velocity);
  state.heading = geometry::normalizeAngle(from.heading + share * geometry::normalizeAngle(to.heading - from.heading));
  state.sureOfFront = std::min(from.sureOfFront, to.sureOfFront);
  state.joints_in_submap.fill(std::nullopt);
  return state;
}

}  // namespace

PersonTrack::PersonTrack(base::SubMapId submap, const PersonSighting& sighting)
    : floor_z_(sighting.position_in_submap.z()),
      time_(sighting.time),
      mustMove_(sighting.mustMove),
      start_(sighting.position_in_submap.head<2>()),
      startTime_(sighting.time),
      firstSeen_(sighting.time) {
  state_.head<2>() = start_;
  covariance_.setZero();
  covariance_.diagonal().head<2>().setConstant(sighting.positionSigma * sighting.positionSigma);
  covariance_.diagonal().tail<2>().setConstant(kWalkingSpeed * kWalkingSpeed);
  appearance_ = sighting.appearance;
  updateHeading(sighting);
  sightings_ = 1;
  doubt_ = 1.0 - 0.5 * sighting.score;
  last_ = stateNow(submap, sighting);
  pending_.push_back(last_);
  hasChanged = true;
}

double PersonTrack::metresFrom(const PersonSighting& sighting) const {
  return (sighting.position_in_submap.head<2>() - position()).norm();
}

double PersonTrack::distance(const PersonSighting& sighting) const {
  const Matrix2d spread =
      covariance_.topLeftCorner<2, 2>() + sighting.positionSigma * sighting.positionSigma * Matrix2d::Identity();
  const Vector2d off = sighting.position_in_submap.head<2>() - position();
  return off.dot(spread.inverse() * off);
}

std::optional<double> PersonTrack::likeness(const Appearance& appearance) const {
  if (!isKnown(appearance) || !isKnown(appearance_)) return std::nullopt;
  double common = 0.0;  // Bhattacharyya's coefficient
  for (std::size_t i = 0; i < appearance.size(); ++i) {
    common += std::sqrt(static_cast<double>(appearance[i]) * static_cast<double>(appearance_[i]));
  }
  return common;
}

void PersonTrack::predict(base::Time time) {
  const double dt = base::seconds(time - time_);
  if (dt <= 0.0) return;
  // Who was not seen for long stands somewhere, rather than having walked through walls.
  const double unseen = base::seconds(time - lastSeen());
  const double stride = std::clamp(kLongestStride - (unseen - dt), 0.0, dt);
  Matrix4d step = Matrix4d::Identity();
  step.topRightCorner<2, 2>().diagonal().setConstant(stride);
  if (unseen > kLongestStride) step.bottomRightCorner<2, 2>().setZero();
  Matrix4d noise = Matrix4d::Zero();
  noise.topLeftCorner<2, 2>().diagonal().setConstant(kAcceleration * dt * dt * dt / 3.0);
  noise.topRightCorner<2, 2>().diagonal().setConstant(kAcceleration * dt * dt / 2.0);
  noise.bottomLeftCorner<2, 2>() = noise.topRightCorner<2, 2>();
  noise.bottomRightCorner<2, 2>().diagonal().setConstant(kAcceleration * dt);
  state_ = step * state_;
  covariance_ = step * covariance_ * step.transpose() + noise;
  headingVariance_ = std::min(headingVariance_ + kTurnRate * kTurnRate * dt * dt, kPi * kPi);
  time_ = time;
}

void PersonTrack::update(base::SubMapId submap, const PersonSighting& sighting) {
  updatePosition(sighting);
  updateHeading(sighting);
  if (isKnown(sighting.appearance)) {
    const float share = isKnown(appearance_) ? 0.1F : 1.0F;
    for (std::size_t i = 0; i < appearance_.size(); ++i) {
      appearance_[i] += share * (sighting.appearance[i] - appearance_[i]);
    }
  }
  ++sightings_;
  doubt_ *= 1.0 - 0.5 * sighting.score;
  if (mustMove_) watchForMotion(sighting);
  const FollowedState now = stateNow(submap, sighting);
  fillGap(now);
  last_ = now;
  pending_.push_back(now);
  hasChanged = true;
}

/// Clutter in which now this pair is seen and now that one creeps; people walk.
void PersonTrack::watchForMotion(const PersonSighting& sighting) {
  mustMove_ = sighting.mustMove && (position() - start_).norm() < kLeastWay;
  if (sighting.time - startTime_ <= kWayTime) return;
  start_ = position();
  startTime_ = sighting.time;
}

void PersonTrack::updatePosition(const PersonSighting& sighting) {
  floor_z_ = sighting.position_in_submap.z();
  const double variance = sighting.positionSigma * sighting.positionSigma;
  const Matrix2d spread = covariance_.topLeftCorner<2, 2>() + variance * Matrix2d::Identity();
  const Eigen::Matrix<double, 4, 2> gain = covariance_.leftCols<2>() * spread.inverse();
  state_ += gain * (sighting.position_in_submap.head<2>() - position());
  Matrix4d rest = Matrix4d::Identity();
  rest.leftCols<2>() -= gain;
  // Joseph's form stays symmetric.
  covariance_ = rest * covariance_ * rest.transpose() + variance * gain * gain.transpose();
}

void PersonTrack::updateHeading(const PersonSighting& sighting) {
  if (sighting.heading) mergeHeading(*sighting.heading, sighting.headingSigma, kShareOfLook * sighting.facing);
  // Who walks looks ahead.
  const Vector2d velocity = state_.tail<2>();
  const double speed = velocity.norm();
  const double sigma = std::sqrt(0.5 * covariance_.diagonal().tail<2>().sum());
  if (speed < kLeastSpeed || speed < 1.5 * sigma) return;
  mergeHeading(std::atan2(velocity.y(), velocity.x()), std::hypot(0.15, sigma / speed), kSureOfWalk);
}

/// The axis that is nearer moves the filter; which end of it is the front is counted apart.
void PersonTrack::mergeHeading(double heading, double sigma, double facing) {
  if (!hasHeading_) {
    hasHeading_ = true;
    heading_ = heading;
    headingVariance_ = sigma * sigma;
    front_ = facing;
    for (FollowedState& state : pending_) state.heading = heading;
    return;
  }
  double turn = geometry::normalizeAngle(heading - heading_);
  const bool agrees = std::abs(turn) <= kPi / 2.0;
  if (!agrees) turn = geometry::normalizeAngle(turn + kPi);
  front_ = std::clamp(front_ + (agrees ? facing : -facing), -kMostSureOfFront, kMostSureOfFront);
  const double gain = headingVariance_ / (headingVariance_ + sigma * sigma);
  heading_ = geometry::normalizeAngle(heading_ + gain * turn);
  headingVariance_ *= 1.0 - gain;
  if (front_ < 0.0) turnRound();
}

/// Front and back were mistaken: in what is not written yet, too, as far back as it was doubtful.
void PersonTrack::turnRound() {
  heading_ = geometry::normalizeAngle(heading_ + kPi);
  front_ = -front_;
  for (auto state = pending_.rbegin(); state != pending_.rend() && state->sureOfFront < kMostSureOfFront - 0.5;
       ++state) {
    state->heading = geometry::normalizeAngle(state->heading + kPi);
  }
}

void PersonTrack::miss(base::Time time) {
  if (time - lastSeen() <= kLongestGap) missed_.push_back(time);
}

/// Who was seen before and after, and not long between, was there.
void PersonTrack::fillGap(const FollowedState& now) {
  if (last_.submap == now.submap && now.time - last_.time <= kLongestGap) {
    for (const auto time : missed_) pending_.push_back(between(last_, now, time));
  }
  missed_.clear();
}

FollowedState PersonTrack::stateNow(base::SubMapId submap, const PersonSighting& sighting) const {
  return {.time = sighting.time,
          .submap = submap,
          .position_in_submap = {state_.x(), state_.y(), floor_z_},
          .heading = heading_,
          .sureOfFront = front_,
          .velocity = state_.tail<2>(),
          .joints_in_submap = sighting.joints_in_submap};
}

void PersonTrack::lookAround(const map::OccupancyGrid& grid) {
  const Vector2d left(-std::sin(heading_), std::cos(heading_));
  const double toLeft = clearance(grid, position(), left);
  const double toRight = clearance(grid, position(), -left);
  if (std::abs(toLeft - toRight) < kSideDifference) return;
  // The last few seconds count.
  sides_ = 0.9 * sides_ + (toRight < toLeft ? 1.0 : -1.0);
}

void PersonTrack::enter(const geometry::Pose3& T_submap_before) {
  const geometry::Pose2 moved = geometry::toPose2(T_submap_before);
  const Eigen::Rotation2Dd turn(moved.theta);
  Matrix4d turns = Matrix4d::Zero();
  turns.topLeftCorner<2, 2>() = turn.toRotationMatrix();
  turns.bottomRightCorner<2, 2>() = turn.toRotationMatrix();
  state_ = turns * state_;
  state_.head<2>() += Vector2d(moved.x, moved.y);
  covariance_ = turns * covariance_ * turns.transpose();
  start_ = moved * start_;
  floor_z_ += T_submap_before.translation().z();
  heading_ = geometry::normalizeAngle(heading_ + moved.theta);
}

void PersonTrack::takeOver(PersonTrack&& other) {
  track = other.track;
  entityId = other.entityId;
  firstSeen_ = other.firstSeen_;
  sightings_ += other.sightings_;
  pending_.insert(pending_.begin(), other.pending_.begin(), other.pending_.end());
}

bool PersonTrack::isConvincing() const {
  if (mustMove_) return false;
  return sightings_ >= kLeastSightings && doubt_ < kMostDoubt;
}

map::Entity PersonTrack::entity() const {
  map::Entity entity{.id = entityId,
                     .submap = last_.submap,
                     .T_submap_entity = poseOf(last_),
                     .confidence = 1.0 - doubt_,
                     .observations = sightings_,
                     .firstSeen = firstSeen_,
                     .lastSeen = lastSeen(),
                     .attributes = map::Human{}};
  entity.covariance.topLeftCorner<2, 2>() = covariance_.topLeftCorner<2, 2>();
  entity.covariance(5, 5) = hasHeading_ ? headingVariance_ : kPi * kPi;
  auto& human = std::get<map::Human>(entity.attributes);
  human.velocity << last_.velocity, 0.0;
  human.dominantSide = sides_ == 0.0 ? 0 : (sides_ > 0.0 ? 1 : -1);
  return entity;
}

std::vector<map::TrackState> PersonTrack::takeStates() {
  std::vector<map::TrackState> states;
  for (const FollowedState& state : std::exchange(pending_, {})) {
    states.push_back({.time = state.time,
                      .submap = state.submap,
                      .T_submap_thing = poseOf(state),
                      .velocity_in_submap = Vector3d(state.velocity.x(), state.velocity.y(), 0.0),
                      .attributes = attributesOf(state)});
  }
  return states;
}

}  // namespace prodomos::perception

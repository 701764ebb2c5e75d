// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/prediction/walk.hpp"

#include "prodomos/map/personal_space.hpp"
#include "prodomos/prediction/extrapolation.hpp"

#include "prediction/free_floor.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace prodomos::prediction {

namespace {

using geometry::Pose2;

constexpr base::Duration kPaceOver = std::chrono::seconds(1);
constexpr double kFarthest = 8.0;       // metres from a walk's beginning: with what is extrapolated, it is looked at
constexpr double kStride = 0.1;         // metres between places of a way
constexpr double kFastest = 10.0;       // m/s; nobody runs faster, so it is a mistake
constexpr double kLeastClearWay = 0.3;  // metres, the walk's x-axis is that of its pose where it is shorter

Eigen::Vector2d positionOf(const Walk::State& state) {
  return {state.T_submap_person.x, state.T_submap_person.y};
}

bool isFinite(const Walk::State& state) {
  return positionOf(state).allFinite() && std::isfinite(state.T_submap_person.theta) &&
         state.velocity_in_submap.allFinite();
}

/// Mean velocity between two states; as told where they are the same one.
Eigen::Vector2d paceBetween(const Walk::State& from, const Walk::State& to) {
  const double duration = base::seconds(to.time - from.time);
  if (duration <= 0.0) return to.velocity_in_submap;
  return (positionOf(to) - positionOf(from)) / duration;
}

Walk::State stateOf(const map::TrackState& state) {
  const Eigen::Vector3d velocity = state.velocity_in_submap.value_or(Eigen::Vector3d::Zero());
  return {state.time, geometry::toPose2(state.T_submap_thing), velocity.head<2>()};
}

/// Claims along a person's way, place by place.
class Way {
 public:
  Way(const Walk& walk, const Surroundings& around, const ExtrapolationConfig& config)
      : walk_(walk),
        T_here_submap_(geometry::inverse(geometry::toPose2(T_submap_here(walk)))),
        around_(around),
        config_(config),
        claims_(Surroundings::kBox, 0.0F) {}

  /// Where it was seen.
  void followWalk() {
    const Walk::State* last = nullptr;
    for (const auto& state : walk_.states) {
      if (last != nullptr && (positionOf(state) - positionOf(*last)).norm() < kStride) continue;
      claimAbout(T_here_submap_ * state.T_submap_person);
      last = &state;
    }
  }

  /// a_h(t + k) = a_h(t) + k ȧ_h(t), k up to the horizon, as far as no known wall is in the way.
  void extrapolate(const Walk::State& from, const Eigen::Vector2d& velocity_in_submap) {
    const double speed = velocity_in_submap.norm();
    if (speed < config_.leastSpeed) return;
    const Eigen::Vector2d stride = Eigen::Rotation2Dd(T_here_submap_.theta) * velocity_in_submap * (kStride / speed);
    Pose2 place = T_here_submap_ * from.T_submap_person;
    for (int i = 0; i * kStride < speed * config_.horizon; ++i) {
      const Pose2 next{place.x + stride.x(), place.y + stride.y(), place.theta};
      if (!isWayFree(around_, {place.x, place.y}, {next.x, next.y})) return;
      claimAbout(next);
      place = next;
    }
  }

  const Claims& claims() const { return claims_; }

 private:
  void claimAbout(const Pose2& T_here_person) {
    addClaimsAbout({T_here_person.x, T_here_person.y}, around_,
                   map::personalSpace(T_here_person, walk_.dominantSide, config_.personSigma, config_.personSkew),
                   claims_);  // 002 eq. (5)
  }

  const Walk& walk_;
  Pose2 T_here_submap_;
  const Surroundings& around_;
  const ExtrapolationConfig& config_;
  Claims claims_;
};

}  // namespace

std::vector<Walk> walksOf(const map::Track& track, base::SubMapId submap, int dominantSide, bool isOver) {
  std::vector<Walk> walks;
  const map::TrackState* before = nullptr;
  bool goesOn = false;  // the state before is the last of walks.back()
  for (const auto& state : track.states) {
    const bool isBroken = before == nullptr || state.time - before->time >= kBreak;
    if (isBroken && goesOn) walks.back().left = true;
    if (state.submap != submap) {
      goesOn = false;
    } else {
      const auto here = stateOf(state);
      if (!goesOn || isBroken || (positionOf(here) - positionOf(walks.back().states.front())).norm() > kFarthest) {
        walks.push_back({.states = {}, .dominantSide = dominantSide, .entered = isBroken});
      }
      walks.back().states.push_back(here);
      goesOn = true;
    }
    before = &state;
  }
  if (goesOn && isOver) walks.back().left = true;
  return walks;
}

Eigen::Vector2d paceAtBeginning(const Walk& walk) {
  const auto& first = walk.states.front();
  const auto later =
      std::ranges::find_if(walk.states, [&first](const auto& state) { return state.time - first.time >= kPaceOver; });
  return paceBetween(first, later == walk.states.end() ? walk.states.back() : *later);
}

Eigen::Vector2d paceAtEnd(const Walk& walk) {
  const auto& last = walk.states.back();
  const auto earlier = std::find_if(walk.states.rbegin(), walk.states.rend(),
                                    [&last](const auto& state) { return last.time - state.time >= kPaceOver; });
  return paceBetween(earlier == walk.states.rend() ? walk.states.front() : *earlier, last);
}

geometry::Pose3 T_submap_here(const Walk& walk) {
  if (walk.states.empty() || !std::ranges::all_of(walk.states, isFinite)) return geometry::Pose3::Identity();
  const auto& first = walk.states.front();
  const Eigen::Vector2d way = positionOf(walk.states.back()) - positionOf(first);
  const double heading = way.norm() < kLeastClearWay ? first.T_submap_person.theta : std::atan2(way.y(), way.x());
  return geometry::toPose3({first.T_submap_person.x, first.T_submap_person.y, heading});
}

std::variant<ConditionalFloor, Refusal> extrapolate(const Walk& walk, const Surroundings& around,
                                                    const ExtrapolationConfig& config) {
  if (walk.states.empty()) return Refusal{"a walk without a state"};
  if (!std::ranges::all_of(walk.states, isFinite)) return Refusal{"a person whose pose or velocity is no number"};
  const Eigen::Vector2d paceIn = paceAtBeginning(walk);
  const Eigen::Vector2d paceOut = paceAtEnd(walk);
  if (std::max(paceIn.norm(), paceOut.norm()) > kFastest) return Refusal{"a person faster than anyone runs"};
  if (positionOf(walk.states.front()).norm() > config.range && !around.isAnythingKnown()) {
    return Refusal{"an entity outside of its sub-map"};
  }
  Way way(walk, around, config);
  way.followWalk();
  if (walk.entered) way.extrapolate(walk.states.front(), -paceIn);
  if (walk.left) way.extrapolate(walk.states.back(), paceOut);
  ConditionalFloor floor{areasOf(way.claims(), config.leastArea)};
  for (auto& strip : floor.strips) {
    for (auto& area : strip) area.outline_in_node = geometry::transformed(T_submap_here(walk), area.outline_in_node);
  }
  return floor;
}

}  // namespace prodomos::prediction

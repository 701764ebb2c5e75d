// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/detections.hpp"

#include "prodomos/geometry/assignment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prodomos::evaluation {

namespace {

constexpr base::Duration kSameImage = std::chrono::milliseconds(20);

double distance(const geometry::Pose2& a, const geometry::Pose2& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

/// Of two directions, 0 … π.
double turnBetween(double a, double b) {
  return std::abs(geometry::normalizeAngle(a - b));
}

/// Of two lines, 0 … π/2.
double turnOfLines(double a, double b) {
  const double turn = turnBetween(a, b);
  return std::min(turn, std::numbers::pi - turn);
}

/// Gates are ellipsoids' axes: what lies at one of them costs 1.
double costWithin(double metres, double greatestMetres, double radians, double greatestRadians) {
  if (!(metres <= greatestMetres && radians <= greatestRadians)) return geometry::kForbidden;
  return metres / greatestMetres + radians / greatestRadians;
}

double doorCost(const ClaimedDoor& claim, const TrueDoor& door, const MatchGates& gates) {
  if (claim.storey != door.storey) return geometry::kForbidden;
  const auto actual = leafPoseOf(door);
  return costWithin(distance(claim.T_world_door, actual), gates.doorDistance,
                    turnOfLines(claim.T_world_door.theta, actual.theta), gates.angle);
}

Eigen::Vector2d middleOf(const TrueStaircase& stairs) {
  return (stairs.foot + stairs.head).head<2>() / 2.0;
}

double stairsCost(const ClaimedStaircase& claim, const TrueStaircase& stairs, const MatchGates& gates) {
  if (claim.storey != stairs.storeys[0] && claim.storey != stairs.storeys[1]) return geometry::kForbidden;
  const Eigen::Vector2d middle(claim.T_world_stairs.x, claim.T_world_stairs.y);
  double metres = (middle - middleOf(stairs)).norm();
  if (claim.foot) metres = std::min(metres, (*claim.foot - stairs.foot.head<2>()).norm());
  return costWithin(metres, gates.stairsDistance, turnBetween(claim.T_world_stairs.theta, stairs.direction),
                    gates.angle);
}

/// Claims and true things that may be paired, and what a pair costs.
template <typename Claim, typename Thing, typename Cost>
void assignPairs(const std::vector<Claim>& claims, const std::vector<Thing>& things, const Cost& cost,
                 std::vector<ClaimMatch>& matches) {
  Eigen::MatrixXd costs(claims.size(), things.size());
  for (std::size_t i = 0; i < claims.size(); ++i) {
    for (std::size_t j = 0; j < things.size(); ++j) {
      costs(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = cost(claims[i], things[j]);
    }
  }
  const auto thingOf = geometry::assign(costs);
  for (std::size_t i = 0; i < claims.size(); ++i) {
    if (thingOf[i]) matches[i] = {Verdict::kRight, static_cast<std::size_t>(*thingOf[i])};
  }
}

/// The nearest of all things, taken or not; none within the gates.
template <typename Claim, typename Thing, typename Cost>
std::optional<std::size_t> nearestThing(const Claim& claim, const std::vector<Thing>& things, const Cost& cost) {
  const auto costOf = [&](const Thing& thing) { return cost(claim, thing); };
  const auto nearest = std::ranges::min_element(things, {}, costOf);
  if (nearest == things.end() || std::isinf(costOf(*nearest))) return std::nullopt;
  return static_cast<std::size_t>(nearest - things.begin());
}

bool stoodOpen(const TrueDoor& door, base::Time from, base::Time to) {
  if (stateAt(door, from) != map::DoorState::kClosed) return true;
  return std::ranges::any_of(door.states, [&](const TrueDoorState& state) {
    return state.time >= from && state.time <= to && state.state != map::DoorState::kClosed;
  });
}

/// In how many of the images that show the whole thing the entity was detected.
FoundCount imagesWith(const std::multimap<base::EntityId, base::Time>& images, std::optional<base::EntityId> entity,
                      const Sighting& sighting) {
  FoundCount count{sighting.images.size(), 0};
  if (!entity) return count;
  const auto range = images.equal_range(*entity);
  count.found = static_cast<std::size_t>(std::ranges::count_if(sighting.images, [&range](base::Time image) {
    return std::any_of(range.first, range.second, [image](const auto& detection) {
      return std::chrono::abs(detection.second - image) <= kSameImage;
    });
  }));
  return count;
}

void countThing(const Sighting& sighting, std::optional<base::EntityId> entity, const Claims& claims,
                DetectionCounts& counts) {
  const FoundCount one{1, entity ? 1U : 0U};
  counts.all += one;
  if (sighting.visible) counts.visible += one;
  if (sighting.passed) counts.passed += one;
  if (claims.images) *counts.images += imagesWith(*claims.images, entity, sighting);
}

void countClaim(Verdict verdict, DetectionCounts& counts) {
  if (verdict == Verdict::kRight) ++counts.right;
  if (verdict == Verdict::kWrong) ++counts.wrong;
}

/// By true thing the index of the claim that found it.
std::vector<std::optional<std::size_t>> finders(const std::vector<ClaimMatch>& matches, std::size_t things) {
  std::vector<std::optional<std::size_t>> claimOf(things);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (matches[i].verdict == Verdict::kRight) claimOf[*matches[i].truth] = i;
  }
  return claimOf;
}

map::HingeSide otherSide(map::HingeSide side) {
  if (side == map::HingeSide::kUnknown) return side;
  return side == map::HingeSide::kLeft ? map::HingeSide::kRight : map::HingeSide::kLeft;
}

/// Errors of what a claim does not tell (NaN) are no errors.
void note(double error, std::vector<double>& errors) {
  if (std::isfinite(error)) errors.push_back(std::abs(error));
}

void judgePose(const ClaimedDoor& claim, const TrueDoor& door, DoorScore& score) {
  const auto actual = leafPoseOf(door);
  note(distance(claim.T_world_door, actual), score.centre);
  note(turnOfLines(claim.T_world_door.theta, actual.theta), score.normal);
  note(claim.door.width - door.width, score.width);
  if (claim.door.height > 0.0) note(claim.door.height - door.height, score.height);
  if (door.hingeSide != map::HingeSide::kUnknown) {
    const bool seenFromBehind = turnBetween(claim.T_world_door.theta, actual.theta) > std::numbers::pi / 2.0;
    const auto side = seenFromBehind ? otherSide(claim.door.hingeSide) : claim.door.hingeSide;
    score.hingeSides += {1, side == door.hingeSide ? 1U : 0U};
  }
  if (door.leaves > 0) score.states += {1, claim.door.state == stateAt(door, claim.lastSeen) ? 1U : 0U};
}

void judgePose(const ClaimedStaircase& claim, const TrueStaircase& stairs, StairsScore& score) {
  if (claim.foot) note((*claim.foot - stairs.foot.head<2>()).norm(), score.foot);
  note(turnBetween(claim.T_world_stairs.theta, stairs.direction), score.direction);
  note(claim.stairs.stepWidth - stairs.width, score.width);
  const double rise = stairs.head.z() - stairs.foot.z();
  note(claim.stairs.height - (claim.storey == stairs.storeys[0] ? rise : -rise), score.height);
}

void append(std::vector<double>& values, const std::vector<double>& others) {
  values.insert(values.end(), others.begin(), others.end());
}

}  // namespace

bool isLiftDoor(const Truth& truth, const TrueDoor& door) {
  return std::ranges::any_of(truth.rooms, [&door](const TrueRoom& room) {
    return room.use == "lift" && std::ranges::find(door.rooms, room.id) != door.rooms.end();
  });
}

geometry::Pose2 poseOf(const TrueDoor& door) {
  return geometry::toPose2(door.T_world_door);
}

geometry::Pose2 leafPoseOf(const TrueDoor& door) {
  return poseOf(door) * geometry::Pose2{door.leafOffset, 0.0, 0.0};
}

map::DoorState stateAt(const TrueDoor& door, base::Time time) {
  if (door.states.empty()) return map::DoorState::kClosed;
  const auto next = std::ranges::upper_bound(door.states, time, {}, &TrueDoorState::time);
  return next == door.states.begin() ? next->state : std::prev(next)->state;
}

std::vector<ClaimMatch> matchDoors(const std::vector<ClaimedDoor>& claims, const Truth& truth,
                                   const MatchGates& gates) {
  const auto cost = [&gates](const ClaimedDoor& claim, const TrueDoor& door) { return doorCost(claim, door, gates); };
  const auto costWithinKinds = [&](const ClaimedDoor& claim, const TrueDoor& door) {
    const bool sameKind = claim.door.hasLeaf == (door.leaves > 0) && !isLiftDoor(truth, door);
    return sameKind ? cost(claim, door) : geometry::kForbidden;
  };
  std::vector<ClaimMatch> matches(claims.size());
  assignPairs(claims, truth.doors, costWithinKinds, matches);
  for (std::size_t i = 0; i < claims.size(); ++i) {
    if (matches[i].truth) continue;
    matches[i].truth = nearestThing(claims[i], truth.doors, cost);
    if (!matches[i].truth) continue;
    const auto& door = truth.doors[*matches[i].truth];
    const bool openDoor = !claims[i].door.hasLeaf && stoodOpen(door, claims[i].firstSeen, claims[i].lastSeen);
    if (isLiftDoor(truth, door) || (door.leaves > 0 && openDoor)) matches[i].verdict = Verdict::kNeither;
  }
  return matches;
}

std::vector<ClaimMatch> matchStairs(const std::vector<ClaimedStaircase>& claims, const Truth& truth,
                                    const MatchGates& gates) {
  const auto cost = [&gates](const auto& claim, const auto& stairs) { return stairsCost(claim, stairs, gates); };
  std::vector<ClaimMatch> matches(claims.size());
  assignPairs(claims, truth.stairs, cost, matches);
  for (std::size_t i = 0; i < claims.size(); ++i) {
    if (!matches[i].truth) matches[i].truth = nearestThing(claims[i], truth.stairs, cost);
  }
  return matches;
}

FoundCount& FoundCount::operator+=(const FoundCount& other) {
  truth += other.truth;
  found += other.found;
  return *this;
}

DetectionCounts& DetectionCounts::operator+=(const DetectionCounts& other) {
  all += other.all;
  visible += other.visible;
  passed += other.passed;
  if (other.images) {
    if (!images) images.emplace();
    *images += *other.images;
  }
  right += other.right;
  wrong += other.wrong;
  return *this;
}

DoorScore& DoorScore::operator+=(const DoorScore& other) {
  counts += other.counts;
  append(centre, other.centre);
  append(normal, other.normal);
  append(width, other.width);
  append(height, other.height);
  hingeSides += other.hingeSides;
  states += other.states;
  return *this;
}

StairsScore& StairsScore::operator+=(const StairsScore& other) {
  counts += other.counts;
  append(foot, other.foot);
  append(direction, other.direction);
  append(width, other.width);
  append(height, other.height);
  return *this;
}

DoorScore scoreDoors(const Claims& claims, const std::vector<ClaimMatch>& matches, const Truth& truth,
                     bool withLeaves) {
  DoorScore score;
  if (claims.images) score.counts.images.emplace();
  const auto claimOf = finders(matches, truth.doors.size());
  for (std::size_t i = 0; i < truth.doors.size(); ++i) {
    const auto& door = truth.doors[i];
    if ((door.leaves > 0) != withLeaves || isLiftDoor(truth, door)) continue;
    const auto* claim = claimOf[i] ? &claims.doors[*claimOf[i]] : nullptr;
    countThing(door.sighting, claim != nullptr ? std::optional(claim->id) : std::nullopt, claims, score.counts);
    if (claim != nullptr) judgePose(*claim, door, score);
  }
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (claims.doors[i].door.hasLeaf == withLeaves) countClaim(matches[i].verdict, score.counts);
  }
  return score;
}

StairsScore scoreStairs(const Claims& claims, const std::vector<ClaimMatch>& matches, const Truth& truth) {
  StairsScore score;
  if (claims.images) score.counts.images.emplace();
  const auto claimOf = finders(matches, truth.stairs.size());
  for (std::size_t i = 0; i < truth.stairs.size(); ++i) {
    const auto* claim = claimOf[i] ? &claims.stairs[*claimOf[i]] : nullptr;
    countThing(truth.stairs[i].sighting, claim != nullptr ? std::optional(claim->id) : std::nullopt, claims,
               score.counts);
    if (claim != nullptr) judgePose(*claim, truth.stairs[i], score);
  }
  for (const auto& match : matches) countClaim(match.verdict, score.counts);
  return score;
}

}  // namespace prodomos::evaluation

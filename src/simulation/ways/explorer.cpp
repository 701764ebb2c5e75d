// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/ways/explorer.hpp"

#include "prodomos/base/error.hpp"

#include "simulation/ways/passing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace prodomos::simulation {

namespace {

/// Share of its time on a storey that the robot keeps to the corridors, as long as there is something new in them.
constexpr double kCorridorShare = 0.6;
/// Of the rooms, those that it enters before the others.
constexpr double kEntersFirst = 0.6;
/// Where it looks around: at crossings, and elsewhere now and then.
constexpr double kLooksAtCrossing = 0.7;
constexpr double kLooksElsewhere = 0.1;
/// A turn by one radian is as bad as so many metres, and so is the greatest whim.
constexpr double kTurnPrice = 0.8;
constexpr double kGreatestWhim = 5.0;
/// The least time on one storey, seconds.
constexpr double kLeastStage = 45.0;
/// Ways take longer than their length says: bends, and turns on the spot.
constexpr double kShareOfSpeed = 0.7;
/// Of all time, what the way from the start to the nearest lift or stairs may take.
constexpr double kShareToChange = 0.4;
/// Larger rooms are not crossed before one turns round in them, m².
constexpr double kLargeRoom = 60.0;

constexpr int kRays = 24;

/// How far one could go in each of kRays directions, at most `reach` metres.
std::array<double, kRays> openings(const FloorGrid& grid, const Eigen::Vector2d& point, double reach) {
  constexpr double kStep = 0.1;
  std::array<double, kRays> lengths{};
  for (int i = 0; i < kRays; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kRays;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    double& length = lengths[static_cast<std::size_t>(i)];
    while (length < reach && grid.isFree(point + (length + kStep) * direction)) length += kStep;
  }
  return lengths;
}

/// Can one go on in three directions?
bool isCrossing(const FloorGrid& grid, const Eigen::Vector2d& point) {
  constexpr double kFar = 3.5;
  const auto lengths = openings(grid, point, kFar);
  int ways = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    if (lengths[i] >= kFar && lengths[(i + 1) % lengths.size()] < kFar) ++ways;
  }
  return ways >= 3;
}

bool isCorridor(const Room& room) {
  return room.use == RoomUse::kCorridor;
}

/// Rooms that lead on to others: an explorer looks into stairwells as it does into corridors.
bool leadsOn(const Room& room) {
  return isCorridor(room) || room.use == RoomUse::kStairs;
}

/// A door between rooms that lead on, or that nothing closes.
bool isCorridorWay(const Building& building, const Door& door) {
  return door.leaves == 0 || stateOf(leastAngle(door)) == map::DoorState::kOpen ||
         std::ranges::all_of(door.rooms, [&](int room) {
           return room != kOutside && leadsOn(building.rooms[static_cast<std::size_t>(room)]);
         });
}

double areaOf(const Room& room) {
  return std::abs(signedArea(room.outline));
}

/// Metres from a point to the nearest way to another storey; infinite where there is none.
double lengthToChange(const Floors& floors, int storey, const Eigen::Vector2d& point) {
  const auto& roadmap = floors.roadmaps[static_cast<std::size_t>(storey)];
  std::optional<Roadmap::Routes> routes;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& change : floors.changes) {
    if (change.from != storey) continue;
    if (!routes) routes = roadmap.routesFrom(point);
    if (const auto node = roadmap.nearestNode(change.way.front().head<2>())) {
      least = std::min(least, routes->lengths[*node]);
    }
  }
  return least;
}

/// Rooms one may start in: corridors; without any, the room with most doors.
bool isCorridorLike(const Building& building, int room, bool hasCorridors) {
  if (hasCorridors) return isCorridor(building.rooms[static_cast<std::size_t>(room)]);
  const auto doorsOf = [&](int index) {
    return std::ranges::count_if(building.doors, [&](const Door& door) {
      return canBePassed(building, door) && (door.rooms[0] == index || door.rooms[1] == index);
    });
  };
  std::ptrdiff_t most = 0;
  for (int i = 0; i < static_cast<int>(building.rooms.size()); ++i) most = std::max(most, doorsOf(i));
  return doorsOf(room) == most;
}

}  // namespace

Floors::Floors(const Building& building, double clearance) {
  const int storeys = static_cast<int>(building.storeys.size());
  grids.reserve(building.storeys.size());
  for (int storey = 0; storey < storeys; ++storey) grids.emplace_back(building, storey, clearance);
  for (const auto& grid : grids) roadmaps.emplace_back(building, grid);
  changes = floorChanges(building, grids);
}

DrivenPose startOf(const Building& building, const Floors& floors, const TourOptions& options) {
  struct Candidate {
    int storey;
    Eigen::Vector2d position;
    std::ptrdiff_t everywhere;  ///< nodes one can come to
    std::ptrdiff_t openly;      ///< without opening a room's door
    double toOtherStorey;       ///< metres to the nearest lift or stairs
  };
  std::vector<Candidate> candidates;
  const auto collect = [&](const auto& isWanted) {
    for (const auto& roadmap : floors.roadmaps) {
      const auto reachedBy = [&](const Roadmap::Node& node, const DoorFilter& mayPass) {
        const auto routes = roadmap.routesFrom(node.position, mayPass);
        return std::ranges::count_if(routes.lengths, [](double length) { return std::isfinite(length); });
      };
      const auto isOpen = [&](std::size_t door) { return isCorridorWay(building, building.doors[door]); };
      for (const auto& node : roadmap.nodes()) {
        if (node.door || !isWanted(node.room)) continue;
        const int storey = building.rooms[static_cast<std::size_t>(node.room)].storey;
        candidates.push_back({storey, node.position, reachedBy(node, anyDoor), reachedBy(node, isOpen),
                              lengthToChange(floors, storey, node.position)});
      }
    }
  };
  const bool hasCorridors = std::ranges::any_of(building.rooms, isCorridor);
  collect([&](int room) { return isCorridorLike(building, room, hasCorridors); });
  if (candidates.empty()) collect([](int /*room*/) { return true; });
  if (candidates.empty()) throw base::Error(building.name + ": there is no room in which the robot could stand");

  for (const auto& reached : {&Candidate::everywhere, &Candidate::openly}) {
    const auto most = std::ranges::max(candidates, {}, reached).*reached;
    std::erase_if(candidates, [&](const Candidate& candidate) { return 2 * candidate.*reached < most; });
  }
  // So near to lift or stairs that there is time for another storey.
  const double nearest = std::ranges::min(candidates, {}, &Candidate::toOtherStorey).toOtherStorey;
  const double inTime = std::max(nearest, kShareToChange * options.duration * kShareOfSpeed * options.speed);
  if (std::isfinite(nearest)) {
    std::erase_if(candidates, [&](const Candidate& candidate) { return candidate.toOtherStorey > inTime; });
  }
  base::Random random(options.seed, "start of the tour");
  const auto& start = candidates[static_cast<std::size_t>(random.integer(0, static_cast<int>(candidates.size()) - 1))];
  const auto lengths = openings(floors.grids[static_cast<std::size_t>(start.storey)], start.position, 8.0);
  const auto longest = static_cast<double>(std::ranges::max_element(lengths) - lengths.begin());
  const double heading = geometry::normalizeAngle(2.0 * std::numbers::pi * longest / kRays);
  return {.pose = {start.position.x(), start.position.y(), heading},
          .z = building.storeys[static_cast<std::size_t>(start.storey)].floor_z,
          .storey = start.storey};
}

Explorer::Explorer(const Building& building, const Floors& floors, const TourOptions& options, Driver& driver)
    : building_(building),
      floors_(floors),
      options_(options),
      driver_(driver),
      random_(options.seed, "exploration"),
      visited_(building.storeys.size(), false) {
  for (const auto& roadmap : floors.roadmaps) knowledge_.push_back({std::vector(roadmap.nodes().size(), false), {}});
  for (std::size_t i = 0; i < building.rooms.size(); ++i) {
    entersFirst_.push_back(random_.uniform() < kEntersFirst);
    whims_.push_back(random_.uniform(0.0, kGreatestWhim));
  }
  visited_[storey()] = true;
  if (building.storeys.size() > 1) {
    const int inTime = std::max(2, static_cast<int>(options.duration / kLeastStage));
    stages_ = std::min(static_cast<int>(building.storeys.size()), inTime);
    nextChange_ = chooseChange();
    if (nextChange_ == nullptr) {
      remarks_.push_back("no lift and no stairs lead the robot from storey " + std::to_string(storey()) +
                         " to another");
    }
  }
}

void Explorer::explore() {
  double lastIdle = -1.0;
  while (!driver_.isOver()) {
    markSeen();
    if (nextChange_ != nullptr && isTimeToLeave(*nextChange_)) {
      changeFloor(*nextChange_);
      continue;
    }
    const bool keepsToCorridors = driver_.now().time < stageBegin_ + kCorridorShare * (stageEnd() - stageBegin_);
    if (keepsToCorridors && exploreCorridors()) continue;
    if (exploreRooms(false) || exploreCorridors() || exploreRooms(true)) continue;
    // All is known: it moves on, or begins anew.
    if (nextChange_ != nullptr) {
      changeFloor(*nextChange_);
      continue;
    }
    knowledge() = {std::vector(roadmap().nodes().size(), false), {}};
    if (driver_.now().time == lastIdle) driver_.turnBy(2.0 * std::numbers::pi);
    lastIdle = driver_.now().time;
  }
}

std::vector<std::size_t> Explorer::unseenCorridorSpots() {
  std::vector<std::size_t> spots;
  for (std::size_t i = 0; i < roadmap().nodes().size(); ++i) {
    const auto& node = roadmap().nodes()[i];
    const bool isInCorridor = leadsOn(building_.rooms[static_cast<std::size_t>(node.room)]);
    if (!node.door && isInCorridor && !knowledge().seen[i]) spots.push_back(i);
  }
  return spots;
}

std::vector<std::size_t> Explorer::unenteredRoomSpots(bool everyRoom) {
  std::vector<std::size_t> spots;
  for (std::size_t i = 0; i < building_.rooms.size(); ++i) {
    const auto& room = building_.rooms[i];
    const int index = static_cast<int>(i);
    if (room.use != RoomUse::kRoom || knowledge().entered.contains(index)) continue;
    if (!everyRoom && !entersFirst_[i]) continue;
    const auto& all = roadmap().spotsOf(index);
    const std::size_t count = areaOf(room) > kLargeRoom ? all.size() : std::min<std::size_t>(1, all.size());
    spots.insert(spots.end(), all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
  }
  return spots;
}

std::optional<std::size_t> Explorer::nearest(const std::vector<std::size_t>& nodes, const Roadmap::Routes& routes) {
  std::optional<std::size_t> best;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t node : nodes) {
    const Eigen::Vector2d way = roadmap().nodes()[node].position - driver_.position();
    const double turn = std::abs(geometry::normalizeAngle(std::atan2(way.y(), way.x()) - driver_.now().pose.theta));
    const double price =
        routes.lengths[node] + kTurnPrice * turn + whims_[static_cast<std::size_t>(roadmap().nodes()[node].room)];
    if (price >= least) continue;
    least = price;
    best = node;
  }
  return best;
}

/// False: there is nothing new in corridors, as far as one comes in them.
bool Explorer::exploreCorridors() {
  const auto routes = roadmap().routesFrom(
      driver_.position(), [&](std::size_t door) { return isCorridorWay(building_, building_.doors[door]); });
  const auto node = nearest(unseenCorridorSpots(), routes);
  if (!node) return false;
  const bool looks =
      random_.uniform() < (isCrossing(grid(), roadmap().nodes()[*node].position) ? kLooksAtCrossing : kLooksElsewhere);
  const bool isThere = approach(*node, routes, looks ? Driver::AtEnd::kStop : Driver::AtEnd::kGoOn);
  knowledge().seen[*node] = true;
  if (isThere && looks) lookAround(*node);
  return true;
}

bool Explorer::exploreRooms(bool everyRoom) {
  auto nodes = unenteredRoomSpots(everyRoom);
  const auto corridorSpots = unseenCorridorSpots();
  nodes.insert(nodes.end(), corridorSpots.begin(), corridorSpots.end());
  const auto routes = roadmap().routesFrom(driver_.position());
  const auto node = nearest(nodes, routes);
  if (!node) return false;
  const int room = roadmap().nodes()[*node].room;
  if (leadsOn(building_.rooms[static_cast<std::size_t>(room)])) {
    approach(*node, routes, Driver::AtEnd::kGoOn);
    knowledge().seen[*node] = true;
  } else {
    enter(*node, routes);
    knowledge().entered.insert(room);
  }
  return true;
}

/// False: it cannot come there.
bool Explorer::approach(std::size_t node, const Roadmap::Routes& routes, Driver::AtEnd atEnd) {
  auto way = roadmap().path(driver_.position(), routes, node);
  if (way && driver_.mustTurnFor(*way)) {
    driver_.stand(0.0);
    way = roadmap().path(driver_.position(), routes, node);
  }
  if (way) driver_.follow(*way, atEnd);
  return way.has_value();
}

/// Goes in and turns round; in a large room perhaps once more elsewhere.
void Explorer::enter(std::size_t node, const Roadmap::Routes& routes) {
  if (!approach(node, routes, Driver::AtEnd::kStop)) return;
  const double side = random_.uniform() < 0.5 ? -1.0 : 1.0;
  driver_.turnBy(side * std::numbers::pi * random_.uniform(1.5, 2.0));
  const auto& spots = roadmap().spotsOf(roadmap().nodes()[node].room);
  const auto roomiest = spots.front();
  if (roomiest == node || random_.uniform() < 0.5) return;
  if (approach(roomiest, roadmap().routesFrom(driver_.position()), Driver::AtEnd::kStop)) {
    driver_.turnBy(side * std::numbers::pi * random_.uniform(1.0, 2.0));
  }
}

/// To one side and, at a crossing, to the other.
void Explorer::lookAround(std::size_t node) {
  const double side = random_.uniform() < 0.5 ? -1.0 : 1.0;
  const double angle = side * random_.uniform(1.2, 1.8);
  driver_.turnBy(angle);
  driver_.stand(random_.uniform(0.0, 1.0));
  if (isCrossing(grid(), roadmap().nodes()[node].position)) driver_.turnBy(-2.0 * angle);
}

void Explorer::markSeen() {
  constexpr std::size_t kEvery = 10;
  constexpr double kShareOfSpacing = 0.7;
  const auto& driven = driver_.driven();
  for (; marked_ < driven.size(); marked_ += kEvery) {
    const auto& pose = driven[marked_];
    if (pose.storey == kBetweenStoreys) continue;
    const auto at = static_cast<std::size_t>(pose.storey);
    const Eigen::Vector2d position(pose.pose.x, pose.pose.y);
    const int room = floors_.grids[at].roomAt(position);
    if (room == kOutside) continue;
    const auto& map = floors_.roadmaps[at];
    for (const std::size_t spot : map.spotsOf(room)) {
      const double distance = (map.nodes()[spot].position - position).norm();
      if (distance < kShareOfSpacing * map.spacingOf(room)) knowledge_[at].seen[spot] = true;
    }
  }
}

double Explorer::stageEnd() const {
  return options_.duration * (stage_ + 1) / stages_;
}

bool Explorer::isTimeToLeave(const FloorChange& change) {
  constexpr double kReserve = 16.0;  // seconds, as long as looking at one thing more may take
  const auto routes = roadmap().routesFrom(driver_.position());
  const auto node = roadmap().nearestNode(change.way.front().head<2>());
  if (!node) return true;
  const double toThere = routes.lengths[*node] / (kShareOfSpeed * options_.speed);
  return driver_.now().time + toThere + kReserve >= stageEnd();
}

/// By lift or by stairs to a storey not yet visited, as the seed has it; none where there is no more to be had.
const FloorChange* Explorer::chooseChange() {
  const bool prefersLift = random_.uniform() < 0.5;
  const auto routes = roadmap().routesFrom(driver_.position());
  const FloorChange* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& change : floors_.changes) {
    if (change.from != static_cast<int>(storey()) || visited_[static_cast<std::size_t>(change.to)]) continue;
    const auto node = roadmap().nearestNode(change.way.front().head<2>());
    if (!node || !std::isfinite(routes.lengths[*node])) continue;
    // Farther than all of the kind that is preferred, and farther than all that it comes to in time.
    constexpr double kOtherKind = 1e6;
    constexpr double kTooFar = 1e7;
    const double inTime = (stageEnd() - driver_.now().time) * kShareOfSpeed * options_.speed;
    const double price = routes.lengths[*node] + (change.byLift == prefersLift ? 0.0 : kOtherKind) +
                         (routes.lengths[*node] > inTime ? kTooFar : 0.0);
    if (price >= least) continue;
    least = price;
    best = &change;
  }
  return best;
}

void Explorer::changeFloor(const FloorChange& change) {
  nextChange_ = nullptr;
  const Eigen::Vector2d begin = change.way.front().head<2>();
  const auto routes = roadmap().routesFrom(driver_.position());
  const auto node = roadmap().nearestNode(begin);
  driver_.stand(0.0);
  const auto way = roadmap().path(driver_.position(), routes, *node, begin);
  if (!way) {
    remarks_.push_back("the robot finds no way to what leads from storey " + std::to_string(storey()) + " to another");
    return;
  }
  driver_.follow(*way, Driver::AtEnd::kStop);
  if (change.byLift) {
    driver_.turnBy(std::numbers::pi);
    driver_.ride(change.way.back().z(), change.to);
  } else {
    driver_.carryAlong(change.way, change.to);
  }
  if (driver_.isOver()) {
    remarks_.push_back("the time ends before the robot is on another storey");
    return;
  }
  ++stage_;
  stageBegin_ = driver_.now().time;
  visited_[storey()] = true;
  if (stage_ + 1 < stages_) nextChange_ = chooseChange();
}

}  // namespace prodomos::simulation

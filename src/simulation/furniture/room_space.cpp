// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/furniture/room_space.hpp"

#include "prodomos/simulation/furniture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace prodomos::simulation {

namespace {

constexpr double kCell = 0.1;               ///< metres
constexpr double kHeadroom = 1.9;           ///< metres: what hangs higher is in nobody's way
constexpr double kOnFloor = 0.3;            ///< metres: what begins higher stands on something
constexpr double kBeforeDoor = 1.0;         ///< metres
constexpr double kBeforeStairs = 1.2;       ///< metres
constexpr double kBesideWay = 0.45;         ///< metres to each side of a person's way
constexpr double kFrame = 0.2;              ///< metres: of a door, beside its opening
constexpr double kInView = 0.3;             ///< metres before what hangs
constexpr double kRoomClearance = 0.35;     ///< ways of 0.7 m
constexpr double kCorridorClearance = 0.6;  ///< ways of 1.2 m
constexpr double kGreatestLoss = 0.25;      ///< of the floor in reach: cut off
constexpr double kLeastLeft = 0.25;         ///< of the floor in reach

Eigen::Vector2d unit(double heading) {
  return {std::cos(heading), std::sin(heading)};
}

Footprint between(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double halfWidth) {
  const Eigen::Vector2d way = b - a;
  return {(a + b) / 2.0, std::atan2(way.y(), way.x()), {way.norm() + 2.0 * halfWidth, 2.0 * halfWidth}};
}

bool hangs(const Thing& thing) {
  const auto* kind = findThingKind(thing.kind);
  return kind != nullptr && kind->hangs;
}

}  // namespace

RoomSpace::RoomSpace(const Building& building, int room)
    : room_(building.rooms[static_cast<std::size_t>(room)]),
      storey_(building.storeys[static_cast<std::size_t>(room_.storey)]),
      clearance_(room_.use == RoomUse::kCorridor ? kCorridorClearance : kRoomClearance),
      walls_(wallsOf(room_.outline)) {
  keepDoorsClear(building);
  keepStairsClear(building);
  keepWaysClear(building);
  rasterize();
  for (const auto& thing : building.things) {
    if (thing.storey != room_.storey || !contains(room_.outline, placeOf(thing).middle)) continue;
    take(thing);
    if (hangs(thing)) continue;
    for (const auto cell : cellsNear(placeOf(thing))) open_[cell] = 0;
  }
  findReach();
}

RoomSpace::Volume RoomSpace::volumeOf(const Thing& thing) {
  const double middle = thing.T_world_thing.translation().z();
  return {placeOf(thing), middle - thing.size.z() / 2.0, middle + thing.size.z() / 2.0};
}

void RoomSpace::keepDoorsClear(const Building& building) {
  for (const auto& door : building.doors) {
    for (std::size_t side = 0; side < 2; ++side) {
      if (door.rooms[side] == kOutside || &building.rooms[static_cast<std::size_t>(door.rooms[side])] != &room_) {
        continue;
      }
      const Eigen::Vector2d into = (side == 0 ? -1.0 : 1.0) * unit(door.pose.theta);
      const Eigen::Vector2d sill = Eigen::Vector2d(door.pose.x, door.pose.y) + into * door.wallThickness / 2.0;
      const bool swingsHere = door.leaves > 0 && door.opensAlongNormal == (side == 1);
      const double leaf = door.leaves == 2 ? door.width / 2.0 : door.width;
      const double depth = swingsHere ? std::max(kBeforeDoor, leaf + 0.1) : kBeforeDoor;
      clear_.push_back({sill + into * depth / 2.0, door.pose.theta, {depth, door.width + 0.2}});
      hidden_.push_back({sill, door.pose.theta, {2.0 * kInView, door.width + 2.0 * kFrame}});
      goals_.emplace_back(sill + into * (clearance_ + kCell));
    }
  }
}

void RoomSpace::keepStairsClear(const Building& building) {
  for (const auto& stairs : building.stairs) {
    if (room_.storey != stairs.lowerStorey && room_.storey != stairs.upperStorey) continue;
    auto flight = placeOf(stairs);
    if (!contains(room_.outline, flight.middle)) continue;
    const Eigen::Vector2d uphill = unit(stairs.direction);
    const bool atHead = room_.storey == stairs.upperStorey;
    const Eigen::Vector3d end = atHead ? headOf(stairs) : stairs.foot;
    goals_.emplace_back(end.head<2>() + (atHead ? 1.0 : -1.0) * (clearance_ + kCell) * uphill);
    flights_.push_back(flight);
    // Steps that rise along a wall hide it; above a flight that goes down it is free.
    if (!atHead) hidden_.push_back({flight.middle, flight.heading, flight.size + Eigen::Vector2d(0.1, 2.0 * kInView)});
    flight.middle += (atHead ? 1.0 : -1.0) * kBeforeStairs / 2.0 * uphill;
    flight.size += Eigen::Vector2d(kBeforeStairs, 0.1);
    clear_.push_back(flight);
  }
}

void RoomSpace::keepWaysClear(const Building& building) {
  for (const auto& person : building.people) {
    if (person.storey != room_.storey) continue;
    for (std::size_t i = 0; i < person.way.size(); ++i) {
      const auto& from = person.way[i].position;
      const auto& to = person.way[std::min(i + 1, person.way.size() - 1)].position;
      clear_.push_back(between(from, to, kBesideWay));
    }
  }
}

Eigen::Vector2d RoomSpace::centreOf(std::size_t cell) const {
  const std::size_t column = cell % columns_;
  const std::size_t row = cell / columns_;
  return origin_ + kCell * Eigen::Vector2d(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
}

void RoomSpace::rasterize() {
  Eigen::Vector2d most = Eigen::Vector2d::Constant(-std::numeric_limits<double>::infinity());
  origin_ = -most;
  for (const auto& corner : room_.outline) {
    origin_ = origin_.cwiseMin(corner);
    most = most.cwiseMax(corner);
  }
  columns_ = static_cast<std::size_t>(std::ceil((most.x() - origin_.x()) / kCell)) + 1;
  rows_ = static_cast<std::size_t>(std::ceil((most.y() - origin_.y()) / kCell)) + 1;
  open_.assign(columns_ * rows_, 0);
  for (std::size_t row = 0; row < rows_; ++row) {
    const double y = origin_.y() + (static_cast<double>(row) + 0.5) * kCell;
    std::vector<double> crossings;
    for (const auto& wall : walls_) {
      if ((wall.from.y() > y) == (wall.to.y() > y)) continue;
      crossings.push_back(std::lerp(wall.from.x(), wall.to.x(), (y - wall.from.y()) / (wall.to.y() - wall.from.y())));
    }
    std::ranges::sort(crossings);
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const auto columnOf = [&](double x) { return static_cast<std::size_t>((x - origin_.x()) / kCell); };
      for (auto column = columnOf(crossings[i]); column <= columnOf(crossings[i + 1]); ++column) {
        open_[row * columns_ + column] = 1;
      }
    }
  }
  for (const auto& wall : walls_) {
    for (const auto cell : cellsNear(between(wall.from, wall.to, 0.0))) open_[cell] = 0;
  }
  for (const auto& flight : flights_) {
    for (const auto cell : cellsNear(flight)) open_[cell] = 0;
  }
}

/// Cells from whose middle the rectangle is nearer than a way's half width.
std::vector<std::size_t> RoomSpace::cellsNear(const Footprint& footprint) const {
  Eigen::Vector2d least = footprint.middle;
  Eigen::Vector2d most = footprint.middle;
  for (const auto& corner : footprint.corners()) {
    least = least.cwiseMin(corner);
    most = most.cwiseMax(corner);
  }
  const auto indexOf = [&](double offset, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(offset / kCell, 0.0, static_cast<double>(count - 1)));
  };
  const Eigen::Vector2d from = least - origin_ - Eigen::Vector2d::Constant(clearance_);
  const Eigen::Vector2d to = most - origin_ + Eigen::Vector2d::Constant(clearance_);
  std::vector<std::size_t> cells;
  for (auto row = indexOf(from.y(), rows_); row <= indexOf(to.y(), rows_); ++row) {
    for (auto column = indexOf(from.x(), columns_); column <= indexOf(to.x(), columns_); ++column) {
      const auto cell = row * columns_ + column;
      if (footprint.distanceTo(centreOf(cell)) < clearance_) cells.push_back(cell);
    }
  }
  return cells;
}

std::optional<std::size_t> RoomSpace::nearestOpen(const Eigen::Vector2d& point) const {
  constexpr double kReach = 0.8;
  std::optional<std::size_t> nearest;
  double least = kReach;
  const auto rowOf = [&](double y) {
    return static_cast<std::size_t>(std::clamp((y - origin_.y()) / kCell, 0.0, static_cast<double>(rows_ - 1)));
  };
  const auto columnOf = [&](double x) {
    return static_cast<std::size_t>(std::clamp((x - origin_.x()) / kCell, 0.0, static_cast<double>(columns_ - 1)));
  };
  for (auto row = rowOf(point.y() - kReach); row <= rowOf(point.y() + kReach); ++row) {
    for (auto column = columnOf(point.x() - kReach); column <= columnOf(point.x() + kReach); ++column) {
      const auto cell = row * columns_ + column;
      const double distance = (centreOf(cell) - point).norm();
      if (open_[cell] == 0 || distance >= least) continue;
      least = distance;
      nearest = cell;
    }
  }
  return nearest;
}

/// Of what hangs together with each goal in the room as its source has it.
void RoomSpace::findReach() {
  for (const auto& goal : goals_) {
    if (const auto cell = nearestOpen(goal)) reached_.push_back(*cell);
  }
  seen_.assign(open_.size(), 0);
  for (const auto goal : reached_) {
    if (seen_[goal] != 0) continue;
    starts_.push_back(goal);
    flood();
  }
  for (std::size_t cell = 0; cell < seen_.size(); ++cell) {
    if (seen_[cell] != 0) free_.push_back(cell);
  }
}

/// Marks what is in reach of the starts; returns how many cells that are.
std::size_t RoomSpace::flood() {
  seen_.assign(open_.size(), 0);
  queue_.clear();
  const auto visit = [&](std::size_t cell) {
    if (open_[cell] == 0 || seen_[cell] != 0) return;
    seen_[cell] = 1;
    queue_.push_back(cell);
  };
  for (const auto start : starts_) visit(start);
  std::size_t next = 0;
  while (next < queue_.size()) {  // which grows
    const auto cell = queue_[next++];
    // Cells at the raster's edge are closed: they lie at walls. Hence no neighbour is beyond it.
    visit(cell - 1);
    visit(cell + 1);
    visit(cell - columns_);
    visit(cell + columns_);
  }
  return queue_.size();
}

bool RoomSpace::fits(const Thing& thing) const {
  const auto volume = volumeOf(thing);
  if (!isWithin(room_.outline, volume.footprint) || volume.top > floorLevel() + ceilingHeight()) return false;
  const auto meets = [&](const Footprint& other) { return overlap(other, volume.footprint); };
  const auto meetsVolume = [&](const Volume& other) {
    return volume.bottom < other.top - 1e-6 && other.bottom < volume.top - 1e-6 && meets(other.footprint);
  };
  if (std::ranges::any_of(taken_, meetsVolume)) return false;
  if (hangs(thing)) return std::ranges::none_of(hidden_, meets) && !standsBefore(thing);
  const bool stands = volume.bottom < floorLevel() + kOnFloor;
  if (stands && std::ranges::any_of(inView_, meetsVolume)) return false;
  return volume.bottom > floorLevel() + kHeadroom || std::ranges::none_of(clear_, meets);
}

/// Is it hidden by something that stands at the wall?
bool RoomSpace::standsBefore(const Thing& thing) const {
  const auto view = viewOf(thing);
  return std::ranges::any_of(taken_, [&](const Volume& other) {
    return other.bottom < floorLevel() + kOnFloor && view.bottom < other.top &&
           overlap(other.footprint, view.footprint);
  });
}

/// The space before what hangs: it is to be seen.
RoomSpace::Volume RoomSpace::viewOf(const Thing& thing) {
  auto volume = volumeOf(thing);
  volume.footprint.middle += unit(volume.footprint.heading) * kInView / 2.0;
  volume.footprint.size.x() += kInView;
  return volume;
}

bool RoomSpace::leavesWays(const Footprint& footprint) {
  std::vector<std::size_t> closed;
  for (const auto cell : cellsNear(footprint)) {
    if (open_[cell] == 0) continue;
    open_[cell] = 0;
    closed.push_back(cell);
  }
  // Where a corridor is too narrow for its way as it is, nothing more is put.
  if (closed.empty()) return room_.use != RoomUse::kCorridor;
  const auto reached = static_cast<double>(flood());
  const auto taken = static_cast<double>(closedCells_ + closed.size());
  const auto before = static_cast<double>(free_.size());
  const bool all = std::ranges::all_of(reached_, [&](std::size_t goal) { return seen_[goal] != 0; });
  if (all && reached + taken >= before * (1.0 - kGreatestLoss) && reached >= before * kLeastLeft) {
    closedCells_ += closed.size();
    return true;
  }
  for (const auto cell : closed) open_[cell] = 1;
  return false;
}

void RoomSpace::take(const Thing& thing) {
  taken_.push_back(volumeOf(thing));
  if (hangs(thing)) inView_.push_back(viewOf(thing));
}

bool RoomSpace::tryAdd(const Thing& thing) {
  if (!fits(thing)) return false;
  const auto volume = volumeOf(thing);
  const bool stands = !hangs(thing) && volume.bottom < floorLevel() + kOnFloor;
  if (stands && !leavesWays(volume.footprint)) return false;
  take(thing);
  added_.push_back(thing);
  return true;
}

}  // namespace prodomos::simulation

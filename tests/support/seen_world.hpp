// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/cells.hpp"
#include "prodomos/prediction/surroundings.hpp"
#include "prodomos/simulation/building.hpp"

#include "support/plan_doors.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

/// What is known of a storey's floor: as if the seen rooms were known whole, or as lasers show them.
namespace prodomos::test {

class SeenWorld {
 public:
  SeenWorld(geometry::CellMap<map::CellState> cells, double resolution)
      : cells_(std::move(cells)), resolution_(resolution) {}

  map::CellState at(const Eigen::Vector2d& point) const {
    return cells_.at(geometry::cellAt(point.x(), point.y(), resolution_));
  }

  /// As maps tell it (Surroundings' own constructor): an obstacle where any quarter of a cell shows one.
  prediction::Surroundings around(const geometry::Pose2& T_world_here) const {
    using prediction::Surroundings;
    constexpr double kHalf = Surroundings::kCell / 2.0;
    Surroundings found;
    const Eigen::Vector2d ahead(std::cos(T_world_here.theta), std::sin(T_world_here.theta));
    const Eigen::Vector2d left(-ahead.y(), ahead.x());
    const Eigen::Vector2d here(T_world_here.x, T_world_here.y);
    for (int y = Surroundings::kBox.first.y; y <= Surroundings::kBox.last.y; ++y) {
      for (int x = Surroundings::kBox.first.x; x <= Surroundings::kBox.last.x; ++x) {
        auto state = map::CellState::kUnknown;
        for (const int quarter : {0, 1, 2, 3}) {
          const double u = kHalf * (2 * x + quarter % 2 + 0.5);
          const double v = kHalf * (2 * y + quarter / 2 + 0.5);
          const auto there = at(here + u * ahead + v * left);
          if (there == map::CellState::kUnknown) continue;
          state = there;
          if (there == map::CellState::kOccupied) break;
        }
        if (state != map::CellState::kUnknown) found.set({x, y}, state);
      }
    }
    return found;
  }

 private:
  geometry::CellMap<map::CellState> cells_;
  double resolution_;
};

/// The seen rooms are known whole.
inline SeenWorld wholeRooms(const simulation::Building& building, const std::vector<bool>& seen) {
  const auto cells = seenCells(building, seen);
  geometry::CellMap<map::CellState> states(cells.box(), map::CellState::kUnknown);
  for (int y = cells.box().first.y; y <= cells.box().last.y; ++y) {
    for (int x = cells.box().first.x; x <= cells.box().last.x; ++x) {
      const auto cell = cells.at({x, y});
      if (cell == SeenCell::kFloor) *states.find({x, y}) = map::CellState::kFree;
      if (cell == SeenCell::kWall) *states.find({x, y}) = map::CellState::kOccupied;
    }
  }
  return {std::move(states), kPlanResolution};
}

/// What a laser of all-round view shows from places in the seen rooms: between things that stand about, through doors
/// that stand open.
class LaserRounds {
 public:
  struct Options {
    double spacing = 1.5;  ///< metres between places
    double range = 20.0;   ///< metres
    double peeked = 0.5;   ///< share of the seen rooms, corridors apart, that were seen from one place alone
  };

  /// `gaps`: how much of each door's width is open: 0 nothing, 1 all, 0.3 at its left, -0.3 at its right.
  LaserRounds(const simulation::Building& building, const std::vector<double>& gaps) {
    std::vector<geometry::Polygon> outlines;
    for (const auto& room : building.rooms) outlines.push_back(room.outline);
    const auto box = geometry::boxOf(outlines, kResolution);
    areas_ = geometry::CellMap<std::int16_t>(box, kSolid);
    for (std::size_t i = 0; i < outlines.size(); ++i) {
      areas_.fill(outlines[i], static_cast<std::int16_t>(i), kResolution);
    }
    for (std::size_t i = 0; i < building.doors.size(); ++i) {
      const auto& door = building.doors[i];
      const double half = 0.5 * door.wallThickness + 0.06;
      areas_.fill(rectangle(door.pose, half, 0.5 * door.width), kOpening, kResolution);
      const double shut = (1.0 - std::abs(gaps[i])) * door.width + 0.2;  // into the jambs
      const geometry::Pose2 aside{0.0, -0.5 * gaps[i] * door.width, 0.0};
      if (std::abs(gaps[i]) < 1.0) areas_.fill(rectangle(door.pose * aside, 0.04, 0.5 * shut), kSolid, kResolution);
    }
    for (const auto& thing : building.things) {
      if (thing.T_world_thing.translation().z() - 0.5 * thing.size.z() > 0.5) continue;  // it hangs
      areas_.fill(rectangle(geometry::toPose2(thing.T_world_thing), 0.5 * thing.size.x(), 0.5 * thing.size.y()), kSolid,
                  kResolution);
    }
  }

  SeenWorld seenFrom(const simulation::Building& building, const std::vector<bool>& seen, const Options& options,
                     base::Random& random) const {
    geometry::CellMap<map::CellState> states(areas_.box(), map::CellState::kUnknown);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (!seen[i]) continue;
      auto places = placesIn(building.rooms[i].outline, static_cast<int>(i), options.spacing, random);
      if (places.empty()) continue;
      if (building.rooms[i].use != simulation::RoomUse::kCorridor && random.uniform() < options.peeked) {
        places = {places[static_cast<std::size_t>(random.integer(0, static_cast<int>(places.size()) - 1))]};
      }
      for (const auto& place : places) look(place, options.range, states);
    }
    return {std::move(states), kResolution};
  }

 private:
  static constexpr double kResolution = 0.05;  // metres
  static constexpr std::int16_t kSolid = -1;   // else the index of a room, or
  static constexpr std::int16_t kOpening = -2;
  static constexpr int kBeams = 720;

  static geometry::Polygon rectangle(const geometry::Pose2& pose, double halfX, double halfY) {
    return geometry::transformed(pose, {{-halfX, -halfY}, {halfX, -halfY}, {halfX, halfY}, {-halfX, halfY}});
  }

  int areaAt(const Eigen::Vector2d& point) const {
    return areas_.at(geometry::cellAt(point.x(), point.y(), kResolution));
  }

  std::vector<Eigen::Vector2d> placesIn(const geometry::Polygon& outline, int room, double spacing,
                                        base::Random& random) const {
    const auto box = geometry::boxOf({outline}, spacing);
    std::vector<Eigen::Vector2d> places;
    for (int y = box.first.y; y <= box.last.y; ++y) {
      for (int x = box.first.x; x <= box.last.x; ++x) {
        const Eigen::Vector2d place = spacing * Eigen::Vector2d(x + random.uniform(), y + random.uniform());
        const auto isClear = [&](double dx, double dy) { return areaAt(place + Eigen::Vector2d(dx, dy)) == room; };
        if (isClear(0, 0) && isClear(0.3, 0) && isClear(-0.3, 0) && isClear(0, 0.3) && isClear(0, -0.3)) {
          places.push_back(place);
        }
      }
    }
    return places;
  }

  void look(const Eigen::Vector2d& from, double range, geometry::CellMap<map::CellState>& states) const {
    const auto first = states.box().first;
    const Eigen::Vector2d corner = kResolution * Eigen::Vector2d(first.x, first.y);
    for (int i = 0; i < kBeams; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kBeams;
      const Eigen::Vector2d step(std::cos(angle), std::sin(angle));
      Eigen::Vector2d place = (from - corner) / kResolution;  // in cells, never below 0 but beyond the box
      for (double distance = 0.0; distance < range; distance += kResolution, place += step) {
        if (place.x() < 0.0 || place.y() < 0.0) break;
        const geometry::CellIndex cell{first.x + static_cast<int>(place.x()), first.y + static_cast<int>(place.y())};
        auto* state = states.find(cell);
        if (state == nullptr) break;
        if (areas_.at(cell) == kSolid) {
          *state = map::CellState::kOccupied;
          break;
        }
        *state = map::CellState::kFree;
      }
    }
  }

  geometry::CellMap<std::int16_t> areas_;
};

}  // namespace prodomos::test

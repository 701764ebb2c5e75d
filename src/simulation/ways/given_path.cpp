// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/ways/given_path.hpp"

#include "prodomos/base/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <utility>

namespace prodomos::simulation {

namespace {

std::string nameOf(const std::vector<Stop>& path, std::size_t index) {
  const auto& position = path[index].position;
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "point %zu of the path (%.2f, %.2f) on storey %d", index + 1, position.x(),
                position.y(), path[index].storey);
  return text.data();
}

/// What keeps the robot from standing there.
std::optional<std::string> faultOf(const Building& building, const Floors& floors, const Stop& stop) {
  if (stop.storey < 0 || stop.storey >= static_cast<int>(floors.grids.size())) {
    return "one of " + std::to_string(floors.grids.size()) + " storeys";
  }
  const auto& grid = floors.grids[static_cast<std::size_t>(stop.storey)];
  if (grid.isFree(stop.position)) return std::nullopt;
  const int room = roomAt(building, stop.storey, stop.position);
  if (room == kOutside) return "a point in a room or a doorway";
  return "room for the robot in \"" + building.rooms[static_cast<std::size_t>(room)].id +
         "\", off walls, furniture and stairs";
}

/// The nearest lift or stairs towards a storey that can be come to.
struct NextChange {
  const FloorChange* change;
  Polyline way;  ///< to where it begins
};

std::optional<NextChange> nextChange(const Floors& floors, const Stop& from, int toStorey) {
  const auto storey = static_cast<std::size_t>(from.storey);
  const auto& roadmap = floors.roadmaps[storey];
  const auto routes = roadmap.routesFrom(from.position);
  const FloorChange* best = nullptr;
  std::pair<int, double> least{std::abs(toStorey - from.storey), 0.0};  // storeys still to go, metres to drive
  for (const auto& change : floors.changes) {
    if (change.from != from.storey) continue;
    const auto node = roadmap.nearestNode(change.way.front().head<2>());
    if (!node || !std::isfinite(routes.lengths[*node])) continue;
    const std::pair price{std::abs(toStorey - change.to), routes.lengths[*node]};
    if (price >= least) continue;
    least = price;
    best = &change;
  }
  if (best == nullptr) return std::nullopt;
  const auto way = floors.grids[storey].path(from.position, best->way.front().head<2>());
  if (!way) return std::nullopt;
  return NextChange{best, *way};
}

/// Drives, or without a driver only finds out whether it could.
bool changeStorey(const Floors& floors, const Stop& from, int toStorey, Driver* driver) {
  Stop here = from;
  while (here.storey != toStorey) {
    const auto next = nextChange(floors, here, toStorey);
    if (!next) return false;
    if (driver != nullptr) {
      driver->follow(next->way, Driver::AtEnd::kStop);
      if (next->change->byLift) {
        driver->ride(next->change->way.back().z(), next->change->to);
      } else {
        driver->carryAlong(next->change->way, next->change->to);
      }
    }
    here = {next->change->to, next->change->way.back().head<2>()};
  }
  return true;
}

}  // namespace

DrivenPose startOf(const Building& building, const Floors& floors, const std::vector<Stop>& path) {
  std::vector<std::string> faults;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (const auto expected = faultOf(building, floors, path[i])) {
      faults.push_back(base::expectedFound(nameOf(path, i), *expected, "none"));
    }
  }
  if (!faults.empty()) throw base::UsageError(std::move(faults));
  for (std::size_t i = 1; i < path.size(); ++i) {
    const auto& before = path[i - 1];
    if (before.storey != path[i].storey) {
      if (changeStorey(floors, before, path[i].storey, nullptr)) continue;
      faults.push_back(base::expectedFound(nameOf(path, i),
                                           "a lift or stairs from storey " + std::to_string(before.storey), "none"));
    } else if (!floors.grids[static_cast<std::size_t>(before.storey)].isFreeLine(before.position, path[i].position)) {
      faults.push_back(base::expectedFound(nameOf(path, i), "a free way straight from the point before",
                                           "a wall, furniture or stairs in between"));
    }
  }
  if (!faults.empty()) throw base::UsageError(std::move(faults));

  const auto& first = path.front();
  double heading = 0.0;
  if (path.size() > 1) {
    const Eigen::Vector2d way = path[1].position - first.position;
    heading = std::atan2(way.y(), way.x());
  }
  return {.pose = {first.position.x(), first.position.y(), heading},
          .z = building.storeys[static_cast<std::size_t>(first.storey)].floor_z,
          .storey = first.storey};
}

std::vector<std::string> driveAlong(const std::vector<Stop>& path, const Floors& floors, Driver& driver) {
  std::vector<std::string> remarks;
  for (std::size_t i = 1; i < path.size() && !driver.isOver(); ++i) {
    const auto& before = path[i - 1];
    if (before.storey == path[i].storey) {
      driver.followExactly({path[i].position});
    } else {
      changeStorey(floors, before, path[i].storey, &driver);
      if (driver.isOver()) break;
      const auto way = floors.grids[static_cast<std::size_t>(path[i].storey)].path(driver.position(), path[i].position);
      if (way) driver.follow(*way, Driver::AtEnd::kStop);
    }
    if (driver.isOver() && i + 1 < path.size()) {
      remarks.push_back("the time ends on the way to " + nameOf(path, i));
    }
  }
  while (!driver.isOver()) driver.stand(1.0);
  return remarks;
}

}  // namespace prodomos::simulation

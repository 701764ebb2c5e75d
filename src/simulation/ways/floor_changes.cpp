// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/ways/floor_changes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace prodomos::simulation {

namespace {

/// How far before a flight's foot and behind its head the robot stands, and how far from there at most, metres.
constexpr double kBeforeFlight = 0.6;
constexpr double kAround = 0.8;

/// A flight leads on where another ends if it is no farther off, along and in height, metres.
constexpr double kLanding = 4.0;
constexpr double kSameHeight = 0.3;

Eigen::Vector2d directionOf(const Staircase& stairs) {
  return {std::cos(stairs.direction), std::sin(stairs.direction)};
}

Eigen::Vector3d lifted(const Eigen::Vector2d& point, double z) {
  return {point.x(), point.y(), z};
}

class StairWays {
 public:
  StairWays(const Building& building, const std::vector<FloorGrid>& grids) : building_(building), grids_(grids) {}

  /// Up over this flight, and the others that lead on from its landing.
  std::optional<FloorChange> wayUp(const Staircase& first) const {
    if (!isStorey(first.lowerStorey) || !isStorey(first.upperStorey)) return std::nullopt;
    if (!isLevel(first.foot, first.lowerStorey)) return std::nullopt;
    const auto before = standingPoint(first.lowerStorey, first.foot.head<2>() - kBeforeFlight * directionOf(first));
    if (!before) return std::nullopt;
    FloorChange change{.from = first.lowerStorey, .to = first.upperStorey, .way = {*before}};
    const Staircase* flight = &first;
    for (std::size_t flights = 0; flights < building_.stairs.size(); ++flights) {
      // The line through the noses of the steps begins one step before the first riser.
      change.way.push_back(flight->foot - lifted(flight->stepDepth * directionOf(*flight), 0.0));
      change.way.push_back(headOf(*flight));
      if (isLevel(change.way.back(), first.upperStorey)) break;
      flight = flightFrom(change.way.back());
      if (flight == nullptr) return std::nullopt;
    }
    const Eigen::Vector2d behind = change.way.back().head<2>() + kBeforeFlight * directionOf(*flight);
    const auto after = standingPoint(first.upperStorey, behind);
    if (!after) return std::nullopt;
    change.way.push_back(*after);
    return change;
  }

 private:
  bool isStorey(int storey) const { return storey >= 0 && storey < static_cast<int>(building_.storeys.size()); }
  double heightOf(int storey) const { return building_.storeys[static_cast<std::size_t>(storey)].floor_z; }
  bool isLevel(const Eigen::Vector3d& point, int storey) const {
    return std::abs(point.z() - heightOf(storey)) < kSameHeight;
  }

  std::optional<Eigen::Vector3d> standingPoint(int storey, const Eigen::Vector2d& point) const {
    const auto free = grids_[static_cast<std::size_t>(storey)].nearestFree(point, kAround);
    if (!free) return std::nullopt;
    return lifted(*free, heightOf(storey));
  }

  const Staircase* flightFrom(const Eigen::Vector3d& landing) const {
    const auto distance = [&](const Staircase& stairs) { return (stairs.foot - landing).norm(); };
    const Staircase* nearest = nullptr;
    for (const auto& stairs : building_.stairs) {
      if (std::abs(stairs.foot.z() - landing.z()) > kSameHeight || distance(stairs) > kLanding) continue;
      if (nearest == nullptr || distance(stairs) < distance(*nearest)) nearest = &stairs;
    }
    return nearest;
  }

  const Building& building_;
  const std::vector<FloorGrid>& grids_;
};

/// A spot in the lift, or before its doors, that is free on both storeys.
std::optional<Eigen::Vector2d> spotOf(const Lift& lift, const FloorGrid& one, const FloorGrid& other) {
  constexpr double kBeforeLift = 1.5;  // metres
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const auto& corner : lift.outline) middle += corner / static_cast<double>(lift.outline.size());
  for (const auto* grid : {&one, &other}) {
    auto spot = grid->nearestFree(middle, kBeforeLift);
    if (spot && one.isFree(*spot) && other.isFree(*spot)) return spot;
  }
  return std::nullopt;
}

}  // namespace

std::vector<FloorChange> floorChanges(const Building& building, const std::vector<FloorGrid>& grids) {
  std::vector<FloorChange> changes;
  const StairWays stairWays(building, grids);
  for (const auto& stairs : building.stairs) {
    auto up = stairWays.wayUp(stairs);
    if (!up) continue;
    FloorChange down{.from = up->to, .to = up->from, .way = {up->way.rbegin(), up->way.rend()}};
    changes.push_back(*std::move(up));
    changes.push_back(std::move(down));
  }
  for (const auto& lift : building.lifts) {
    const int storeys = static_cast<int>(std::min(lift.rooms.size(), grids.size()));
    const auto stopsAt = [&](int storey) { return lift.rooms[static_cast<std::size_t>(storey)] != kOutside; };
    for (int from = 0; from < storeys; ++from) {
      for (int to = 0; to < storeys; ++to) {
        if (from == to || !stopsAt(from) || !stopsAt(to)) continue;
        const auto& one = grids[static_cast<std::size_t>(from)];
        const auto& other = grids[static_cast<std::size_t>(to)];
        const auto spot = spotOf(lift, one, other);
        if (!spot) continue;
        const auto at = [&](int storey) {
          return lifted(*spot, building.storeys[static_cast<std::size_t>(storey)].floor_z);
        };
        changes.push_back({.from = from, .to = to, .byLift = true, .way = {at(from), at(to)}});
      }
    }
  }
  return changes;
}

}  // namespace prodomos::simulation

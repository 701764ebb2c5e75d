// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/furniture.hpp"

#include "prodomos/base/random.hpp"

#include "simulation/furniture/furnisher.hpp"
#include "simulation/scenes/scene_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

namespace prodomos::simulation {

namespace {

constexpr std::size_t kMostThings = 6000;  // a building: images count to 65535

/// Points on a raster of half a metre that are apart from walls and flights of stairs.
std::vector<Eigen::Vector2d> placesForLamps(const Building& building, const Room& room) {
  constexpr double kPitch = 0.5;
  constexpr double kFromWalls = 0.45;
  const auto walls = wallsOf(room.outline);
  const auto isFree = [&](const Eigen::Vector2d& point) {
    if (!contains(room.outline, point)) return false;
    const auto isNear = [&](const WallStretch& wall) {
      return distanceToSegment(point, wall.from, wall.to) < kFromWalls;
    };
    const auto isAbove = [&](const Staircase& stairs) {
      const bool here = stairs.lowerStorey == room.storey || stairs.upperStorey == room.storey;
      return here && placeOf(stairs).distanceTo(point) < kFromWalls;
    };
    return std::ranges::none_of(walls, isNear) && std::ranges::none_of(building.stairs, isAbove);
  };
  Eigen::Vector2d least = room.outline.front();
  Eigen::Vector2d most = least;
  for (const auto& corner : room.outline) {
    least = least.cwiseMin(corner);
    most = most.cwiseMax(corner);
  }
  // Symmetric about the middle, so that one lamp of a small room hangs there.
  const Eigen::Vector2d middle = (least + most) / 2.0;
  const auto countOf = [&](double length) { return static_cast<int>(length / 2.0 / kPitch); };
  std::vector<Eigen::Vector2d> places;
  for (int row = -countOf(most.y() - least.y()); row <= countOf(most.y() - least.y()); ++row) {
    for (int column = -countOf(most.x() - least.x()); column <= countOf(most.x() - least.x()); ++column) {
      const Eigen::Vector2d point = middle + kPitch * Eigen::Vector2d(column, row);
      if (isFree(point)) places.push_back(point);
    }
  }
  return places;
}

std::size_t nearestOf(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& point) {
  const auto nearest =
      std::ranges::min_element(points, {}, [&](const Eigen::Vector2d& each) { return (each - point).squaredNorm(); });
  return static_cast<std::size_t>(nearest - points.begin());
}

/// `count` of the places, spread evenly (k-means from points as far apart as can be).
std::vector<Eigen::Vector2d> spread(const std::vector<Eigen::Vector2d>& places, std::size_t count) {
  constexpr int kRounds = 6;
  std::vector<Eigen::Vector2d> chosen{places.front()};
  while (chosen.size() < count) {
    const auto distance = [&](const Eigen::Vector2d& place) {
      return (chosen[nearestOf(chosen, place)] - place).norm();
    };
    chosen.push_back(*std::ranges::max_element(places, {}, distance));
  }
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Eigen::Vector2d> sums(count, Eigen::Vector2d::Zero());
    std::vector<double> weights(count, 0.0);
    for (const auto& place : places) {
      const auto nearest = nearestOf(chosen, place);
      sums[nearest] += place;
      weights[nearest] += 1.0;
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (weights[i] > 0.0) chosen[i] = places[nearestOf(places, sums[i] / weights[i])];
    }
  }
  return chosen;
}

void lightUp(Building& building, std::uint64_t seed) {
  auto& lighting = building.lighting;
  if (!lighting.lamps.empty()) return;
  base::Random random(seed, "lighting");
  lighting.brightness = random.uniform(0.7, 1.25);
  lighting.ambient = random.uniform(0.25, 0.5);
  const double warmth = random.uniform(-1.0, 1.0);
  lighting.tint = Eigen::Vector3d(1.0 + 0.08 * warmth, 1.0, 1.0 - 0.12 * warmth).cast<float>();
  lighting.lamps = lampsOf(building);
}

/// A fitting under the ceiling for each lamp of the rooms that are furnished by seed.
void hangLamps(Building& building) {
  const auto* kind = findThingKind("ceiling_lamp");
  for (std::size_t i = 0; i < building.lighting.lamps.size(); ++i) {
    const auto& lamp = building.lighting.lamps[i];
    for (const auto& room : building.rooms) {
      const auto& storey = building.storeys[static_cast<std::size_t>(room.storey)];
      const double ceiling = storey.floor_z + storey.ceilingHeight;
      if (room.furnished || storey.ceilingHeight < 2.4 || lamp.z() < storey.floor_z || lamp.z() > ceiling ||
          !contains(room.outline, lamp.head<2>())) {
        continue;
      }
      const auto walls = wallsOf(room.outline);
      const auto& wall = *std::ranges::max_element(walls, {}, &WallStretch::length);
      Thing thing{.id = room.id + "/lamp_" + std::to_string(i + 1), .kind = "ceiling_lamp", .storey = room.storey};
      thing.size = kind->least;
      thing.T_world_thing = geometry::toPose3({lamp.x(), lamp.y(), std::atan2(wall.inward().y(), wall.inward().x())},
                                              ceiling - thing.size.z() / 2.0);
      if (isWithin(room.outline, placeOf(thing))) building.things.push_back(std::move(thing));
      break;
    }
  }
}

}  // namespace

std::vector<Eigen::Vector3d> lampsOf(const Building& building) {
  constexpr double kAreaOfLamp = 14.0;  // m²
  constexpr double kMostInRoom = 6.0;
  constexpr double kBelowCeiling = 0.15;
  std::vector<Eigen::Vector3d> lamps;
  for (const auto& room : building.rooms) {
    const auto places = placesForLamps(building, room);
    if (places.empty()) continue;
    const auto& storey = building.storeys[static_cast<std::size_t>(room.storey)];
    const auto wanted = std::clamp(std::round(signedArea(room.outline) / kAreaOfLamp), 1.0, kMostInRoom);
    const auto count = std::min(static_cast<std::size_t>(wanted), places.size());
    for (const auto& place : spread(places, count)) {
      lamps.emplace_back(place.x(), place.y(), storey.floor_z + storey.ceilingHeight - kBelowCeiling);
    }
  }
  return lamps;
}

void furnish(Building& building, std::uint64_t seed) {
  for (std::size_t i = 0; i < building.rooms.size() && building.things.size() < kMostThings; ++i) {
    if (building.rooms[i].furnished) continue;
    auto things = Furnisher(building, static_cast<int>(i), seed).furnish();
    std::ranges::move(things, std::back_inserter(building.things));
  }
  lightUp(building, seed);
  hangLamps(building);
}

}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"
#include "prodomos/simulation/surface.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace prodomos::simulation {

/// A kind of thing: what it looks like, how large it is, where it belongs.
struct ThingKind {
  std::string_view name;       ///< Thing::kind
  std::string_view className;  ///< of classTable()
  Eigen::Vector3d least;       ///< size by x (front to back), y (width), z (height), metres
  Eigen::Vector3d most;
  double bottom = 0.0;  ///< above the floor, as a rule; of what hangs on walls
  bool hangs = false;   ///< on a wall, its back against it
};

std::span<const ThingKind> thingKinds();
/// None: there is no such kind.
const ThingKind* findThingKind(std::string_view name);

/// Things and lighting by seed. Rooms are furnished by their label: along walls and in grids, clear of doors, stairs
/// and the ways of people, with a free way of 0.7 m (corridors: 1.2 m) from each door to the others. What the source
/// has given stays where it is; where it gives lamps, its lighting stays as well. To be called once, before people and
/// robots look for their ways. Same building and seed, same things.
void furnish(Building& building, std::uint64_t seed);

/// Below the ceilings, by the rooms' areas.
std::vector<Eigen::Vector3d> lampsOf(const Building& building);

/// In the world, within the thing's box; class of its kind, instance of thingInstance(). Colours by seed: alike for
/// things of one kind and one room.
std::vector<Surface> surfacesOf(const Building& building, std::size_t thing, std::uint64_t seed);

}  // namespace prodomos::simulation

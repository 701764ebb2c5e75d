// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"
#include "prodomos/simulation/surface.hpp"

#include "simulation/shell/house_look.hpp"

#include <array>
#include <cstddef>
#include <vector>

/// What a shell is put together from. All parts append to `surfaces`.
namespace prodomos::simulation {

/// A room at its height. One that stairs lead to and that is not modelled is a copy of the stairwell, closed all
/// around.
struct Level {
  Room room;
  double floorHeight = 0.0;
  double ceilingHeight = 2.8;
  bool isModelled = true;
  std::vector<Polygon> floorHoles;
  std::vector<Polygon> ceilingHoles;
};
std::vector<Level> levelsOf(const Building& building);

/// Of one room: floor, ceiling, walls with their openings, skirting, and the slab's edge around holes in the ceiling.
void addRoom(const Building& building, const Level& level, const HouseLook& look, std::vector<Surface>& surfaces);

/// Between the two rooms of the door of that index: threshold, reveals and lintel.
void addTunnel(const Building& building, std::size_t index, const HouseLook& look, std::vector<Surface>& surfaces);
/// The boards around the opening on both sides; nothing of a passage.
void addFrame(const Building& building, std::size_t index, const HouseLook& look, std::vector<Surface>& surfaces);
/// Whether the opening has a frame. Passages, which are wide or reach up to the ceiling, have none.
bool hasFrame(const Building& building, const Door& door);

/// Steps, underside and handrails of one flight.
void addFlight(const Building& building, std::size_t index, const HouseLook& look, std::vector<Surface>& surfaces);
void addLanding(const Building& building, std::size_t index, const HouseLook& look, std::vector<Surface>& surfaces);
/// Around the holes in the floor, but for walls and where flights begin and end.
void addRailings(const Building& building, const Level& level, const HouseLook& look, std::vector<Surface>& surfaces);

/// What a flight covers on the ground, counter-clockwise.
Polygon footprintOf(const Staircase& stairs);

/// A bar from one point to another with a square section, standing upright.
void addBar(Surface& surface, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double thickness);

}  // namespace prodomos::simulation

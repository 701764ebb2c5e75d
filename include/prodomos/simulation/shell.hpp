// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"
#include "prodomos/simulation/surface.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace prodomos::simulation {

/// What stands still and belongs to the house, in the world frame: floors, ceilings, walls with their openings,
/// skirting, door frames, stairs with handrails. Colours and fittings by seed. Of a building that was imported only
/// what its meshes lack: frames and stairs where no surface has such a class; never walls.
///
/// A room is seen from inside: its walls are the faces along its outline, and a door is a tunnel between the faces of
/// its two rooms, so that what lies between outlines is solid.
std::vector<Surface> shellOf(const Building& building, std::uint64_t seed);

/// Where in its wall the closed leaf hangs: its middle, along the door's x-axis from the middle of the wall, metres. 0
/// for a doorway.
double leafOffset(const Building& building, std::size_t door, std::uint64_t seed);

/// The leaf or leaves of one door as they stand at a time, world frame: with handles on both sides; the instance is
/// doorInstance(door), the class "door", of a lift "lift_door". As many surfaces and triangles, in the same order, at
/// all times. Empty for a doorway.
std::vector<Surface> leavesAt(const Building& building, std::size_t door, double time, std::uint64_t seed);

}  // namespace prodomos::simulation

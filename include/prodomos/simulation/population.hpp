// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <numbers>

namespace prodomos::simulation {

/// How long a leaf takes to open or to close, seconds.
inline constexpr double kSwingTime = 1.2;

/// Has the door stand open from `from` to `to`: it begins to open kSwingTime before and has closed as long after,
/// unless it was to be open by then anyway.
void openFor(Door& door, double from, double to, double angle = std::numbers::pi / 2.0);

/// Where a person is, metres, on its storey's floor.
Eigen::Vector2d positionAt(const Person& person, double time);

/// People by seed, as many as suit the building: some sit on its chairs, the others walk from room to room and pause.
/// Doors are opened for them and closed behind them. Their ways last for `duration` seconds. A building that has people
/// already, from its source, keeps just these; doors open for them as well. Same building and seed, same people.
void populate(Building& building, std::uint64_t seed, double duration);

}  // namespace prodomos::simulation

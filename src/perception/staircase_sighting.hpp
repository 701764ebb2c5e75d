// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/sightings.hpp"
#include "prodomos/perception/surfaces.hpp"

#include "perception/staircase_lattice.hpp"
#include "perception/staircase_steps.hpp"

namespace prodomos::perception {

/// What a view tells of the flight with these steps: foot, sides, head, and how sure all that is.
StaircaseSighting sightingOf(const RgbdView& view, const Surfaces& surfaces, const FoundLattice& found,
                             const geometry::Pose3& T_submap_flight, const FlightSteps& steps,
                             const ProfileCheck& check);

}  // namespace prodomos::perception

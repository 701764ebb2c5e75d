// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/sightings.hpp"
#include "prodomos/perception/surfaces.hpp"

#include <vector>

namespace prodomos::perception {

/// Flights seen from their side: upright patches whose upper edge is a sawtooth, level along treads and upright along
/// risers, all of one size. From there risers are turned away, and treads edge-on or above the camera.
std::vector<StaircaseSighting> findFlightsBeside(const RgbdView& view, const Surfaces& surfaces);

}  // namespace prodomos::perception

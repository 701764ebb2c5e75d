// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/sightings.hpp"
#include "prodomos/perception/surfaces.hpp"
#include "prodomos/sensors/image.hpp"

#include <vector>

namespace prodomos::perception {

/// The view with its patches, and over them each flight's steps, foot and direction.
sensors::Image<sensors::Rgb> drawStaircases(const RgbdView& view, const Surfaces& surfaces,
                                            const std::vector<StaircaseSighting>& flights);

}  // namespace prodomos::perception

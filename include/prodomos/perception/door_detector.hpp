// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/config.hpp"
#include "prodomos/perception/debug_images.hpp"
#include "prodomos/perception/sightings.hpp"
#include "prodomos/perception/surfaces.hpp"

#include <vector>

namespace prodomos::perception {

struct DoorDetectorConfig {
  bool enabled = true;
};

void describe(base::ConfigVisitor& visitor, DoorDetectorConfig& config);

/// Closed doors in the walls that this view shows (002 §II-D). `debug` may be null.
std::vector<DoorSighting> findDoors(const RgbdView& view, const Surfaces& surfaces, const DoorDetectorConfig& config,
                                    DebugImages* debug = nullptr);

}  // namespace prodomos::perception

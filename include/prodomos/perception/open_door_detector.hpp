// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/config.hpp"
#include "prodomos/perception/debug_images.hpp"
#include "prodomos/perception/sightings.hpp"
#include "prodomos/perception/surfaces.hpp"

#include <vector>

namespace prodomos::perception {

struct OpenDoorDetectorConfig {
  bool enabled = true;
};

void describe(base::ConfigVisitor& visitor, OpenDoorDetectorConfig& config);

/// Openings of door width and door height in the walls that this view shows: doors that stand open or ajar (their leaf
/// is seen: hasLeaf, openAngle) and doorways without a leaf (hasLeaf false). `debug` may be null.
std::vector<DoorSighting> findOpenDoors(const RgbdView& view, const Surfaces& surfaces,
                                        const OpenDoorDetectorConfig& config, DebugImages* debug = nullptr);

}  // namespace prodomos::perception

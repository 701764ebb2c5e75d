// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/config.hpp"
#include "prodomos/perception/debug_images.hpp"
#include "prodomos/perception/sightings.hpp"
#include "prodomos/perception/surfaces.hpp"

#include <cstdint>
#include <vector>

namespace prodomos::perception {

struct StaircaseDetectorConfig {
  bool enabled = true;
  std::uint64_t seed = 1;  ///< of all chance
};

void describe(base::ConfigVisitor& visitor, StaircaseDetectorConfig& config);

/// Flights, up and down, that this view shows (002 §II-C). `debug` may be null.
std::vector<StaircaseSighting> findStaircases(const RgbdView& view, const Surfaces& surfaces,
                                              const StaircaseDetectorConfig& config, DebugImages* debug = nullptr);

}  // namespace prodomos::perception

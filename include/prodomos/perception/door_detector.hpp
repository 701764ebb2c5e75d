// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/config.hpp"
#include "prodomos/perception/debug_images.hpp"
#include "prodomos/perception/sightings.hpp"
#include "prodomos/perception/surfaces.hpp"

#include <vector>

namespace prodomos::perception {

/// How doors are looked for in a wall's rectified image.
enum class DoorMethod : int {
  kPaper,     ///< 002 §II-D: aligned pairs of salient points; the handle's side is where more of them are
  kSegments,  ///< upright lines as jambs, and what speaks for a leaf between them
};

struct DoorDetectorConfig {
  bool enabled = true;
  int method = static_cast<int>(DoorMethod::kSegments);
  double reach = 8.0;          ///< metres; walls are looked at up to here
  double edgeContrast = 8.0;   ///< of a jamb, in the colour channel that differs most, 0 … 255
  double tilt = 0.09;          ///< radians that a jamb may deviate from the vertical
  double leastEvidence = 0.0;  ///< log-odds from which on a door is reported
};

void describe(base::ConfigVisitor& visitor, DoorDetectorConfig& config);

/// Closed doors in the walls that this view shows (002 §II-D). `debug` may be null.
std::vector<DoorSighting> findDoors(const RgbdView& view, const Surfaces& surfaces, const DoorDetectorConfig& config,
                                    DebugImages* debug = nullptr);

}  // namespace prodomos::perception

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
  bool fromLaser = true;      ///< look for leaves in scans, too
  double leastWidth = 0.6;    ///< metres between the jambs
  double mostWidth = 2.4;     ///< metres
  double mostPlain = 1.3;     ///< metres; wider ones need a lintel: else they are the mouths of corridors
  double leastHeight = 1.85;  ///< metres above the floor; lower ones are hatches
  double leastDepth = 0.8;    ///< metres of space behind the wall; less is a niche or a cupboard
};

void describe(base::ConfigVisitor& visitor, OpenDoorDetectorConfig& config);

/// Openings of door width and door height in the walls that this view shows: doors that stand open or ajar (their leaf
/// is seen: hasLeaf, openAngle) and doorways without a leaf (hasLeaf false). `debug` may be null.
std::vector<DoorSighting> findOpenDoors(const RgbdView& view, const Surfaces& surfaces,
                                        const OpenDoorDetectorConfig& config, DebugImages* debug = nullptr);

/// Doors of one leaf that stand open or ajar, as one scan of a level laser shows them: a gap between jambs, and a leaf
/// at one of these that would close it.
std::vector<DoorSighting> findOpenDoors(const sensors::LaserScan& scan, const geometry::Pose3& T_submap_body,
                                        double floor_z, base::Time time, const OpenDoorDetectorConfig& config);

}  // namespace prodomos::perception

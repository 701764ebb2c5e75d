// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/door_detector.hpp"
#include "prodomos/perception/doorway_detector.hpp"
#include "prodomos/perception/entity_memory.hpp"
#include "prodomos/perception/open_door_detector.hpp"
#include "prodomos/perception/people.hpp"
#include "prodomos/perception/staircase_detector.hpp"
#include "prodomos/perception/surfaces.hpp"

namespace prodomos::perception {

struct PerceptionConfig {
  bool enabled = true;
  double rate = 30.0;  ///< of images that doors and stairs are looked for in, at most, 1/s of the log's time
  SurfacesConfig surfaces;
  StaircaseDetectorConfig stairs;
  DoorDetectorConfig doors;
  OpenDoorDetectorConfig openDoors;
  DoorwayDetectorConfig doorways;
  PeopleConfig people;
  EntityMemoryConfig memory;
};

void describe(base::ConfigVisitor& visitor, PerceptionConfig& config);

}  // namespace prodomos::perception

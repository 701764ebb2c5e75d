// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/config.hpp"

namespace prodomos::perception {

void describe(base::ConfigVisitor& visitor, PerceptionConfig& config) {
  visitor.section("detectors", "what images and grids are searched for");
  visitor.key("enabled", config.enabled, "look for doors, stairs and people at all");
  visitor.key("rate", config.rate, "1/s", {0.1, 1000.0}, "of images that doors and stairs are looked for in, at most");
  visitor.endSection();
  describe(visitor, config.surfaces);
  describe(visitor, config.stairs);
  describe(visitor, config.doors);
  describe(visitor, config.openDoors);
  describe(visitor, config.doorways);
  describe(visitor, config.people);
  describe(visitor, config.memory);
}

}  // namespace prodomos::perception

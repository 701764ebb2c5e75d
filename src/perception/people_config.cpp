// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/people_config.hpp"

namespace prodomos::perception {

void describe(base::ConfigVisitor& visitor, PeopleConfig& config) {
  visitor.section("people", "people in images and laser scans");
  visitor.key("enabled", config.enabled, "look for people");
  visitor.key("models", config.models, "folder of the networks; empty: none in images");
  visitor.key("from_labels", config.fromLabels, "from label images in place of the networks");
  visitor.key("from_laser", config.fromLaser, "legs in laser scans, where the log has no images");
  visitor.key("rate", config.rate, "1/s", {0.1, 1000.0}, "of readings that people are looked for in");
  visitor.key("least_score", config.leastScore, "", {0.1, 1.0}, "of a person in one image");
  visitor.endSection();
}

}  // namespace prodomos::perception

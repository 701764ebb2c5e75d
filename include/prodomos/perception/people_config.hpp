// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/config.hpp"

#include <string>

namespace prodomos::perception {

struct PeopleConfig {
  bool enabled = true;
  std::string models;       ///< folder of the networks (docs/following-people.md); empty: none in images
  bool fromLabels = false;  ///< from label images in place of the networks
  bool fromLaser = true;    ///< legs in laser scans, where the log has no images
  double rate = 10.0;       ///< of readings that people are looked for in, 1/s of the log's time
  double leastScore = 0.5;  ///< of a person in one image, 0 … 1
};

void describe(base::ConfigVisitor& visitor, PeopleConfig& config);

}  // namespace prodomos::perception

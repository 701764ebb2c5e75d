// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/prediction.hpp"

#include "text.hpp"

#include <string>
#include <vector>

namespace prodomos::apps {

struct ScoredMap {
  std::string map;
  std::string building;
  evaluation::PredictionScore score;
};

/// Null where no map has the measure.
const ScoredMap* findWorst(const std::vector<ScoredMap>& maps, const evaluation::Measure& measure);

/// To the standard output; "-" where a measure cannot be taken.
void printTable(const std::string& title, const evaluation::PredictionScore& pooled,
                const std::vector<ScoredMap>& maps);

}  // namespace prodomos::apps

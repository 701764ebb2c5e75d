// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/statistics.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace prodomos::apps {

/// What every kind of score is asked with.
struct EvaluateOptions {
  std::vector<std::string> maps;  ///< one, or all that are to be scored together
  std::string poses = "refined";
  bool json = false;
  std::string truth;                ///< the file to compare with
  std::vector<std::string> truths;  ///< of each map the truth file; none: those beside the logs
  std::string html;                 ///< where to write the page; empty: none
  std::string frame = "auto";       ///< of the truth's poses
  double delta = 1.0;               ///< seconds
  int leastPixels = 1000;           ///< of a person that counts
  double range = 5.0;               ///< metres to a person that counts
};

/// What maps are compared with.
enum class Against {
  kFile,        ///< one map with a file that an option of the kind's own names
  kTruthOfLog,  ///< MAP... with the LOG.truth.json of each (--truth); there may be a page (--html)
  kItself,      ///< MAP..., each with what it shows in the end
};

/// What can be scored.
struct Kind {
  const char* name;
  const char* text;
  void (*addOptions)(CLI::App& kind, EvaluateOptions& options);
  void (*evaluate)(const EvaluateOptions& options);
  Against against = Against::kFile;
};

extern const Kind kPrediction;  // evaluate_prediction.cpp
extern const Kind kHindsight;   // evaluate_hindsight.cpp
extern const Kind kNoise;       // evaluate_scores.cpp
extern const Kind kLabels;
extern const Kind kPlanes;
extern const Kind kObjects;
extern const Kind kHumans;

/// A map and the truth of its log.
struct MapAndTruth {
  std::string map;
  std::string truth;
};

/// Of each map the truth that was named, or else the one beside the log that the map was made of. Throws
/// base::UsageError where there are not as many truths as maps.
std::vector<MapAndTruth> mapsAndTruths(const EvaluateOptions& options);

nlohmann::json toJson(const evaluation::Statistics& statistics);

}  // namespace prodomos::apps

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/id.hpp"
#include "prodomos/base/time.hpp"

#include <Eigen/Core>

#include <optional>
#include <string_view>
#include <vector>

namespace prodomos::map {

enum class PredictionState { kOpen, kConfirmed, kRefuted, kMerged };

/// {u | f(u) / max f > threshold}: the free floor that is expected at one relative threshold (002 eq. (2), (3), (5)).
struct PredictedArea {
  double threshold = 0.5;
  std::vector<Eigen::Vector2d> outline_in_submap;  ///< in the frame of the predicted sub-map
};

/// An entry of the ledger: a bet that gets settled.
struct Prediction {
  base::PredictionId id;
  base::EntityId cause;       ///< the door, the staircase, the human
  base::SubMapId node;        ///< the predicted sub-map; of a human: the observed one it stands in
  double probability = 0.0;   ///< that an unseen space lies behind
  double expectedArea = 0.0;  ///< m²
  std::vector<PredictedArea> areas;
  base::Time made{};
  PredictionState state = PredictionState::kOpen;
  std::optional<base::Time> settled;
  std::optional<base::SubMapId> mergedInto;
};

/// "open", "confirmed", "refuted", "merged".
std::string_view toString(PredictionState state);

}  // namespace prodomos::map

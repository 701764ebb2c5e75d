// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/prediction/extrapolation.hpp"

namespace prodomos::prediction {

struct PredictionConfig {
  bool enabled = true;
  double leastProbability = 0.5;  ///< bets that are less likely to come true are not made
  double robotRadius = 0.25;      ///< metres, where it stands to enter
  ExtrapolationConfig extrapolation;
};

void describe(base::ConfigVisitor& visitor, PredictionConfig& config);

}  // namespace prodomos::prediction

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/baselines.hpp"

namespace prodomos::evaluation {

/// Written by tests/bench/fit_baselines, from the training plans of datasets/plans_split.yaml: 870 doors.
/// Mean IoU there: half-disc 0.387, fixed box 0.423, clipped box 0.481.
inline constexpr Baselines kTrainedBaselines = {
    .halfDiscRadius = 4.40, .fixedBox = {2.3, 2.3, 4.8}, .clippedBox = {3.0, 3.0, 5.0}};

}  // namespace prodomos::evaluation

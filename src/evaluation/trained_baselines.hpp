// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/baselines.hpp"

namespace prodomos::evaluation {

/// Written by tests/bench/fit_baselines, from the training plans of datasets/plans_split.yaml: 881 doors.
/// Mean IoU there: half-disc 0.383, fixed box 0.411, clipped box 0.475.
inline constexpr Baselines kTrainedBaselines = {
    .halfDiscRadius = 4.50, .fixedBox = {2.5, 2.5, 4.8}, .clippedBox = {3.5, 3.5, 5.0}};

}  // namespace prodomos::evaluation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/baselines.hpp"

namespace prodomos::evaluation {

inline constexpr Baselines kTrainedBaselines = {
    .halfDiscRadius = 3.0, .fixedBox = {2.5, 2.5, 5.0}, .clippedBox = {3.0, 3.0, 6.0}};

}  // namespace prodomos::evaluation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/half_disc.hpp"

#include <algorithm>
#include <numeric>

namespace prodomos::evaluation {

void accumulate(ByRadius& sums) {
  std::partial_sum(sums.begin(), sums.end(), sums.begin());
}

void add(ByRadius& sums, const ByRadius& others) {
  std::ranges::transform(sums, others, sums.begin(), std::plus<>());
}

std::size_t radiusIndex(double distance) {
  return std::min(static_cast<std::size_t>(distance / kRadiusStep), kRadiusSteps);
}

}  // namespace prodomos::evaluation

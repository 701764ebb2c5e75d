// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace prodomos::evaluation {

/// Of errors, in their unit (the squared ones in its square). Deviations are those of the population (divided by n), as
/// in the tools that published figures come from.
struct Statistics {
  std::size_t count = 0;
  double mean = 0.0;
  double std = 0.0;
  double rmse = 0.0;
  double squaredMean = 0.0;
  double squaredStd = 0.0;
  double median = 0.0;  ///< of an even number the mean of the two in the middle
  double min = 0.0;
  double max = 0.0;
};

/// All zero where there are no values.
Statistics statisticsOf(std::vector<double> values);

/// None where there is nothing to have a share of: a measure that cannot be taken.
inline std::optional<double> shareOf(std::size_t part, std::size_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace prodomos::evaluation

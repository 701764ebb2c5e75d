// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace prodomos::evaluation {

namespace {

struct Moments {
  double mean = 0.0;
  double std = 0.0;
};

/// In two passes: with values far from zero the difference of sums would lose its digits.
Moments momentsOf(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  Moments moments;
  for (const double value : values) moments.mean += value / count;
  double variance = 0.0;
  for (const double value : values) variance += (value - moments.mean) * (value - moments.mean) / count;
  moments.std = std::sqrt(variance);
  return moments;
}

}  // namespace

Statistics statisticsOf(std::vector<double> values) {
  Statistics statistics;
  if (values.empty()) return statistics;
  std::ranges::sort(values);
  statistics.count = values.size();
  statistics.min = values.front();
  statistics.max = values.back();
  statistics.median = 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
  const auto moments = momentsOf(values);
  statistics.mean = moments.mean;
  statistics.std = moments.std;
  for (double& value : values) value *= value;
  const auto squared = momentsOf(values);
  statistics.squaredMean = squared.mean;
  statistics.squaredStd = squared.std;
  statistics.rmse = std::sqrt(squared.mean);
  return statistics;
}

}  // namespace prodomos::evaluation

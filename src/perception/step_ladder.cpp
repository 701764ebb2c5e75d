// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/step_ladder.hpp"

#include "perception/numeric.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace prodomos::perception {

namespace {

constexpr int kIterations = 4;
constexpr double kStrayRise = 0.03;    // metres off, where a tread begins to fade
constexpr double kStrayAlong = 0.06;   // metres
constexpr double kLeastSupport = 0.2;  // of the median tread's: fewer readings show a stray

/// Where in the rhythm of the steps the treads lie: the circular mean of z modulo the riser.
double phaseOf(const std::vector<Tread>& treads, double riser) {
  double cosine = 0.0;
  double sine = 0.0;
  for (const auto& tread : treads) {
    const double angle = 2.0 * std::numbers::pi * tread.z / riser;
    cosine += tread.weight * std::cos(angle);
    sine += tread.weight * std::sin(angle);
  }
  return std::atan2(sine, cosine) / (2.0 * std::numbers::pi) * riser;
}

struct Line {
  double start = 0.0;
  double step = 0.0;
  double sigma = 0.0;  ///< of the start of the middle

  double at(int k) const { return start + k * step; }
};

/// value = start + k * step, weighted; none where all k are one.
std::optional<Line> fitLine(const std::vector<int>& ks, const std::vector<double>& values,
                            const std::vector<double>& weights) {
  double sum = 0.0;
  double meanK = 0.0;
  double mean = 0.0;
  for (std::size_t i = 0; i < ks.size(); ++i) {
    sum += weights[i];
    meanK += weights[i] * ks[i];
    mean += weights[i] * values[i];
  }
  meanK /= sum;
  mean /= sum;
  double squares = 0.0;
  double products = 0.0;
  for (std::size_t i = 0; i < ks.size(); ++i) {
    squares += weights[i] * square(ks[i] - meanK);
    products += weights[i] * (ks[i] - meanK) * (values[i] - mean);
  }
  if (!(squares > 1e-9 * sum)) return std::nullopt;
  Line line{.step = products / squares};
  line.start = mean - line.step * meanK;
  double residuals = 0.0;
  for (std::size_t i = 0; i < ks.size(); ++i) residuals += weights[i] * square(values[i] - line.at(ks[i]));
  line.sigma = std::sqrt(residuals / sum / std::max(1.0, sum));
  return line;
}

/// Treads that enough readings show.
std::pair<int, int> supported(const std::vector<int>& ks, const std::vector<Tread>& treads) {
  std::map<int, double> support;
  for (std::size_t i = 0; i < ks.size(); ++i) support[ks[i]] += treads[i].weight;
  std::vector<double> weights;
  weights.reserve(support.size());
  for (const auto& [k, weight] : support) weights.push_back(weight);
  const double least = kLeastSupport * median(std::move(weights));
  std::erase_if(support, [least](const auto& entry) { return entry.second < least; });
  return {support.begin()->first, support.rbegin()->first};
}

}  // namespace

std::optional<StepLadder> fitLadder(const std::vector<Tread>& treads, double riser) {
  if (treads.size() < 2 || !(riser > 0.0)) return std::nullopt;
  const double phase = phaseOf(treads, riser);
  Line rise{phase, riser};
  std::optional<Line> along;
  std::vector<int> ks(treads.size());
  std::vector<double> zs(treads.size());
  std::vector<double> alongs(treads.size());
  std::vector<double> weights(treads.size());
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    for (std::size_t i = 0; i < treads.size(); ++i) {
      const auto& tread = treads[i];
      ks[i] = static_cast<int>(std::lround((tread.z - rise.start) / rise.step));
      zs[i] = tread.z;
      alongs[i] = tread.along;
      weights[i] = tread.weight / (1.0 + square((tread.z - rise.at(ks[i])) / kStrayRise));
      if (along) weights[i] /= 1.0 + square((tread.along - along->at(ks[i])) / kStrayAlong);
    }
    const auto fitted = fitLine(ks, zs, weights);
    along = fitLine(ks, alongs, weights);
    if (!fitted || !along || !(fitted->step > 0.5 * riser)) return std::nullopt;
    rise = *fitted;
  }
  const auto [lowest, highest] = supported(ks, treads);
  if (lowest == highest) return std::nullopt;
  return StepLadder{rise.step, along->step, rise.start, along->start, lowest, highest, along->sigma, rise.sigma};
}

}  // namespace prodomos::perception

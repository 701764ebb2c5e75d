// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/calibration.hpp"

#include <algorithm>
#include <cmath>

namespace prodomos::evaluation {

namespace {

double sensible(double probability) {
  return std::isnan(probability) ? 0.5 : std::clamp(probability, 0.0, 1.0);
}

}  // namespace

std::optional<Calibration> calibrationOf(const std::vector<Bet>& bets, std::size_t binCount) {
  if (bets.empty()) return std::nullopt;
  const auto count = static_cast<double>(bets.size());
  Calibration calibration{.count = bets.size(), .brierSkill = std::nullopt, .bins = {}};
  for (std::size_t i = 0; i < binCount; ++i) {
    calibration.bins.push_back({.from = static_cast<double>(i) / static_cast<double>(binCount),
                                .to = static_cast<double>(i + 1) / static_cast<double>(binCount)});
  }
  for (const auto& bet : bets) {
    const double probability = sensible(bet.probability);
    const double outcome = bet.cameTrue ? 1.0 : 0.0;
    calibration.baseRate += outcome / count;
    calibration.brier += (probability - outcome) * (probability - outcome) / count;
    const auto place = static_cast<std::size_t>(probability * static_cast<double>(binCount));
    auto& bin = calibration.bins[std::min(place, binCount - 1)];
    ++bin.count;
    bin.meanProbability += probability;
    bin.frequency += outcome;
  }
  for (auto& bin : calibration.bins) {
    if (bin.count == 0) continue;
    const auto inBin = static_cast<double>(bin.count);
    bin.meanProbability /= inBin;
    bin.frequency /= inBin;
    calibration.expectedError += std::abs(bin.meanProbability - bin.frequency) * inBin / count;
  }
  const bool allAlike = std::ranges::all_of(bets, [&](const Bet& bet) { return bet.cameTrue == bets[0].cameTrue; });
  if (!allAlike) {
    calibration.brierSkill = 1.0 - calibration.brier / (calibration.baseRate * (1.0 - calibration.baseRate));
  }
  return calibration;
}

}  // namespace prodomos::evaluation

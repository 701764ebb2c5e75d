// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

/// Whether what is said to be likely is so often true.
namespace prodomos::evaluation {

struct Bet {
  double probability = 0.0;
  bool cameTrue = false;
};

/// Bets whose probabilities are alike.
struct ReliabilityBin {
  double from = 0.0;  ///< included
  double to = 0.0;    ///< not included, but for 1
  std::size_t count = 0;
  double meanProbability = 0.0;
  double frequency = 0.0;  ///< of those that came true
};

struct Calibration {
  std::size_t count = 0;
  double baseRate = 0.0;             ///< of bets that came true
  double brier = 0.0;                ///< mean of (probability - outcome)²
  std::optional<double> brierSkill;  ///< 1 - brier / that of always saying the base rate; none where all came out alike
  double expectedError = 0.0;        ///< ECE: |meanProbability - frequency| over bins, by their counts
  std::vector<ReliabilityBin> bins;  ///< of equal width; empty ones, too
};

/// None where there is no bet. Probabilities are taken into 0 … 1; what is not a number is a bet of 0.5.
std::optional<Calibration> calibrationOf(const std::vector<Bet>& bets, std::size_t binCount = 10);

}  // namespace prodomos::evaluation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/door_verdict.hpp"

#include <algorithm>
#include <array>

namespace prodomos::perception {

namespace {

/// In log-odds: of being a door, and of a pair of lines near a door's jambs being these.
struct CueWeight {
  std::string_view name;
  double evidence;
  double fit;
};

constexpr double kBias = -15.37;
constexpr std::array<CueWeight, static_cast<std::size_t>(Cue::kCount)> kWeights{{
    {"weaker jamb", 4.89, 6.52},
    {"stronger jamb", 4.58, 4.45},
    {"top edge", 2.33, 0.74},
    {"top goes on", -4.57, -0.80},
    {"top goes on both ways", 0.25, -4.13},
    {"no top", -2.92, -1.31},
    {"skirting", -2.52, -3.08},
    {"wall's foot", -3.08, -0.76},
    {"reaches floor", 2.93, -0.03},
    {"uniform", 5.90, -0.30},
    {"clutter", -11.40, -14.84},
    {"leaf at jambs", -1.06, 3.56},
    {"flat", 4.00, 5.64},
    {"no depth", -0.92, -0.27},
    {"turned", 0.41, 0.06},
    {"stands out", -2.33, 0.91},
    {"recessed", 1.04, 0.24},
    {"nothing around", -11.60, 0.00},
    {"handle", 0.27, 0.23},
    {"narrow", -3.39, -4.78},
    {"wide", -2.24, -3.48},
    {"low", -1.91, 0.00},
    {"high", 0.57, 0.92},
    {"cut", -1.99, 0.70},
    {"line inside", 0.66, -0.67},
    {"line outside", 0.89, 0.66},
    {"hidden", -3.09, -0.94},
}};

double sumOf(const DoorCandidate& candidate, double CueWeight::*weight) {
  double sum = 0.0;
  for (std::size_t i = 0; i < kWeights.size(); ++i) sum += kWeights[i].*weight * candidate.cues[i];
  return sum;
}

}  // namespace

double evidenceOf(const DoorCandidate& candidate) {
  return kBias + sumOf(candidate, &CueWeight::evidence);
}

double fitOf(const DoorCandidate& candidate) {
  return sumOf(candidate, &CueWeight::fit);
}

std::string_view weakestPoint(const DoorCandidate& candidate) {
  const auto share = [&](std::size_t i) { return kWeights[i].evidence * candidate.cues[i]; };
  std::size_t worst = 0;
  for (std::size_t i = 1; i < kWeights.size(); ++i) {
    if (share(i) < share(worst)) worst = i;
  }
  return kWeights[worst].name;
}

}  // namespace prodomos::perception

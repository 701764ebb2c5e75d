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

constexpr double kBias = -16.88;
constexpr std::array<CueWeight, static_cast<std::size_t>(Cue::kCount)> kWeights{{
    {"weaker jamb", 4.83, 6.76},
    {"stronger jamb", 5.77, 3.15},
    {"top edge", 2.33, 1.02},
    {"top goes on", -5.32, -2.02},
    {"top goes on both ways", 0.83, -6.04},
    {"no top", -3.04, -0.98},
    {"skirting", -2.90, -4.03},
    {"wall's foot", -3.31, -0.83},
    {"reaches floor", 2.72, 0.01},
    {"uniform", 6.24, -0.35},
    {"clutter", -10.30, -14.62},
    {"leaf at jambs", -1.13, 3.84},
    {"flat", 3.56, 6.01},
    {"no depth", -0.75, 0.53},
    {"turned", 0.34, 0.17},
    {"stands out", -2.28, 1.19},
    {"recessed", 1.07, 0.27},
    {"nothing around", -11.54, 0.00},
    {"handle", 0.31, 0.22},
    {"narrow", -3.29, -3.93},
    {"wide", -2.39, -3.90},
    {"low", -2.43, 0.00},
    {"high", 0.80, 0.75},
    {"cut", -0.93, 1.08},
    {"line inside", 0.59, -0.37},
    {"line outside", 0.77, 0.66},
    {"hidden", -2.85, -1.30},
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

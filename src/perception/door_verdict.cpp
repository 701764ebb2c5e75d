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

constexpr double kBias = -17.71;
constexpr std::array<CueWeight, static_cast<std::size_t>(Cue::kCount)> kWeights{{
    {"weaker jamb", 4.76, 6.86},
    {"stronger jamb", 5.71, 2.25},
    {"top edge", 2.27, 1.03},
    {"top goes on", -5.46, -1.87},
    {"top goes on both ways", 0.62, -5.64},
    {"no top", -3.01, -1.02},
    {"skirting", -3.18, -3.78},
    {"wall's foot", -3.23, -0.39},
    {"reaches floor", 2.56, -0.01},
    {"uniform", 6.42, 0.44},
    {"clutter", -8.46, -13.20},
    {"leaf at jambs", -1.22, 3.92},
    {"flat", 3.96, 4.79},
    {"no depth", -0.64, 1.27},
    {"turned", 0.33, 0.24},
    {"stands out", -2.33, 1.18},
    {"recessed", 1.11, 0.24},
    {"nothing around", -11.05, 0.00},
    {"handle", 0.34, 0.20},
    {"narrow", -3.33, -3.97},
    {"wide", -2.41, -3.86},
    {"low", -2.31, 0.00},
    {"high", 0.83, 0.68},
    {"cut", -0.61, 1.00},
    {"line inside", 0.68, -0.26},
    {"line outside", 0.93, 0.85},
    {"hidden", -2.52, -1.18},
    {"far", 0.48, -1.14},
    {"oblique", 0.18, 0.16},
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

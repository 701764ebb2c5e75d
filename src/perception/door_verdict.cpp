// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/door_verdict.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace prodomos::perception {

namespace {

/// In log-odds: of being a door, and of a pair of lines near a door's jambs being these.
struct CueWeight {
  std::string_view name;
  double evidence;
  double fit;
};

constexpr double kBias = -16.09;
/// What the corners' ratio tells of the hinge.
constexpr double kHandle = 0.78;
constexpr std::array<CueWeight, static_cast<std::size_t>(Cue::kCount)> kWeights{{
    {"weaker jamb", 3.10, 6.52},
    {"stronger jamb", 3.63, -0.52},
    {"top edge", 1.83, 1.35},
    {"top goes on", -4.85, -1.27},
    {"top goes on both ways", 1.08, -45.75},
    {"no top", -2.73, -0.35},
    {"skirting", -5.12, -3.62},
    {"wall's foot", -1.50, -0.60},
    {"reaches floor", 1.27, -0.12},
    {"uniform", 8.56, 1.76},
    {"clutter", -4.65, -11.46},
    {"leaf at jambs", -0.93, 3.63},
    {"flat", 4.89, 7.00},
    {"no depth", -3.97, -0.07},
    {"turned", -6.81, -18.46},
    {"stands out", -2.34, -10.49},
    {"recessed", 1.08, 0.50},
    {"nothing around", -9.94, 0.00},
    {"wall elsewhere", -4.75, 0.00},
    {"wall turned", -6.43, 0.00},
    {"handle", 0.62, 0.25},
    {"narrow", -4.12, -4.31},
    {"wide", -2.57, -3.53},
    {"low", -14.05, 0.00},
    {"high", 1.11, 1.01},
    {"cut", -0.12, 2.52},
    {"line inside", 0.21, -0.68},
    {"line outside", 0.58, 1.39},
    {"hidden", -0.70, 0.05},
    {"far", 1.13, 0.14},
    {"oblique", 0.37, 0.56},
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

double hingeEvidenceOf(const Handle& handle) {
  constexpr double kMost = 3.0;
  return std::clamp(kHandle * std::log(handle.right / handle.left), -kMost, kMost);
}

std::string_view nameOf(Cue cue) {
  return kWeights[static_cast<std::size_t>(cue)].name;
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

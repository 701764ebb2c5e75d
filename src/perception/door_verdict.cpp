// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/door_verdict.hpp"

#include <algorithm>
#include <array>

namespace prodomos::perception {

namespace {

struct CueWeight {
  std::string_view name;
  double weight;
};

constexpr double kBias = -6.0;
constexpr std::array<CueWeight, static_cast<std::size_t>(Cue::kCount)> kWeights{{
    {"weaker jamb", 3.0},
    {"stronger jamb", 2.0},
    {"top edge", 3.0},
    {"top goes on", -3.0},
    {"no top", -3.0},
    {"skirting", -3.0},
    {"wall's foot", -3.0},
    {"reaches floor", 2.0},
    {"uniform", 2.0},
    {"clutter", -20.0},
    {"leaf at jambs", 1.0},
    {"flat", 2.0},
    {"turned", -1.0},
    {"stands out", -1.5},
    {"recessed", 0.5},
    {"nothing around", -6.0},
    {"handle", 0.5},
    {"narrow", -1.0},
    {"wide", -0.7},
    {"low", -1.0},
    {"high", -1.0},
    {"cut", -2.0},
}};

}  // namespace

double evidenceOf(const DoorCandidate& candidate) {
  double evidence = kBias;
  for (std::size_t i = 0; i < kWeights.size(); ++i) evidence += kWeights[i].weight * candidate.cues[i];
  return evidence;
}

std::string_view weakestPoint(const DoorCandidate& candidate) {
  std::size_t worst = 0;
  for (std::size_t i = 1; i < kWeights.size(); ++i) {
    if (kWeights[i].weight * candidate.cues[i] < kWeights[worst].weight * candidate.cues[worst]) worst = i;
  }
  return kWeights[worst].name;
}

std::string_view nameOf(Cue cue) {
  return kWeights[static_cast<std::size_t>(cue)].name;
}

}  // namespace prodomos::perception

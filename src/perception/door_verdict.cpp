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

constexpr double kBias = -15.19;
constexpr std::array<CueWeight, static_cast<std::size_t>(Cue::kCount)> kWeights{{
    {"weaker jamb", 5.00}, {"stronger jamb", 4.24}, {"top edge", 2.52},       {"top goes on", -4.16},
    {"no top", -3.61},     {"skirting", -3.21},     {"wall's foot", -2.71},   {"reaches floor", 2.73},
    {"uniform", 7.05},     {"clutter", -6.47},      {"leaf at jambs", -1.49}, {"flat", 3.25},
    {"turned", 0.18},      {"stands out", -2.35},   {"recessed", 0.98},       {"nothing around", -15.45},
    {"handle", 0.32},      {"narrow", -4.05},       {"wide", -3.15},          {"low", -2.25},
    {"high", 0.65},        {"cut", -0.90},          {"line inside", 0.0},     {"line outside", 0.0},
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

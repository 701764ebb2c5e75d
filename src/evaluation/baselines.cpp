// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/baselines.hpp"

#include "evaluation/trained_baselines.hpp"

#include <algorithm>

namespace prodomos::evaluation {

namespace {

constexpr double kWidest = 6.0;  // metres, to either side
constexpr double kDeepest = 12.0;
constexpr double kFixedStep = 0.1;
constexpr double kClippedStep = 0.5;  // to clip a box costs more than to count its cells

}  // namespace

const Baselines& trainedBaselines() {
  return kTrainedBaselines;
}

BaselineFit::BaselineFit() : fixed_(candidates(kFixedStep)), clipped_(candidates(kClippedStep)) {}

std::vector<BaselineFit::Candidate> BaselineFit::candidates(double step) {
  std::vector<Candidate> all;
  for (int across = 1; across * step <= kWidest; ++across) {
    for (int ahead = 1; ahead * step <= kDeepest; ++ahead) {
      all.push_back({.box = {across * step, across * step, ahead * step}});
    }
  }
  return all;
}

const BaselineFit::Candidate& BaselineFit::bestOf(const std::vector<Candidate>& candidates) {
  return *std::ranges::max_element(candidates, {}, &Candidate::sum);
}

void BaselineFit::add(const DoorView& view) {
  ++count_;
  evaluation::add(halfDiscs_, view.iousOfHalfDiscs());
  for (auto& candidate : fixed_) candidate.sum += view.iou(candidate.box);
  for (auto& candidate : clipped_) candidate.sum += view.iouClipped(candidate.box);
}

BaselineFit::Result BaselineFit::best() const {
  const auto disc = std::ranges::max_element(halfDiscs_);
  const auto& fixed = bestOf(fixed_);
  const auto& clipped = bestOf(clipped_);
  const double radius = static_cast<double>(disc - halfDiscs_.begin() + 1) * kRadiusStep;
  const auto count = static_cast<double>(count_);
  return {{radius, fixed.box, clipped.box}, *disc / count, fixed.sum / count, clipped.sum / count};
}

}  // namespace prodomos::evaluation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/door_view.hpp"

#include <cstddef>
#include <vector>

/// Trivial predictors of the room behind a door: what any prediction must be better than.
namespace prodomos::evaluation {

/// The sizes of greatest mean IoU with the rooms of a list of plans.
struct Baselines {
  double halfDiscRadius = 0.0;
  DoorBox fixedBox;    ///< as it is
  DoorBox clippedBox;  ///< before it is clipped
};

/// Fitted on the training plans (datasets/plans_split.yaml) by tests/bench/fit_baselines.
const Baselines& trainedBaselines();

/// Tries all sizes on one room after the other.
class BaselineFit {
 public:
  BaselineFit();

  void add(const DoorView& view);

  std::size_t count() const { return count_; }
  struct Result {
    Baselines sizes;
    double halfDisc = 0.0;  ///< mean IoU at these sizes
    double fixedBox = 0.0;
    double clippedBox = 0.0;
  };
  /// There must have been a room.
  Result best() const;

 private:
  struct Candidate {
    DoorBox box;
    double sum = 0.0;  ///< of IoUs
  };
  static std::vector<Candidate> candidates(double step);
  static const Candidate& bestOf(const std::vector<Candidate>& candidates);

  std::size_t count_ = 0;
  ByRadius halfDiscs_{};
  std::vector<Candidate> fixed_;
  std::vector<Candidate> clipped_;
};

}  // namespace prodomos::evaluation

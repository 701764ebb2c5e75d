// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

namespace prodomos::perception {

/// A tread as some reading placed it.
struct Tread {
  double z = 0.0;
  double along = 0.0;  ///< of its front edge, metres uphill
  double weight = 0.0;
};

/// Equal steps: tread k lies at z = bottom_z + k * riser, its front edge at along = bottomAlong + k * depth.
struct StepLadder {
  double riser = 0.0;
  double depth = 0.0;
  double bottom_z = 0.0;
  double bottomAlong = 0.0;
  int lowest = 0;  ///< tread that was seen
  int highest = 0;
  double alongSigma = 0.0;  ///< metres, of the fitted edges
  double zSigma = 0.0;

  double zOf(int tread) const { return bottom_z + tread * riser; }
  double alongOf(int tread) const { return bottomAlong + tread * depth; }
};

/// Numbers the treads of many readings and fits equal steps to them; strays fade. `riser` is about right, as single
/// readings tell it. None without two different treads.
std::optional<StepLadder> fitLadder(const std::vector<Tread>& treads, double riser);

}  // namespace prodomos::perception

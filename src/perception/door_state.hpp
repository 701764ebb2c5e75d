// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/time.hpp"
#include "prodomos/map/entity.hpp"

#include <array>
#include <optional>

namespace prodomos::perception {

/// Whether a door is closed, ajar or open, from readings each of which may be wrong (Bayes' filter): one odd reading
/// does not flip it, a few in a row do, and after a long time unseen the first one does.
class DoorStateFilter {
 public:
  /// How likely a reading is where the door is truly closed, ajar, open.
  using Likelihoods = std::array<double, 3>;
  /// Of a reading that tells the state, rightly with probability `trust`.
  static Likelihoods told(map::DoorState state, double trust);

  /// `memory`: seconds in which what was known is forgotten.
  void update(base::Time time, const Likelihoods& likelihoods, double memory);
  /// Unknown until a reading has told.
  map::DoorState state() const;
  /// Of the last reading that told something.
  std::optional<base::Time> time() const { return isTold_ ? std::optional(time_) : std::nullopt; }

  static void fields(auto& archive, auto& self) { archive(self.beliefs_, self.isTold_, self.time_); }

 private:
  std::array<double, 3> beliefs_{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
  bool isTold_ = false;
  base::Time time_{};
};

}  // namespace prodomos::perception

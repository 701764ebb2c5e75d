// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/prediction/room_guess.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace prodomos::prediction {

/// How far off a wall may be, by bins of `bin` metres: chances in a row, as those of survival. All that lies beyond the
/// last bin counts as its far end.
class WallPlace {
 public:
  /// `endsHere(i)`: probability that it stands in bin i, given that it stands in none before.
  template <typename EndsHere>
  WallPlace(double bin, std::size_t bins, const EndsHere& endsHere) : bin_(bin), reaching_(bins + 1, 0.0) {
    constexpr double kNegligible = 1e-3;
    reaching_[0] = 1.0;
    for (std::size_t i = 0; i < bins && reaching_[i] > kNegligible; ++i) {
      reaching_[i + 1] = reaching_[i] * (1.0 - endsHere(i));
    }
  }

  /// Probability that it is farther off than that.
  double reaching(double distance) const {
    const double place = std::max(0.0, distance) / bin_;
    const auto i = static_cast<std::size_t>(place);
    if (i + 1 >= reaching_.size()) return 0.0;
    return reaching_[i] + (place - static_cast<double>(i)) * (reaching_[i + 1] - reaching_[i]);
  }

  /// What it is farther off than with probability `share`, metres.
  double quantile(double share) const {
    const std::size_t last = reaching_.size() - 1;
    std::size_t i = 0;
    while (i < last && reaching_[i + 1] > share) ++i;
    if (i == last) return bin_ * static_cast<double>(last);
    return bin_ * (static_cast<double>(i) + (reaching_[i] - share) / (reaching_[i] - reaching_[i + 1]));
  }

  /// The middles of `count` shares alike, the farthest first.
  std::vector<double> draws(std::size_t count) const {
    std::vector<double> found;
    for (std::size_t i = 0; i < count; ++i) {
      found.push_back(quantile((static_cast<double>(i) + 0.5) / static_cast<double>(count)));
    }
    return found;
  }

  UncertainLength length() const {
    double mean = 0.0;
    double square = 0.0;
    for (std::size_t i = 0; i + 1 < reaching_.size(); ++i) {
      const double here = reaching_[i];
      const double next = reaching_[i + 1];
      mean += 0.5 * bin_ * (here + next);  // E[d] = ∫ P(d > t) dt
      square +=
          bin_ * bin_ * (static_cast<double>(i) * (here + next) + (here + 2.0 * next) / 3.0);  // ∫ 2 t P(d > t) dt
    }
    return {mean, std::sqrt(std::max(0.0, square - mean * mean))};
  }

 private:
  double bin_;
  std::vector<double> reaching_;
};

}  // namespace prodomos::prediction

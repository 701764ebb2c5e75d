// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace prodomos::base {

/// Seeded randomness that gives the same numbers with every standard library: the engine is specified by the standard,
/// the distributions here are our own.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  /// In [least, most).
  double uniform(double least, double most) { return least + (most - least) * uniform(); }
  /// In {least, ..., most}.
  int integer(int least, int most) {
    return least + static_cast<int>(uniform() * (static_cast<double>(most) - least + 1.0));
  }
  /// Box-Muller.
  double normal(double mean, double sigma) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return mean + sigma * radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace prodomos::base

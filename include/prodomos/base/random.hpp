// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string_view>

namespace prodomos::base {

/// Seeded randomness that gives the same numbers with every standard library: the engine is specified by the standard,
/// the distributions here are our own.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// A sequence of its own for each purpose, so that drawing more for one changes nothing for the others.
  Random(std::uint64_t seed, std::string_view purpose) : engine_(seed ^ hash(purpose)) {}

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
  /// FNV-1a.
  static constexpr std::uint64_t hash(std::string_view text) {
    std::uint64_t value = 0xcbf29ce484222325U;
    for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
    return value;
  }

  std::mt19937_64 engine_;
};

}  // namespace prodomos::base

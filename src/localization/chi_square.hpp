// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>

namespace prodomos::localization {

/// How probable it is that the sum of `degrees` squares of standard normal numbers exceeds x.
inline double chiSquareExcess(int degrees, double x) {
  // Of one and of two degrees in closed form; each two more add a term.
  double sum = degrees % 2 == 1 ? std::erfc(std::sqrt(x / 2.0)) : std::exp(-x / 2.0);
  double term = degrees % 2 == 1 ? std::sqrt(2.0 * x / std::numbers::pi) * std::exp(-x / 2.0) : x / 2.0 * sum;
  for (int k = degrees % 2 == 1 ? 3 : 4; k <= degrees; k += 2) {
    sum += term;
    term *= x / k;
  }
  return sum;
}

/// What such a sum exceeds with the given probability, in (0, 1).
inline double chiSquareBound(int degrees, double probability) {
  double low = 0.0;
  double high = 1.0;
  while (chiSquareExcess(degrees, high) > probability) high *= 2.0;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (chiSquareExcess(degrees, middle) > probability ? low : high) = middle;
  }
  return high;
}

}  // namespace prodomos::localization

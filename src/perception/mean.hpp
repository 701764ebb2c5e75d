// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace prodomos::perception {

/// A mean of weighted values.
struct Mean {
  double weight = 0.0;
  double value = 0.0;

  void add(double another, double itsWeight) {
    weight += itsWeight;
    if (weight > 0.0) value += (another - value) * itsWeight / weight;
  }
  static void fields(auto& archive, auto& self) { archive(self.weight, self.value); }
};

}  // namespace prodomos::perception

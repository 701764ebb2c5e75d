// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prodomos::prediction {

/// Boosted trees that tell a probability: the logistic function of `bias` plus what each tree's leaf adds.
struct Forest {
  static constexpr std::size_t kDepth = 4;
  static constexpr std::size_t kInner = (std::size_t{1} << kDepth) - 1;
  static constexpr std::size_t kLeaves = std::size_t{1} << kDepth;

  /// Always of full depth: node n asks whether feature[n] is above threshold[n], and goes on to 2n + 1 if not, to 2n +
  /// 2 if so.
  struct Tree {
    std::array<std::uint8_t, kInner> feature{};
    std::array<float, kInner> threshold{};
    std::array<float, kLeaves> leaf{};
  };

  float bias = 0.0F;
  std::vector<Tree> trees;

  float logit(std::span<const float> features) const {
    float sum = bias;
    for (const auto& tree : trees) {
      std::size_t node = 0;
      while (node < kInner) node = 2 * node + (features[tree.feature[node]] > tree.threshold[node] ? 2 : 1);
      sum += tree.leaf[node - kInner];
    }
    return sum;
  }
  double probability(std::span<const float> features) const { return 1.0 / (1.0 + std::exp(-logit(features))); }
};

}  // namespace prodomos::prediction

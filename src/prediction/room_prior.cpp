// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prediction/room_prior.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace prodomos::prediction {

namespace {

/// Thresholds and leaves in thousandths.
struct StoredTree {
  std::array<std::uint8_t, Forest::kInner> feature;
  std::array<std::int32_t, Forest::kInner> threshold;
  std::array<std::int32_t, Forest::kLeaves> leaf;
};

// clang-format off
#include "prediction/room_prior.inc"
// clang-format on

template <std::size_t kCount>
Forest forestOf(double bias, const StoredTree (&trees)[kCount]) {
  const auto fromThousandths = [](std::int32_t value) { return static_cast<float>(value / 1000.0); };
  Forest forest{.bias = static_cast<float>(bias), .trees = {}};
  for (const auto& stored : trees) {
    Forest::Tree tree{.feature = stored.feature};
    std::ranges::transform(stored.threshold, tree.threshold.begin(), fromThousandths);
    std::ranges::transform(stored.leaf, tree.leaf.begin(), fromThousandths);
    forest.trees.push_back(tree);
  }
  return forest;
}

}  // namespace

const RoomPrior& trainedRoomPrior() {
  static const RoomPrior kPrior{.side = forestOf(kSideBias, kSideTrees),
                                .end = forestOf(kEndBias, kEndTrees),
                                .space = forestOf(kSpaceBias, kSpaceTrees),
                                .iouOffset = kIouOffset,
                                .iouSlope = kIouSlope,
                                .areaSpread = kAreaSpread};
  return kPrior;
}

}  // namespace prodomos::prediction

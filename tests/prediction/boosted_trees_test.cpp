// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/boosted_trees.hpp"

#include <gtest/gtest.h>

#include <array>

namespace prodomos::bench {
namespace {

constexpr BoostOptions kOptions{.trees = 60, .rate = 0.2};

/// Two features in 0 … 1 that matter, and one that does not.
template <typename Chance>
Samples drawn(const Chance& chance) {
  base::Random random(1, "boosted_trees_test");
  Samples samples;
  for (int i = 0; i < 5000; ++i) {
    const std::array features = {static_cast<float>(random.uniform()), static_cast<float>(random.uniform()),
                                 static_cast<float>(random.uniform())};
    samples.add(features, random.uniform() < chance(features[0], features[1]));
  }
  return samples;
}

double told(const prediction::Forest& forest, float a, float b) {
  const std::array features = {a, b, 0.5F};
  return forest.probability(features);
}

TEST(BoostedTrees, LearnWhatOnlyTwoFeaturesTogetherTell) {
  const auto samples = drawn([](float a, float b) { return (a > 0.5F) != (b > 0.5F) ? 0.95 : 0.05; });
  const auto forest = Booster(samples, kOptions, 1).train();
  EXPECT_GT(told(forest, 0.2F, 0.8F), 0.85);
  EXPECT_GT(told(forest, 0.8F, 0.2F), 0.85);
  EXPECT_LT(told(forest, 0.2F, 0.2F), 0.15);
  EXPECT_LT(told(forest, 0.8F, 0.8F), 0.15);
}

TEST(BoostedTrees, TellProbabilities) {
  const auto samples = drawn([](float a, float) { return 0.2 + 0.6 * static_cast<double>(a); });
  const auto forest = Booster(samples, kOptions, 1).train();
  for (const float a : {0.1F, 0.3F, 0.5F, 0.7F, 0.9F}) {
    double mean = 0.0;
    for (const float b : {0.1F, 0.3F, 0.5F, 0.7F, 0.9F}) mean += told(forest, a, b) / 5.0;
    EXPECT_NEAR(mean, 0.2 + 0.6 * static_cast<double>(a), 0.08) << a;
  }
}

TEST(BoostedTrees, OfAnswersThatAreAllAlikeTellThat) {
  const auto forest = Booster(drawn([](float, float) { return 1.0; }), kOptions, 1).train();
  EXPECT_GT(told(forest, 0.5F, 0.5F), 0.99);
}

TEST(BoostedTrees, WeighSamples) {
  Samples samples;
  for (int i = 0; i < 1000; ++i) {
    const std::array feature = {1.0F};
    samples.add(feature, i % 2 == 0, i % 2 == 0 ? 3.0F : 1.0F);
  }
  const auto forest = Booster(samples, kOptions, 1).train();
  EXPECT_NEAR(forest.probability(std::array{1.0F}), 0.75, 0.01);
}

TEST(BoostedTrees, AreTheSameForTheSameSeed) {
  const auto samples = drawn([](float a, float b) { return static_cast<double>(a * b); });
  const auto one = Booster(samples, kOptions, 7).train();
  const auto two = Booster(samples, kOptions, 7).train();
  const auto other = Booster(samples, kOptions, 8).train();
  EXPECT_EQ(told(one, 0.3F, 0.6F), told(two, 0.3F, 0.6F));
  EXPECT_NE(told(one, 0.3F, 0.6F), told(other, 0.3F, 0.6F));
}

}  // namespace
}  // namespace prodomos::bench

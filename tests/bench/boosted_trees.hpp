// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"

#include "prediction/room_forest.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

/// Gradient boosting of trees with log loss (Friedman 2001), second order, on features cut into at most 64 bins.
namespace prodomos::bench {

struct Samples {
  std::size_t features = 0;
  std::vector<float> values;  ///< sample by sample
  std::vector<std::uint8_t> isTrue;
  std::vector<float> weights;

  std::size_t count() const { return isTrue.size(); }
  void add(std::span<const float> sample, bool outcome, float weight = 1.0F) {
    features = sample.size();
    values.insert(values.end(), sample.begin(), sample.end());
    isTrue.push_back(outcome ? 1 : 0);
    weights.push_back(weight);
  }
  void append(const Samples& others) {
    if (others.count() == 0) return;
    features = others.features;
    values.insert(values.end(), others.values.begin(), others.values.end());
    isTrue.insert(isTrue.end(), others.isTrue.begin(), others.isTrue.end());
    weights.insert(weights.end(), others.weights.begin(), others.weights.end());
  }
};

struct BoostOptions {
  std::size_t trees = 80;
  double rate = 0.12;
  double sampleShare = 0.5;   ///< of samples that a tree sees
  double featureShare = 0.5;  ///< of features
  double leastHessian = 10.0;
  double ridge = 3.0;
};

class Booster {
 public:
  Booster(const Samples& samples, const BoostOptions& options, std::uint64_t seed)
      : samples_(samples), options_(options), random_(seed, "boosted trees") {
    cutIntoBins();
  }

  prediction::Forest train() {
    prediction::Forest forest;
    double sum = 0.0;
    double total = 0.0;
    for (std::size_t i = 0; i < samples_.count(); ++i) {
      sum += samples_.weights[i] * samples_.isTrue[i];
      total += samples_.weights[i];
    }
    const double mean = std::clamp(sum / total, 1e-4, 1.0 - 1e-4);
    forest.bias = rounded(std::log(mean / (1.0 - mean)));
    logits_.assign(samples_.count(), forest.bias);
    slopes_.resize(samples_.count());
    for (std::size_t i = 0; i < options_.trees; ++i) {
      forest.trees.push_back(growTree());
    }
    return forest;
  }

 private:
  static constexpr std::size_t kBins = 64;
  static constexpr float kNever = 1000.0F;  // no feature is above
  static constexpr std::size_t kInner = prediction::Forest::kInner;

  /// Sums over samples: of gradients, and of second derivatives.
  struct Slope {
    float gradient = 0.0F;
    float hessian = 0.0F;
  };
  struct Sum {
    double gradient = 0.0;
    double hessian = 0.0;
  };
  struct Split {
    double gain = 0.0;
    std::size_t feature = 0;
    std::size_t bin = 0;
  };

  /// To a thousandth: such numbers are short.
  static float rounded(double value) { return static_cast<float>(std::round(value * 1000.0) / 1000.0); }

  void cutIntoBins() {
    const std::size_t count = samples_.count();
    edges_.resize(samples_.features);
    bins_.resize(samples_.features * count);
    const std::size_t stride = std::max<std::size_t>(1, count / 20000);
    for (std::size_t f = 0; f < samples_.features; ++f) {
      std::vector<float> drawn;
      for (std::size_t i = 0; i < count; i += stride) drawn.push_back(samples_.values[i * samples_.features + f]);
      std::ranges::sort(drawn);
      auto& edges = edges_[f];
      std::vector<float> distinct = drawn;
      distinct.erase(std::ranges::unique(distinct).begin(), distinct.end());
      if (distinct.size() <= kBins) {
        for (std::size_t i = 0; i + 1 < distinct.size(); ++i) edges.push_back(0.5F * (distinct[i] + distinct[i + 1]));
      } else {
        for (std::size_t b = 1; b < kBins; ++b) {
          const float edge = drawn[b * drawn.size() / kBins];
          if (edges.empty() || edge > edges.back()) edges.push_back(edge);
        }
      }
      for (std::size_t i = 0; i < count; ++i) {
        const float value = samples_.values[i * samples_.features + f];
        bins_[i * samples_.features + f] =
            static_cast<std::uint8_t>(std::ranges::lower_bound(edges, value) - edges.begin());
      }
    }
  }

  prediction::Forest::Tree growTree() {
    const std::size_t count = samples_.count();
    std::vector<std::uint32_t> drawn;
    for (std::size_t i = 0; i < count; ++i) {
      const double p = 1.0 / (1.0 + std::exp(-logits_[i]));
      slopes_[i] = {static_cast<float>(samples_.weights[i] * (samples_.isTrue[i] - p)),
                    static_cast<float>(samples_.weights[i] * p * (1.0 - p))};
      if (random_.uniform() < options_.sampleShare) drawn.push_back(static_cast<std::uint32_t>(i));
    }
    std::vector<std::size_t> features;
    for (std::size_t f = 0; f < samples_.features; ++f) {
      if (random_.uniform() < options_.featureShare) features.push_back(f);
    }
    prediction::Forest::Tree tree;
    tree.threshold.fill(kNever);
    splitBin_.fill(255);
    growNode(tree, 0, drawn, features);
    for (std::size_t i = 0; i < count; ++i) {
      std::size_t node = 0;
      while (node < kInner)
        node = 2 * node + (bins_[i * samples_.features + tree.feature[node]] > splitBin_[node] ? 2 : 1);
      logits_[i] += tree.leaf[node - kInner];
    }
    return tree;
  }

  void growNode(prediction::Forest::Tree& tree, std::size_t node, std::span<std::uint32_t> drawn,
                const std::vector<std::size_t>& features) {
    Sum all;
    for (const auto i : drawn) {
      all.gradient += slopes_[i].gradient;
      all.hessian += slopes_[i].hessian;
    }
    if (node >= kInner) {
      tree.leaf[node - kInner] = rounded(options_.rate * all.gradient / (all.hessian + options_.ridge));
      return;
    }
    const Split split = bestSplit(drawn, features, all);
    if (split.gain > 0.0) {
      tree.feature[node] = static_cast<std::uint8_t>(split.feature);
      tree.threshold[node] = rounded(edges_[split.feature][split.bin]);
      splitBin_[node] = static_cast<std::uint8_t>(split.bin);
    }
    const std::uint8_t* bins = bins_.data() + tree.feature[node];
    const auto above = std::partition(drawn.begin(), drawn.end(),
                                      [&](auto i) { return bins[i * samples_.features] <= splitBin_[node]; });
    const auto below = static_cast<std::size_t>(above - drawn.begin());
    growNode(tree, 2 * node + 1, drawn.first(below), features);
    if (below < drawn.size()) growNode(tree, 2 * node + 2, drawn.subspan(below), features);
  }

  Split bestSplit(std::span<const std::uint32_t> drawn, const std::vector<std::size_t>& features, const Sum& all) {
    Split best;
    if (all.hessian < 2.0 * options_.leastHessian) return best;
    const auto score = [this](const Sum& sum) { return sum.gradient * sum.gradient / (sum.hessian + options_.ridge); };
    histograms_.assign(samples_.features * kBins, {});
    for (const auto i : drawn) {
      const std::uint8_t* bins = bins_.data() + i * samples_.features;
      for (const auto f : features) {
        auto& slope = histograms_[f * kBins + bins[f]];
        slope.gradient += slopes_[i].gradient;
        slope.hessian += slopes_[i].hessian;
      }
    }
    for (const auto f : features) {
      const Slope* histogram = histograms_.data() + f * kBins;
      Sum below;
      for (std::size_t b = 0; b < edges_[f].size(); ++b) {
        below.gradient += histogram[b].gradient;
        below.hessian += histogram[b].hessian;
        const Sum above{all.gradient - below.gradient, all.hessian - below.hessian};
        if (below.hessian < options_.leastHessian || above.hessian < options_.leastHessian) continue;
        const double gain = score(below) + score(above) - score(all);
        if (gain > best.gain) best = {gain, f, b};
      }
    }
    return best;
  }

  const Samples& samples_;
  BoostOptions options_;
  base::Random random_;
  std::vector<std::vector<float>> edges_;  // by feature: a value above edges[b] lies in a bin above b
  std::vector<std::uint8_t> bins_;         // sample by sample
  std::array<std::uint8_t, kInner> splitBin_{};
  std::vector<float> logits_;
  std::vector<Slope> slopes_;
  std::vector<Slope> histograms_;
};

}  // namespace prodomos::bench

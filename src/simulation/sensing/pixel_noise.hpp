// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace prodomos::simulation {

/// Noise by place rather than by order of drawing, so that it does not depend on threads: the same seed and pixel give
/// the same number. One seed a picture is drawn from base::Random.
class PixelNoise {
 public:
  explicit PixelNoise(std::uint64_t seed) : seed_(mixed(seed)) {}

  /// 64 random bits.
  std::uint64_t bits(int x, int y) const {
    const auto place = (std::uint64_t{static_cast<std::uint32_t>(y)} << 32) | static_cast<std::uint32_t>(x);
    return mixed(place + seed_);
  }
  /// Normal with σ = 1, and none beyond 3.5 σ: the sum of four uniform numbers of 16 bits.
  float normal(int x, int y) const { return normalOf(bits(x, y)); }

  static float normalOf(std::uint64_t bits) {
    const auto sum =
        static_cast<float>((bits & 0xffffU) + ((bits >> 16) & 0xffffU) + ((bits >> 32) & 0xffffU) + (bits >> 48));
    constexpr float kMean = 4.0F * 0xffff / 2.0F;
    constexpr float kSigma = 37836.7F;  // √(4 · 65536² / 12)
    return (sum - kMean) / kSigma;
  }

 private:
  /// SplitMix64.
  static std::uint64_t mixed(std::uint64_t value) {
    value += 0x9e3779b97f4a7c15U;
    value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9U;
    value = (value ^ (value >> 27)) * 0x94d049bb133111ebU;
    return value ^ (value >> 31);
  }

  std::uint64_t seed_;
};

}  // namespace prodomos::simulation

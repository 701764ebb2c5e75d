// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/skew_normal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace prodomos::geometry {
namespace {

using Eigen::Vector2d;

constexpr double kStep = 0.02;  // metres

const std::vector<SkewNormal> kSamples = {
    SkewNormal({0.0, 0.0}, 1.0),
    SkewNormal({0.3, -0.4}, 0.7, {0.0, 0.9}),
    SkewNormal({-1.0, 0.5}, 1.5, {2.0, -1.0}),
    SkewNormal({0.0, 0.0}, 0.5, {0.0, -30.0}),
};

/// Over a square that holds nearly all of each sample.
void forCells(const std::function<void(const Vector2d&)>& visit) {
  for (double x = -9.0; x < 9.0; x += kStep) {
    for (double y = -9.0; y < 9.0; y += kStep) visit({x, y});
  }
}

double areaAbove(const SkewNormal& density, double threshold) {
  std::size_t cells = 0;
  forCells([&](const Vector2d& point) { cells += density.relativeDensity(point) > threshold ? 1 : 0; });
  return static_cast<double>(cells) * kStep * kStep;
}

TEST(SkewNormal, IntegratesToOne) {
  for (const auto& sample : kSamples) {
    double sum = 0.0;
    forCells([&](const Vector2d& point) { sum += sample.density(point); });
    EXPECT_NEAR(sum * kStep * kStep, 1.0, 1e-3);
  }
}

TEST(SkewNormal, IsNowhereGreaterThanAtItsMode) {
  for (const auto& sample : kSamples) {
    EXPECT_DOUBLE_EQ(sample.relativeDensity(sample.mode()), 1.0);
    double greatest = 0.0;
    forCells([&](const Vector2d& point) { greatest = std::max(greatest, sample.relativeDensity(point)); });
    EXPECT_LE(greatest, 1.0 + 1e-12);
    EXPECT_GT(greatest, 0.99);
  }
}

TEST(SkewNormal, TheNormalsAreaIsThatOfTheFormula) {
  const double sigma = 1.2;
  for (const double threshold : {0.5, 0.6, 0.7}) {
    EXPECT_NEAR(areaAbove(SkewNormal({0.0, 0.0}, sigma), threshold),
                -2.0 * std::numbers::pi * sigma * sigma * std::log(threshold), 0.01);
  }
}

TEST(SkewNormal, AreasAtOneHalfAndAtSevenTenthsAreAsTwentyToTenPercent) {
  EXPECT_NEAR(areaAbove(kSamples[0], 0.5) / areaAbove(kSamples[0], 0.7), 1.94, 0.01);
  for (const auto& sample : kSamples) {
    const double ratio = areaAbove(sample, 0.5) / areaAbove(sample, 0.7);
    EXPECT_GT(ratio, 1.90);
    EXPECT_LT(ratio, 2.06);
  }
}

TEST(SkewNormal, ItsWiderSideLiesWhereTheShapePoints) {
  const SkewNormal left({0.0, 0.0}, 1.0, {0.0, 1.0});
  EXPECT_GT(left.relativeDensity({0.0, 1.0}), left.relativeDensity({0.0, -1.0}));
  EXPECT_GT(left.mode().y(), 0.0);
  const SkewNormal turned({0.0, 0.0}, 1.0, {1.0, 0.0});
  EXPECT_NEAR(turned.relativeDensity({1.0, 0.3}), left.relativeDensity({-0.3, 1.0}), 1e-12);
}

TEST(SkewNormal, NothingLiesBeyondItsReach) {
  for (const double threshold : {0.1, 0.5, 0.9}) {
    const SkewNormal here({0.0, 0.0}, 1.0, {0.4, -1.5});
    forCells([&](const Vector2d& point) {
      if (here.relativeDensity(point) <= threshold) return;
      EXPECT_LE(point.norm(), here.reach(threshold));
    });
  }
}

TEST(SkewNormal, TheLongestShapeIsNoTrouble) {
  const SkewNormal half({0.0, 0.0}, 1.0, {1e6, 0.0});
  EXPECT_NEAR(half.mode().x(), 0.0, 1e-3);
  EXPECT_DOUBLE_EQ(half.relativeDensity({-1.0, 0.0}), 0.0);
  EXPECT_NEAR(half.relativeDensity({1.0, 0.0}), std::exp(-0.5), 1e-3);
}

}  // namespace
}  // namespace prodomos::geometry

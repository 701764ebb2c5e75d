// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/label_degradation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace prodomos::simulation {
namespace {

using sensors::LabelImage;

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr LabelDegradation kNone{0.0, 0.0, 0.0, 0.0};

/// Class 1, with a thing of class 2 and instance 7 in the right half.
LabelImage halves() {
  LabelImage labels{.classes = sensors::Image<std::uint16_t>(kWidth, kHeight, 1),
                    .instances = sensors::Image<std::uint16_t>(kWidth, kHeight, 0)};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = kWidth / 2; x < kWidth; ++x) {
      labels.classes(x, y) = 2;
      labels.instances(x, y) = 7;
    }
  }
  return labels;
}

double shareThatDiffers(const LabelImage& a, const LabelImage& b) {
  int differ = 0;
  for (std::size_t i = 0; i < a.classes.size(); ++i) differ += a.classes.pixels()[i] != b.classes.pixels()[i];
  return static_cast<double>(differ) / static_cast<double>(a.classes.size());
}

bool equal(const LabelImage& a, const LabelImage& b) {
  return std::ranges::equal(a.classes.pixels(), b.classes.pixels()) &&
         std::ranges::equal(a.instances.pixels(), b.instances.pixels());
}

TEST(LabelDegradation, WithoutAnyTheLabelsComeBackUnchanged) {
  base::Random random(1);
  EXPECT_TRUE(equal(degraded(halves(), kNone, random), halves()));
}

TEST(LabelDegradation, TheTrueLabelsStayAsTheyAre) {
  const auto labels = halves();
  base::Random random(1);
  degraded(labels, {.boundaryNoise = 3.0, .flips = 0.2, .missed = 1.0, .falseThings = 2.0}, random);
  EXPECT_TRUE(equal(labels, halves()));
}

TEST(LabelDegradation, OutlinesWanderByAboutAsMuchAsSaid) {
  LabelDegradation outlines = kNone;
  outlines.boundaryNoise = 3.0;
  base::Random random(2);
  double squares = 0.0;
  constexpr int kImages = 20;
  for (int image = 0; image < kImages; ++image) {
    const auto labels = degraded(halves(), outlines, random);
    for (int y = 0; y < kHeight; ++y) {
      const auto* row = labels.classes.row(y);
      const auto left = std::count(row, row + kWidth, 1);
      squares += static_cast<double>((left - kWidth / 2) * (left - kWidth / 2));
    }
  }
  // Between the lattice's points the field is a mean of neighbours, and calmer: by 0.67 on the whole.
  const double rms = std::sqrt(squares / (kImages * kHeight));
  EXPECT_GT(rms, 1.5);
  EXPECT_LT(rms, 3.5);
}

TEST(LabelDegradation, FarFromOutlinesNothingWanders) {
  LabelDegradation outlines = kNone;
  outlines.boundaryNoise = 3.0;
  base::Random random(3);
  const auto labels = degraded(halves(), outlines, random);
  for (int y = 0; y < kHeight; ++y) {
    EXPECT_EQ(labels.classes(kWidth / 2 - 20, y), 1);
    EXPECT_EQ(labels.classes(kWidth / 2 + 20, y), 2);
  }
}

TEST(LabelDegradation, AboutAsManyPixelsFlipAsSaid) {
  LabelDegradation flips = kNone;
  flips.flips = 0.05;
  base::Random random(4);
  EXPECT_NEAR(shareThatDiffers(degraded(halves(), flips, random), halves()), 0.05, 0.015);
}

TEST(LabelDegradation, AFlippedPixelIsOfAClassThatTheImageHas) {
  base::Random random(5);
  const auto labels =
      degraded(halves(), {.boundaryNoise = 2.0, .flips = 0.3, .missed = 0.0, .falseThings = 3.0}, random);
  EXPECT_TRUE(std::ranges::all_of(labels.classes.pixels(), [](auto id) { return id == 1 || id == 2; }));
}

TEST(LabelDegradation, AMissedThingTakesTheClassAroundIt) {
  LabelDegradation missed = kNone;
  missed.missed = 1.0;
  base::Random random(6);
  const auto labels = degraded(halves(), missed, random);
  EXPECT_TRUE(std::ranges::all_of(labels.classes.pixels(), [](auto id) { return id == 1; }));
  EXPECT_TRUE(std::ranges::all_of(labels.instances.pixels(), [](auto id) { return id == 0; }));
}

TEST(LabelDegradation, ThingsAreMissedAsOftenAsSaid) {
  LabelDegradation missed = kNone;
  missed.missed = 0.25;
  base::Random random(7);
  int count = 0;
  for (int image = 0; image < 400; ++image) count += degraded(halves(), missed, random).classes(kWidth - 1, 0) == 1;
  EXPECT_NEAR(count / 400.0, 0.25, 0.07);
}

TEST(LabelDegradation, InventedThingsAreOfNoInstance) {
  LabelDegradation invented = kNone;
  invented.falseThings = 5.0;
  base::Random random(8);
  const auto labels = degraded(halves(), invented, random);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth / 2; ++x) {
      EXPECT_EQ(labels.instances(x, y), 0);
    }
  }
  EXPECT_GT(shareThatDiffers(labels, halves()), 0.01);
}

TEST(LabelDegradation, TheSameSeedErrsAlike) {
  const LabelDegradation all{};
  base::Random a(9);
  base::Random b(9);
  base::Random c(10);
  const auto first = degraded(halves(), all, a);
  EXPECT_TRUE(equal(first, degraded(halves(), all, b)));
  EXPECT_FALSE(equal(first, degraded(halves(), all, c)));
}

TEST(LabelDegradation, AnImageWithoutInstancesOrWithoutPixelsIsTaken) {
  base::Random random(11);
  LabelImage classesOnly{.classes = halves().classes};
  EXPECT_EQ(degraded(classesOnly, {}, random).classes.width(), kWidth);
  EXPECT_TRUE(degraded({}, {}, random).classes.empty());
}

TEST(LabelDegradation, AnImageOfOneClassHasNoOtherToFlipTo) {
  LabelImage plain{.classes = sensors::Image<std::uint16_t>(64, 48, 3)};
  base::Random random(12);
  const auto labels = degraded(plain, {.boundaryNoise = 3.0, .flips = 0.1, .missed = 0.1, .falseThings = 1.0}, random);
  EXPECT_TRUE(std::ranges::all_of(labels.classes.pixels(), [](auto id) { return id == 3; }));
}

}  // namespace
}  // namespace prodomos::simulation

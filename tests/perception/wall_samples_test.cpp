// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/wall_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace prodomos::perception {
namespace {

constexpr double kTolerance = 0.02;

/// Columns of what is seen from `from` on, 6 cm apart, in a direction from that of the wall.
void append(std::vector<ProfilePoint>& profile, const ProfilePoint& from, double direction, int count) {
  constexpr double kStep = 0.06;
  for (int i = 0; i < count; ++i) {
    profile.push_back({from.x + i * kStep * std::cos(direction), from.y + i * kStep * std::sin(direction)});
  }
}

TEST(WallSamples, LeafAlongTheWallIsNotTilted) {
  std::vector<ProfilePoint> profile;
  append(profile, {1.0, 0.05}, 0.0, 14);
  EXPECT_EQ(tiltedShare(profile, kTolerance), 0.0);
  for (std::size_t i = 0; i < profile.size(); i += 2) profile[i].y += 0.012;
  EXPECT_EQ(tiltedShare(profile, kTolerance), 0.0);
}

TEST(WallSamples, AjarLeafIsTiltedWhicheverSideItHangsOn) {
  for (const double angle : {-1.4, -0.6, -0.3, 0.3, 0.6, 1.4}) {
    std::vector<ProfilePoint> profile;
    append(profile, {1.0, 0.05}, angle, 14);
    EXPECT_GT(tiltedShare(profile, kTolerance), 0.5) << angle;
  }
}

TEST(WallSamples, SideOfAnOpeningIsTilted) {
  std::vector<ProfilePoint> profile;
  append(profile, {4.58, 0.0}, 1.5707963, 6);
  EXPECT_GT(tiltedShare(profile, kTolerance), 0.5);
}

TEST(WallSamples, RevealBesideALeafIsOfNoMatter) {
  std::vector<ProfilePoint> profile;
  append(profile, {1.0, 0.15}, 0.0, 11);
  append(profile, {1.66, 0.15}, -1.5707963, 3);
  EXPECT_EQ(tiltedShare(profile, kTolerance), 0.0);
}

TEST(WallSamples, FewColumnsTellNothing) {
  std::vector<ProfilePoint> profile;
  append(profile, {1.0, 0.05}, 0.6, 4);
  EXPECT_EQ(tiltedShare(profile, kTolerance), 0.0);
  EXPECT_EQ(tiltedShare({}, kTolerance), 0.0);
}

TEST(WallSamples, MedianColorIsThatOfMost) {
  std::vector<cv::Vec3b> colors(20, cv::Vec3b(160, 110, 70));
  colors.insert(colors.end(), 8, cv::Vec3b(20, 250, 250));
  const auto color = medianColor(colors, 12);
  ASSERT_TRUE(color);
  EXPECT_EQ(color->r, 160.0);
  EXPECT_EQ(color->g, 110.0);
  EXPECT_NEAR(shareLike(colors, *color), 20.0 / 28.0, 1e-9);
  EXPECT_FALSE(medianColor(colors, 100));
}

}  // namespace
}  // namespace prodomos::perception

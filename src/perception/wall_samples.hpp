// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "perception/rectified_wall.hpp"

#include <opencv2/core.hpp>

#include <cstddef>
#include <optional>
#include <vector>

/// Depth and colour of parts of a wall's image.
namespace prodomos::perception {

struct Box {
  int first = 0, last = 0;  ///< columns
  int top = 0, bottom = 0;  ///< rows
};

Box clipped(Box box, const RectifiedWall& wall);
int blocksOf(const Box& box);

/// The columns of metres.
int columns(double metres);

/// Known offsets in a box, one a block; of it what the wall has.
std::vector<float> offsetsIn(const RectifiedWall& wall, const Box& unclipped);

/// Where the surface lies in one column of blocks: median.
struct ProfilePoint {
  double x = 0.0;  ///< of the surface itself, not of where it appears on the wall
  double y = 0.0;
};
std::vector<ProfilePoint> profileOf(const RectifiedWall& wall, const Box& box);

/// How much more of a profile lies in a plane that is turned out of the wall's direction, as an ajar leaf or the side
/// of a deep opening is, than in one along the wall. Beside a closed leaf one may see the reveal: the mean slope would
/// not tell.
double tiltedShare(const std::vector<ProfilePoint>& profile, double tolerance);

struct Color {
  double r = 0.0, g = 0.0, b = 0.0;
};
double difference(const Color& a, const Color& b);

/// Colours of visible pixels of a box, every `step`th.
std::vector<cv::Vec3b> colorsIn(const RectifiedWall& wall, const Box& unclipped, int step);

/// None of fewer than `least`.
std::optional<Color> medianColor(const std::vector<cv::Vec3b>& colors, std::size_t least);
double shareLike(const std::vector<cv::Vec3b>& colors, const Color& color);

}  // namespace prodomos::perception

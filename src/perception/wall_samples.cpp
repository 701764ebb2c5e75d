// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/wall_samples.hpp"

#include "perception/numeric.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace prodomos::perception {

Box clipped(Box box, const RectifiedWall& wall) {
  box.first = std::clamp(box.first, 0, wall.width());
  box.last = std::clamp(box.last, 0, wall.width());
  box.top = std::clamp(box.top, 0, wall.height());
  box.bottom = std::clamp(box.bottom, 0, wall.height());
  return box;
}

int columns(double metres) {
  return static_cast<int>(std::lround(metres / RectifiedWall::kPixel));
}

int blocksOf(const Box& box) {
  return (box.last - box.first) * (box.bottom - box.top) / (RectifiedWall::kBlock * RectifiedWall::kBlock);
}

std::vector<float> offsetsIn(const RectifiedWall& wall, const Box& unclipped) {
  std::vector<float> offsets;
  const Box box = clipped(unclipped, wall);
  for (int row = box.top; row < box.bottom; row += RectifiedWall::kBlock) {
    for (int column = box.first; column < box.last; column += RectifiedWall::kBlock) {
      const float offset = wall.offset(column, row);
      if (!std::isnan(offset)) offsets.push_back(offset);
    }
  }
  return offsets;
}

std::vector<ProfilePoint> profileOf(const RectifiedWall& wall, const Box& box) {
  constexpr std::size_t kEnough = 4;  // blocks
  std::vector<ProfilePoint> profile;
  for (int column = box.first; column < box.last; column += RectifiedWall::kBlock) {
    auto offsets = offsetsIn(wall, {column, column + 1, box.top, box.bottom});
    if (offsets.size() < kEnough) continue;
    const double y = median(offsets);
    profile.push_back({wall.xOf(column) / wall.shrinkage(y), y});
  }
  return profile;
}

double tiltedShare(const std::vector<ProfilePoint>& profile, double tolerance) {
  constexpr std::size_t kEnough = 5;
  constexpr double kLeastSlope = 0.12;  // 7°
  if (profile.size() < kEnough) return 0.0;
  const auto countOn = [&](const ProfilePoint& point, double along, double across) {
    const double length = std::hypot(along, across);
    return std::ranges::count_if(profile, [&](const ProfilePoint& other) {
      return std::abs(along * (other.y - point.y) - across * (other.x - point.x)) < tolerance * length;
    });
  };
  std::ptrdiff_t parallel = 0;
  std::ptrdiff_t tilted = 0;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    parallel = std::max(parallel, countOn(profile[i], 1.0, 0.0));
    for (std::size_t j = i + 2; j < profile.size(); ++j) {
      const double along = profile[j].x - profile[i].x;
      const double across = profile[j].y - profile[i].y;
      if (std::abs(across) < kLeastSlope * std::abs(along) || std::abs(across) < 2.0 * tolerance) continue;
      tilted = std::max(tilted, countOn(profile[i], along, across));
    }
  }
  return std::max(0.0, static_cast<double>(tilted - parallel) / static_cast<double>(profile.size()));
}

double difference(const Color& a, const Color& b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

std::vector<cv::Vec3b> colorsIn(const RectifiedWall& wall, const Box& unclipped, int step) {
  std::vector<cv::Vec3b> colors;
  const Box box = clipped(unclipped, wall);
  for (int row = box.top; row < box.bottom; row += step) {
    const auto* pixel = wall.color().ptr<cv::Vec3b>(row);
    for (int column = box.first; column < box.last; column += step) {
      if (isVisible(wall.seen(column, row))) colors.push_back(pixel[column]);
    }
  }
  return colors;
}

std::optional<Color> medianColor(const std::vector<cv::Vec3b>& colors, std::size_t least) {
  if (colors.size() < least) return std::nullopt;
  std::array<double, 3> medians{};
  std::vector<float> channel(colors.size());
  for (int i = 0; i < 3; ++i) {
    std::ranges::transform(colors, channel.begin(),
                           [i](const cv::Vec3b& color) { return static_cast<float>(color[i]); });
    medians[static_cast<std::size_t>(i)] = median(channel);
  }
  return Color{medians[0], medians[1], medians[2]};
}

double shareLike(const std::vector<cv::Vec3b>& colors, const Color& color) {
  constexpr double kAlike = 26.0;
  if (colors.empty()) return 0.0;
  const auto alike = std::ranges::count_if(colors, [&](const cv::Vec3b& pixel) {
    return difference({static_cast<double>(pixel[0]), static_cast<double>(pixel[1]), static_cast<double>(pixel[2])},
                      color) < kAlike;
  });
  return static_cast<double>(alike) / static_cast<double>(colors.size());
}

}  // namespace prodomos::perception

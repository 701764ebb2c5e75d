// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/door_points.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace prodomos::perception {

namespace {

// 002 gives no figures: usual ones.
constexpr double kNearGround = 0.2;   // metres
constexpr double kLeastHeight = 1.8;  // of a door
constexpr double kMostHeight = 2.25;
constexpr double kLeastWidth = 0.7;
constexpr double kMostWidth = 1.1;
constexpr double kUsualWidth = 0.9;
constexpr double kAligned = 0.04;  // metres, of two points one above the other

/// Upright lines through a point of each group.
std::vector<UprightLine> alignedPairs(const PointGroups& groups) {
  std::vector<UprightLine> lines;
  for (const auto& low : groups.bottom) {
    for (const auto& high : groups.top) {
      const auto aside = static_cast<double>(low.x - high.x);
      if (std::abs(aside) > kAligned / RectifiedWall::kPixel) continue;
      UprightLine line;
      line.top = static_cast<int>(high.y);
      line.bottom = static_cast<int>(low.y);
      line.middleRow = 0.5 * (line.top + line.bottom);
      line.column = 0.5 * static_cast<double>(low.x + high.x);
      line.slope = aside / (line.bottom - line.top);
      lines.push_back(line);
    }
  }
  std::ranges::stable_sort(lines, {}, &UprightLine::column);
  return lines;
}

}  // namespace

std::vector<cv::Point2f> salientPoints(const RectifiedWall& wall) {
  constexpr int kMost = 400;
  constexpr double kQuality = 0.01;
  constexpr double kApart = 4.0;  // pixels
  cv::Mat gray;
  cv::cvtColor(wall.color(), gray, cv::COLOR_RGB2GRAY);
  cv::Mat visible(gray.size(), CV_8U, cv::Scalar(0));
  for (int row = 0; row < visible.rows; ++row) {
    for (int column = 0; column < visible.cols; ++column) {
      const Seen seen = wall.seen(column, row);
      if (seen == Seen::kWall || seen == Seen::kColor) visible.at<std::uint8_t>(row, column) = 255;
    }
  }
  std::vector<cv::Point2f> points;
  cv::goodFeaturesToTrack(gray, points, kMost, kQuality, kApart, visible);  // 002 [14]
  return points;
}

PointGroups groupsOf(const RectifiedWall& wall, const std::vector<cv::Point2f>& points) {
  PointGroups groups;
  for (const auto& point : points) {
    const double z = wall.zOf(static_cast<double>(point.y));
    if (z < kNearGround) groups.bottom.push_back(point);
    if (z > kLeastHeight && z < kMostHeight) groups.top.push_back(point);
  }
  return groups;
}

std::vector<DoorCandidate> pairPoints(const RectifiedWall& wall, const PointGroups& groups) {
  const auto lines = alignedPairs(groups);
  std::vector<DoorCandidate> all;
  for (const auto& left : lines) {
    for (const auto& right : lines) {
      const double width = (right.column - left.column) * RectifiedWall::kPixel;
      if (width < kLeastWidth || width > kMostWidth) continue;
      DoorCandidate candidate;
      candidate.leftLine = left;
      candidate.rightLine = right;
      candidate.left_x = wall.xOf(left.column);
      candidate.right_x = wall.xOf(right.column);
      candidate.top_z = wall.zOf(0.5 * (left.top + right.top));
      candidate.bottomIsSeen = true;
      all.push_back(candidate);
    }
  }
  std::ranges::stable_sort(all, {}, [](const DoorCandidate& door) { return std::abs(door.width() - kUsualWidth); });
  std::vector<DoorCandidate> kept;
  for (const auto& candidate : all) {
    const auto overlaps = [&](const DoorCandidate& other) {
      return candidate.left_x < other.right_x && other.left_x < candidate.right_x;
    };
    if (std::ranges::none_of(kept, overlaps)) kept.push_back(candidate);
  }
  return kept;
}

Handle countPoints(const RectifiedWall& wall, const DoorCandidate& candidate, const std::vector<cv::Point2f>& points) {
  Handle handle;
  for (const auto& point : points) {
    const double x = wall.xOf(static_cast<double>(point.x));
    const double z = wall.zOf(static_cast<double>(point.y));
    if (z < Handle::kLowest || z > Handle::kHighest) continue;
    const auto isBeside = [](double distance) {
      return distance > Handle::kNearJamb && distance < Handle::kFarFromJamb;
    };
    handle.left += isBeside(x - candidate.left_x) ? 1.0 : 0.0;
    handle.right += isBeside(candidate.right_x - x) ? 1.0 : 0.0;
  }
  return handle;
}

}  // namespace prodomos::perception

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/door_handle.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace prodomos::perception {

namespace {

int columnAt(const RectifiedWall& wall, double x) {
  return static_cast<int>(std::lround(wall.columnOf(x)));
}

double greatest(const cv::Mat& corners, int first, int last) {
  first = std::clamp(first, 0, corners.cols);
  last = std::clamp(last, 0, corners.cols);
  if (last - first < 2) return 0.0;
  double most = 0.0;
  cv::minMaxLoc(corners.colRange(first, last), nullptr, &most);
  return most;
}

}  // namespace

Handle findHandle(const RectifiedWall& wall, double left, double right, double offset) {
  Handle handle;
  const double shrinkage = wall.shrinkage(offset);
  const double height = wall.wall().cameraHeight;
  const auto row = [&](double z) {
    return std::clamp(static_cast<int>(std::lround(wall.rowOf(height + (z - height) * shrinkage))), 0, wall.height());
  };
  const int first = std::max(0, columnAt(wall, left * shrinkage));
  const int last = std::min(wall.width(), columnAt(wall, right * shrinkage));
  const int top = row(Handle::kHighest);
  const int bottom = row(Handle::kLowest);
  if (last - first < 12 || bottom - top < 12) return handle;
  cv::Mat gray;
  cv::cvtColor(wall.color()(cv::Range(top, bottom), cv::Range(first, last)), gray, cv::COLOR_RGB2GRAY);
  cv::Mat corners;
  cv::cornerMinEigenVal(gray, corners, 3);
  for (int i = 0; i < corners.rows; ++i) {
    for (int j = 0; j < corners.cols; ++j) {
      if (wall.seen(first + j, top + i) == Seen::kNothing) corners.at<float>(i, j) = 0.0F;
    }
  }
  const auto columns = [](double metres) { return static_cast<int>(std::lround(metres / RectifiedWall::kPixel)); };
  const int near = columns(Handle::kNearJamb);
  const int far = columns(Handle::kFarFromJamb);
  handle.left = greatest(corners, near, far);
  handle.right = greatest(corners, corners.cols - far, corners.cols - near);
  const int middle = corners.cols / 2;
  handle.middle = greatest(corners, middle - far, middle + far);
  handle.leaf = cv::mean(corners)[0];
  return handle;
}

}  // namespace prodomos::perception

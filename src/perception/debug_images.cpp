// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/debug_images.hpp"

#include "prodomos/base/error.hpp"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cstdio>

namespace prodomos::perception {

DebugImages::DebugImages(std::filesystem::path folder, int every)
    : folder_(std::move(folder)), every_(std::max(1, every)) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw base::FileError(folder_.string() + ": cannot be made: " + error.message());
}

void DebugImages::add(const std::string& name, const sensors::Image<sensors::Rgb>& picture) {
  if (!isWanted() || picture.empty()) return;
  std::array<char, 16> number{};
  std::snprintf(number.data(), number.size(), "%06d_", frame_);
  const auto path = folder_ / (number.data() + name + ".png");
  // Pixels are only read.
  const cv::Mat rgb(picture.height(), picture.width(), CV_8UC3, const_cast<sensors::Rgb*>(picture.row(0)));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  bool written = false;
  try {
    written = cv::imwrite(path.string(), bgr);
  } catch (const cv::Exception&) {
    written = false;
  }
  if (!written) throw base::FileError(path.string() + ": cannot be written");
}

}  // namespace prodomos::perception

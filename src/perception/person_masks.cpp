// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/person_masks.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <map>

namespace prodomos::perception {

namespace {

constexpr int kLeastPixels = 150;

/// Each pixel's person, counted from 1; 0: none.
cv::Mat numbered(const sensors::LabelImage& labels, int personClass) {
  const auto& classes = labels.classes;
  const auto& instances = labels.instances;
  const bool hasInstances = instances.width() == classes.width() && instances.height() == classes.height();
  cv::Mat numbers(classes.height(), classes.width(), CV_16U, cv::Scalar(0));
  for (int y = 0; y < classes.height(); ++y) {
    for (int x = 0; x < classes.width(); ++x) {
      if (classes(x, y) != personClass) continue;
      numbers.at<std::uint16_t>(y, x) = hasInstances ? instances(x, y) : std::uint16_t{1};
    }
  }
  if (hasInstances) return numbers;
  cv::Mat regions;
  cv::connectedComponents(numbers > 0, regions, 8, CV_16U);
  return regions;
}

}  // namespace

std::vector<PersonMask> personMasks(const UprightView& view, const sensors::LabelImage& labels,
                                    const sensors::ClassTable& classes) {
  const auto person = std::ranges::find(classes, "person", [](const auto& entry) { return entry.second; });
  if (person == classes.end() || labels.classes.empty()) return {};
  if (labels.classes.width() != view.frameSize().width || labels.classes.height() != view.frameSize().height) return {};
  const cv::Mat numbers = view.turned(numbered(labels, person->first));
  std::map<int, cv::Rect> boxes;
  for (int y = 0; y < numbers.rows; ++y) {
    for (int x = 0; x < numbers.cols; ++x) {
      if (const int number = numbers.at<std::uint16_t>(y, x); number > 0) boxes[number] |= cv::Rect(x, y, 1, 1);
    }
  }
  std::vector<PersonMask> masks;
  for (const auto& [number, box] : boxes) {
    const cv::Mat mask = numbers == number;
    if (cv::countNonZero(mask) >= kLeastPixels) masks.push_back({mask, box});
  }
  return masks;
}

}  // namespace prodomos::perception

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/person_sighting.hpp"

#include <opencv2/core.hpp>
#include <opencv2/dnn.hpp>

#include <array>
#include <filesystem>
#include <vector>

/// Networks that find people in photographs. Pictures are 8-bit BGR, heads up.
namespace prodomos::perception {

struct PersonBox {
  cv::Rect2d box;  ///< pixels; may reach beyond the picture
  double score = 0.0;
};

/// Intersection over union.
double overlap(const cv::Rect2d& a, const cv::Rect2d& b);

struct ImageJoint {
  cv::Point2d pixel;
  double score = 0.0;  ///< 0: not seen
};
/// Joints with lower scores are not seen.
inline constexpr double kLeastJointScore = 0.1;
using ImageJoints = std::array<ImageJoint, kJointCount>;

/// yolo-fastest-1.1, once trained on persons alone and once on 80 classes: what one misses the other often finds.
class PersonBoxes {
 public:
  /// Throws base::FileError naming the file that is missing or not a network.
  explicit PersonBoxes(const std::filesystem::path& folder);

  std::vector<PersonBox> byBody(const cv::Mat& picture) { return detect(body_, picture); }
  std::vector<PersonBox> byClass(const cv::Mat& picture) { return detect(classes_, picture); }

 private:
  static std::vector<PersonBox> detect(cv::dnn::Net& net, const cv::Mat& picture);

  cv::dnn::Net body_;
  cv::dnn::Net classes_;
};

/// hourglass_pose14: the joints of the person in a box.
class JointFinder {
 public:
  /// Throws base::FileError naming the file that is missing or not a network.
  explicit JointFinder(const std::filesystem::path& folder);

  ImageJoints find(const cv::Mat& picture, const cv::Rect2d& box);

 private:
  cv::dnn::Net net_;
};

/// Greatest scores first; of boxes that share more than `most` (IoU), the best alone.
std::vector<PersonBox> withoutDoubles(std::vector<PersonBox> boxes, double most);

}  // namespace prodomos::perception

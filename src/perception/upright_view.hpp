// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/rgbd_view.hpp"
#include "prodomos/sensors/camera.hpp"

#include <opencv2/core.hpp>

#include <optional>

namespace prodomos::perception {

/// A frame as networks want it: heads up. Turned against gravity where the camera is rolled by more than they bear.
class UprightView {
 public:
  /// None without usable depth, intrinsics or pose.
  static std::optional<UprightView> of(const RgbdView& view);

  const cv::Mat& picture() const { return picture_; }  ///< 8-bit BGR; empty: the frame has no colour
  cv::Size size() const { return size_; }
  cv::Size frameSize() const { return {camera_.width(), camera_.height()}; }
  /// Metres; 0: not known. `pixel` is one of the picture.
  double depthAt(cv::Point pixel) const;
  /// What is seen at a pixel, if at that depth.
  Eigen::Vector3d pointAt(const cv::Point2d& pixel, double depth) const;
  /// An image of the frame's size, turned as the picture is; each pixel as it was.
  cv::Mat turned(const cv::Mat& image) const;
  /// The picture's pixel for one of the frame.
  cv::Point2d fromFrame(const cv::Point2d& pixel) const;
  /// Of the point's pixel, however far outside of the picture; the point lies before the camera.
  cv::Point2d pixelOf(const Eigen::Vector3d& point_in_submap) const;

  const Eigen::Vector3d& camera_in_submap() const { return camera_in_submap_; }

 private:
  UprightView() = default;
  void turn();

  sensors::Camera camera_;
  geometry::Pose3 T_submap_camera_;
  Eigen::Vector3d camera_in_submap_;
  cv::Matx23d toFrame_{1.0, 0.0, 0.0, 0.0, 1.0, 0.0};
  cv::Matx23d fromFrame_{1.0, 0.0, 0.0, 0.0, 1.0, 0.0};
  cv::Size size_;  ///< of the picture
  bool isTurned_ = false;
  cv::Mat picture_;
  cv::Mat depth_;
};

}  // namespace prodomos::perception

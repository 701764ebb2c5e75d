// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/upright_view.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace prodomos::perception {

namespace {

constexpr double kBornRoll = 20.0 * std::numbers::pi / 180.0;
/// A camera that looks up or down by more than 66 degrees has no roll to speak of.
constexpr double kLeastAcross = 0.4;

bool isUsable(const RgbdView& view) {
  const auto& [width, height] = std::pair(view.frame.depth.width(), view.frame.depth.height());
  const auto& color = view.frame.color;
  const bool fits = color.empty() || (color.width() == width && color.height() == height);
  return hasPoints(view) && fits;
}

cv::Point2d operator*(const cv::Matx23d& map, const cv::Point2d& p) {
  return {map(0, 0) * p.x + map(0, 1) * p.y + map(0, 2), map(1, 0) * p.x + map(1, 1) * p.y + map(1, 2)};
}

/// Turns a picture of that size so that `down` points down in it, and moves it so that all of it is seen.
cv::Matx23d turnedDown(const Eigen::Vector2d& down, cv::Size& size) {
  const Eigen::Vector2d d = down.normalized();
  cv::Matx23d turn(d.y(), -d.x(), 0.0, d.x(), d.y(), 0.0);
  const double width = size.width;
  const double height = size.height;
  const std::array<cv::Point2d, 4> corners{cv::Point2d(0.0, 0.0), {width, 0.0}, {0.0, height}, {width, height}};
  cv::Point2d least(corners[0]);
  cv::Point2d most(corners[0]);
  for (const auto& corner : corners) {
    const cv::Point2d p = turn * corner;
    least = {std::min(least.x, p.x), std::min(least.y, p.y)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y)};
  }
  turn(0, 2) = -least.x;
  turn(1, 2) = -least.y;
  size = {static_cast<int>(std::ceil(most.x - least.x)), static_cast<int>(std::ceil(most.y - least.y))};
  return turn;
}

}  // namespace

std::optional<UprightView> UprightView::of(const RgbdView& view) {
  if (!isUsable(view)) return std::nullopt;
  UprightView upright;
  const auto& depth = view.frame.depth;
  const auto& color = view.frame.color;
  upright.camera_ = sensors::Camera(view.frame.camera, depth.width(), depth.height());
  upright.T_submap_camera_ = view.T_submap_camera;
  upright.camera_in_submap_ = view.T_submap_camera.translation();
  upright.size_ = {depth.width(), depth.height()};
  upright.turn();
  // Pixels are only read.
  upright.depth_ = upright.turned(cv::Mat(depth.height(), depth.width(), CV_32F, const_cast<float*>(depth.data())));
  if (color.empty()) return upright;
  const cv::Mat rgb(color.height(), color.width(), CV_8UC3, const_cast<sensors::Rgb*>(color.data()));
  cv::cvtColor(rgb, upright.picture_, cv::COLOR_RGB2BGR);
  if (!upright.isTurned_) return upright;
  cv::Mat picture;
  cv::warpAffine(upright.picture_, picture, upright.fromFrame_, upright.size_, cv::INTER_LINEAR, cv::BORDER_CONSTANT,
                 cv::Scalar::all(127));
  upright.picture_ = picture;
  return upright;
}

void UprightView::turn() {
  const Eigen::Vector2d down = -(T_submap_camera_.linear().transpose() * Eigen::Vector3d::UnitZ()).head<2>();
  if (down.norm() < kLeastAcross || std::abs(std::atan2(down.x(), down.y())) <= kBornRoll) return;
  isTurned_ = true;
  fromFrame_ = turnedDown(down, size_);
  cv::invertAffineTransform(fromFrame_, toFrame_);
}

cv::Mat UprightView::turned(const cv::Mat& image) const {
  if (!isTurned_) return image;
  cv::Mat result;
  cv::warpAffine(image, result, fromFrame_, size_, cv::INTER_NEAREST);
  return result;
}

double UprightView::depthAt(cv::Point pixel) const {
  if (pixel.x < 0 || pixel.x >= depth_.cols || pixel.y < 0 || pixel.y >= depth_.rows) return 0.0;
  const float depth = depth_.at<float>(pixel);
  return std::isfinite(depth) && depth > 0.0F ? double{depth} : 0.0;
}

Eigen::Vector3d UprightView::pointAt(const cv::Point2d& pixel, double depth) const {
  const cv::Point2d p = toFrame_ * pixel;
  const Eigen::Vector2d ray = camera_.ray({p.x, p.y});
  return T_submap_camera_ * Eigen::Vector3d(ray.x() * depth, ray.y() * depth, depth);
}

cv::Point2d UprightView::fromFrame(const cv::Point2d& pixel) const {
  return fromFrame_ * pixel;
}

cv::Point2d UprightView::pixelOf(const Eigen::Vector3d& point_in_submap) const {
  const Eigen::Vector3d p = T_submap_camera_.inverse() * point_in_submap;
  const Eigen::Vector2d pixel = camera_.pixel({p.x() / p.z(), p.y() / p.z()});
  return fromFrame({pixel.x(), pixel.y()});
}

}  // namespace prodomos::perception

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/staircase_drawing.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string>

namespace prodomos::perception {

namespace {

using geometry::Pose3;

const cv::Scalar kSteps(255, 220, 0);
const cv::Scalar kFoot(0, 255, 120);
const cv::Scalar kUphill(255, 60, 60);

/// The colour image, else depth in grey.
cv::Mat backgroundOf(const RgbdView& view) {
  const auto& color = view.frame.color;
  const auto& depth = view.frame.depth;
  if (!color.empty() && color.width() == depth.width() && color.height() == depth.height()) {
    cv::Mat picture(color.height(), color.width(), CV_8UC3);
    std::ranges::copy(color.pixels(), picture.ptr<sensors::Rgb>());
    return picture;
  }
  cv::Mat picture(depth.height(), depth.width(), CV_8UC3);
  std::ranges::transform(depth.pixels(), picture.ptr<sensors::Rgb>(), [](float metres) {
    const auto grey =
        static_cast<std::uint8_t>(metres > 0.0F ? std::clamp(255.0F - 45.0F * metres, 30.0F, 255.0F) : 0.0F);
    return sensors::Rgb{grey, grey, grey};
  });
  return picture;
}

void tint(cv::Mat& picture, const Surfaces& surfaces) {
  constexpr int kBlock = sensors::DepthGrid::kBlock;
  constexpr std::array<std::array<int, 3>, 8> kTints{{{230, 90, 80},
                                                      {80, 160, 230},
                                                      {120, 210, 90},
                                                      {230, 190, 60},
                                                      {170, 110, 220},
                                                      {70, 210, 200},
                                                      {240, 130, 190},
                                                      {150, 150, 90}}};
  for (std::size_t i = 0; i < surfaces.patches.size(); ++i) {
    const auto& [r, g, b] = kTints[i % kTints.size()];
    for (const std::uint32_t cell : surfaces.patches[i].cells) {
      const int x = static_cast<int>(cell) % surfaces.depth.width();
      const int y = static_cast<int>(cell) / surfaces.depth.width();
      cv::Mat block = picture(cv::Rect(x * kBlock, y * kBlock, kBlock, kBlock));
      block = 0.65 * block + 0.35 * cv::Scalar(r, g, b);
    }
  }
}

/// Draws lines between points of the sub-map.
class Pen {
 public:
  Pen(cv::Mat& picture, const RgbdView& view)
      : picture_(picture),
        camera_(view.frame.camera, picture.cols, picture.rows),
        T_camera_submap_(view.T_submap_camera.inverse()) {}

  void line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const cv::Scalar& color, int thickness) {
    const auto a = pixel(from);
    const auto b = pixel(to);
    if (a && b) cv::line(picture_, *a, *b, color, thickness, cv::LINE_AA);
  }

 private:
  std::optional<cv::Point> pixel(const Eigen::Vector3d& point_in_submap) const {
    const Eigen::Vector3d point = T_camera_submap_ * point_in_submap;
    if (!(point.z() > 0.1)) return std::nullopt;
    const Eigen::Vector2d pixel = camera_.pixel(point.head<2>() / point.z());
    if (!(pixel.cwiseAbs().maxCoeff() < 10000.0)) return std::nullopt;
    return cv::Point(cvRound(pixel.x()), cvRound(pixel.y()));
  }

  cv::Mat& picture_;
  sensors::Camera camera_;
  Pose3 T_camera_submap_;
};

void draw(Pen& pen, const StaircaseSighting& flight) {
  const Pose3& T_submap_stairs = flight.T_submap_stairs;
  const auto at = [&](double along, double across, double z) {
    Eigen::Vector3d point = T_submap_stairs * Eigen::Vector3d(along, across, 0.0);
    point.z() = z;
    return point;
  };
  const double half = 0.5 * flight.width;
  for (const Step& step : flight.steps)
    pen.line(at(step.along, half, step.z), at(step.along, -half, step.z), kSteps, 1);
  const double foot_z = T_submap_stairs.translation().z();
  pen.line(at(0.0, half, foot_z), at(0.0, -half, foot_z), kFoot, flight.footIsSeen ? 3 : 1);
  const Step& top = flight.steps.back();
  pen.line(at(0.0, 0.0, foot_z), at(top.along, 0.0, top.z), kUphill, 2);
}

std::string describe(const StaircaseSighting& flight) {
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "%zu steps, %.2f m wide, to %.2f m, log-odds %.1f", flight.steps.size(),
                flight.width, flight.newFloor_z, flight.evidence);
  return text.data();
}

}  // namespace

sensors::Image<sensors::Rgb> drawStaircases(const RgbdView& view, const Surfaces& surfaces,
                                            const std::vector<StaircaseSighting>& flights) {
  cv::Mat picture = backgroundOf(view);
  tint(picture, surfaces);
  Pen pen(picture, view);
  int line = 0;
  for (const StaircaseSighting& flight : flights) {
    draw(pen, flight);
    cv::putText(picture, describe(flight), {8, 22 * ++line}, cv::FONT_HERSHEY_SIMPLEX, 0.6, kUphill, 1, cv::LINE_AA);
  }
  sensors::Image<sensors::Rgb> image(picture.cols, picture.rows);
  std::copy_n(picture.ptr<sensors::Rgb>(), image.size(), image.data());
  return image;
}

}  // namespace prodomos::perception

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/open_door_picture.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace prodomos::perception::open_doors {

namespace {

constexpr double kScale = 80.0;  // pixels a metre
constexpr double kTop = 2.7;     // metres above the floor
constexpr double kBefore = 1.2;  // metres drawn of what is seen from above
constexpr double kBehind = 1.6;
constexpr int kStripRows = 10;

int pixels(double metres) {
  return static_cast<int>(std::lround(metres * kScale));
}

cv::Scalar colorOf(const std::optional<double>& depth, double tolerance) {
  if (!depth) return {20, 20, 20};
  if (std::isnan(*depth)) return {70, 50, 70};
  if (std::abs(*depth) <= tolerance) return {170, 170, 170};
  if (*depth < 0.0) return {200, 60, 40};
  const double far = std::min(1.0, *depth / 2.0);
  return {30, 80 + 150 * far, 220 - 150 * far};
}

cv::Scalar colorOf(Strip strip) {
  switch (strip) {
    case Strip::kWall:
      return {170, 170, 170};
    case Strip::kOpen:
      return {40, 200, 90};
    case Strip::kHidden:
      return {200, 60, 40};
    case Strip::kUnknown:
      break;
  }
  return {70, 50, 70};
}

class Drawing {
 public:
  explicit Drawing(const WallProfile& profile)
      : profile_(profile),
        image_(pixels(profile.count() * WallProfile::kStep) + 1, pixels(kTop + kBefore + kBehind) + kStripRows),
        picture_(image_.height(), image_.width(), CV_8UC3, image_.data()) {}

  void drawWall() {
    for (int column = 0; column < profile_.count(); ++column) {
      const double x = profile_.xOf(column);
      const int left = pixelX(x - 0.5 * WallProfile::kStep);
      const int width = pixels(WallProfile::kStep);
      for (double z = 0.05; z < kTop; z += 0.05) {
        const auto color = colorOf(profile_.depthBehind(x, z), profile_.toleranceAt(x, z));
        cv::rectangle(picture_, cv::Rect(left, pixels(kTop - z), width, pixels(0.05)), color, cv::FILLED);
      }
      cv::rectangle(picture_, cv::Rect(left, pixels(kTop), width, kStripRows), colorOf(profile_.strip(column)),
                    cv::FILLED);
    }
  }

  void drawFromAbove(const std::vector<Spot>& spots) {
    for (const auto& spot : spots) {
      const cv::Point point(pixelX(spot.point_in_wall.x()), pixelY(spot.point_in_wall.y()));
      const cv::Rect frame(0, pixels(kTop) + kStripRows, picture_.cols, picture_.rows);
      if (frame.contains(point) && point.y < picture_.rows) picture_.at<cv::Vec3b>(point) = {230, 230, 230};
    }
  }

  void drawGap(const DrawnGap& gap) {
    const cv::Scalar color = gap.accepted ? cv::Scalar(60, 230, 60) : cv::Scalar(250, 160, 30);
    const double left = profile_.xOf(gap.gap.left);
    const double right = profile_.xOf(gap.gap.right);
    cv::rectangle(picture_, cv::Point(pixelX(left), pixels(kTop - 2.0)), cv::Point(pixelX(right), pixels(kTop)), color);
    cv::line(picture_, {pixelX(left), pixelY(0.0)}, {pixelX(right), pixelY(0.0)}, color);
    if (gap.leftLeaf) drawLeaf({left, 1.0, gap.leafWidth}, gap.leftLeaf->y, gap.leftLeaf->angle);
    if (gap.rightLeaf) drawLeaf({right, -1.0, gap.leafWidth}, gap.rightLeaf->y, gap.rightLeaf->angle);
  }

  void drawLeaf(const Hinge& hinge, double y, double angle) {
    const double endX = hinge.x + hinge.closing * hinge.leafWidth * std::cos(angle);
    const double endY = y + hinge.leafWidth * std::sin(angle);
    cv::line(picture_, {pixelX(hinge.x), pixelY(y)}, {pixelX(endX), pixelY(endY)}, {255, 80, 220}, 2);
  }

  const sensors::Image<sensors::Rgb>& image() const { return image_; }

 private:
  int pixelX(double x) const { return pixels(x - profile_.xOf(0)); }
  int pixelY(double y) const { return pixels(kTop + kBehind - y) + kStripRows; }

  const WallProfile& profile_;
  sensors::Image<sensors::Rgb> image_;
  cv::Mat picture_;
};

}  // namespace

sensors::Image<sensors::Rgb> drawProfile(const WallProfile& profile, const std::vector<Spot>& spots,
                                         const std::vector<DrawnGap>& gaps, const std::vector<SwungLeaf>& swung) {
  Drawing drawing(profile);
  drawing.drawWall();
  drawing.drawFromAbove(spots);
  for (const auto& gap : gaps) drawing.drawGap(gap);
  for (const auto& leaf : swung) drawing.drawLeaf(leaf.hinge, 0.0, -leaf.angle);
  return drawing.image();
}

}  // namespace prodomos::perception::open_doors

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/door_picture.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace prodomos::perception {

namespace {

constexpr int kZoom = 3;
constexpr int kBar = 60;  // pixels, of the legend above the wall
constexpr int kLeastWidth = 760;

// Red, green, blue.
const cv::Scalar kPaper(250, 250, 246);
const cv::Scalar kInk(40, 40, 44);
const cv::Scalar kPoint(255, 214, 10);
const cv::Scalar kGround(255, 120, 0);
const cv::Scalar kHigh(20, 200, 255);
const cv::Scalar kLine(230, 60, 230);
const cv::Scalar kAccepted(20, 190, 60);
const cv::Scalar kRejected(220, 50, 40);

void write(cv::Mat& picture, const std::string& text, cv::Point at, const cv::Scalar& color, double size = 0.5) {
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, size, kPaper, 4, cv::LINE_AA);
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, size, color, 1, cv::LINE_AA);
}

class Drawing {
 public:
  explicit Drawing(const RectifiedWall& wall) : wall_(wall) {
    cv::Mat zoomed;
    cv::resize(wall.color(), zoomed, {}, kZoom, kZoom, cv::INTER_LINEAR);
    for (int row = 0; row < wall.height(); row += RectifiedWall::kBlock) {
      for (int column = 0; column < wall.width(); column += RectifiedWall::kBlock) {
        const Seen seen = wall.seen(column, row);
        if (seen == Seen::kWall || seen == Seen::kColor) continue;
        constexpr int kSide = kZoom * RectifiedWall::kBlock;
        cv::Mat block = zoomed(cv::Rect(column * kZoom, row * kZoom, kSide, kSide));
        if (seen == Seen::kNothing) {
          block = kPaper;
        } else {
          block = 0.35 * block + 0.65 * cv::Scalar(150, 150, 156);
        }
      }
    }
    picture_ = cv::Mat(zoomed.rows + kBar, std::max(zoomed.cols, kLeastWidth), CV_8UC3, kPaper);
    zoomed.copyTo(picture_(cv::Rect(0, kBar, zoomed.cols, zoomed.rows)));
  }

  void title() {
    const Wall& wall = wall_.wall();
    write(picture_, cv::format("wall at %.2f m, %.1f m long", wall.distance, wall.most_x - wall.least_x), {8, 20},
          kInk);
    int x = 8;
    const auto entry = [&](const char* text, const cv::Scalar& color) {
      cv::rectangle(picture_, cv::Rect(x, 36, 14, 14), color, cv::FILLED);
      cv::putText(picture_, text, {x + 20, 48}, cv::FONT_HERSHEY_SIMPLEX, 0.45, kInk, 1, cv::LINE_AA);
      x += 34 + 8 * static_cast<int>(std::string(text).size());
    };
    entry("salient point", kPoint);
    entry("near the floor", kGround);
    entry("at door height", kHigh);
    entry("line", kLine);
    entry("door", kAccepted);
    entry("rejected", kRejected);
  }

  void points(const std::vector<cv::Point2f>& points, const cv::Scalar& color) {
    for (const auto& point : points) cv::circle(picture_, at(point), 4, color, 2, cv::LINE_AA);
  }

  void line(const UprightLine& line) {
    const auto end = [&](int row) { return at({static_cast<float>(line.columnAt(row)), static_cast<float>(row)}); };
    cv::line(picture_, end(line.top), end(line.bottom), kLine, 1, cv::LINE_AA);
  }

  void pair(const Judged& judged, int place) {
    const DoorCandidate& door = judged.candidate;
    const double shrinkage = wall_.shrinkage(door.leaf_y);
    const double height = wall_.wall().cameraHeight;
    const auto row = [&](double z) { return static_cast<float>(wall_.rowOf(height + (z - height) * shrinkage)); };
    const float top = row(door.top_z > 0.0 ? door.top_z : 2.0);
    const float bottom = row(0.0);
    const auto corner = [&](const UprightLine& line, float r) {
      return at({static_cast<float>(line.columnAt(static_cast<double>(r))), r});
    };
    const std::vector<cv::Point> outline{corner(door.leftLine, top), corner(door.rightLine, top),
                                         corner(door.rightLine, bottom), corner(door.leftLine, bottom)};
    const cv::Scalar& color = judged.accepted ? kAccepted : kRejected;
    cv::polylines(picture_, outline, true, color, judged.accepted ? 3 : 1, cv::LINE_AA);
    const cv::Point text(outline[3].x + 5, outline[0].y + 22 + 20 * place);
    if (judged.accepted) {
      write(picture_, cv::format("door %+.1f", judged.evidence), text, color, 0.6);
      write(picture_, cv::format("%.2f m", door.width()), text + cv::Point(0, 22), color, 0.5);
    } else {
      write(picture_, cv::format("%+.1f ", judged.evidence) + judged.word, text, color, 0.45);
    }
  }

  void handle(const Judged& judged) {
    const DoorCandidate& door = judged.candidate;
    const Handle& handle = door.handle;
    if (!judged.accepted || handle.strongest() <= 0.0) return;
    const double shrinkage = wall_.shrinkage(door.leaf_y);
    double x = 0.5 * (door.left_x + door.right_x);
    constexpr double kFromJamb = 0.1;
    if (door.leaves == 1) x = handle.left > handle.right ? door.left_x + kFromJamb : door.right_x - kFromJamb;
    const cv::Point middle =
        at({static_cast<float>(wall_.columnOf(x * shrinkage)), static_cast<float>(wall_.rowOf(1.02))});
    cv::circle(picture_, middle, 14, kAccepted, 2, cv::LINE_AA);
  }

  sensors::Image<sensors::Rgb> image() const {
    sensors::Image<sensors::Rgb> image(picture_.cols, picture_.rows);
    cv::Mat pixels(picture_.rows, picture_.cols, CV_8UC3, image.data());
    picture_.copyTo(pixels);
    return image;
  }

 private:
  static cv::Point at(const cv::Point2f& pixel) {
    return {static_cast<int>(std::lround(kZoom * (pixel.x + 0.5F))),
            kBar + static_cast<int>(std::lround(kZoom * (pixel.y + 0.5F)))};
  }

  const RectifiedWall& wall_;
  cv::Mat picture_;
};

}  // namespace

sensors::Image<sensors::Rgb> drawVerdict(const RectifiedWall& wall, const std::vector<cv::Point2f>& points,
                                         const std::vector<UprightLine>& lines, const std::vector<Judged>& pairs) {
  constexpr int kMostRejected = 4;
  Drawing drawing(wall);
  drawing.title();
  drawing.points(points, kPoint);
  const PointGroups groups = groupsOf(wall, points);
  drawing.points(groups.bottom, kGround);
  drawing.points(groups.top, kHigh);
  for (const auto& line : lines) drawing.line(line);
  std::vector<Judged> order = pairs;
  std::ranges::stable_sort(order, std::greater{}, &Judged::evidence);
  int rejected = 0;
  for (const auto& judged : order) {
    if (!judged.accepted && rejected < kMostRejected) drawing.pair(judged, rejected++);
  }
  for (const auto& judged : order) {
    if (!judged.accepted) continue;
    drawing.pair(judged, 0);
    drawing.handle(judged);
  }
  return drawing.image();
}

}  // namespace prodomos::perception

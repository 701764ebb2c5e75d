// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/rgbd_view.hpp"
#include "prodomos/perception/surfaces.hpp"

#include <opencv2/core.hpp>

#include <vector>

namespace prodomos::perception {

/// A wall as one view shows it: vertical patches that lie in one plane but for what doors are recessed by. Its frame: x
/// along the wall to the observer's right, y away from the observer, z up; the origin is on the floor, where the
/// camera's foot of the perpendicular falls.
struct Wall {
  geometry::Pose3 T_submap_wall = geometry::Pose3::Identity();
  double distance = 0.0;      ///< of the camera from the plane, metres: it is at (0, -distance, cameraHeight)
  double cameraHeight = 0.0;  ///< over the floor, metres
  double least_x = 0.0;       ///< of what was seen of it, metres
  double most_x = 0.0;
  double area = 0.0;  ///< m²
};

/// Walls by area, the greatest first.
std::vector<Wall> findWalls(const RgbdView& view, const Surfaces& surfaces);

/// What is seen in the direction of a piece of wall.
enum class Seen : std::uint8_t {
  kNothing,  ///< outside of the image
  kColor,    ///< its depth is not known
  kWall,     ///< surface near the wall's plane: wall, frame or leaf
  kHiding,   ///< something stands before it
  kBeyond,   ///< one sees through it: an opening, or the wall has an end
};

/// Whether it is wall, frame or leaf as far as one knows.
inline bool isVisible(Seen seen) {
  return seen == Seen::kWall || seen == Seen::kColor;
}

/// A wall's image as if seen straight on: columns along the wall's x, rows from the top down, square pixels.
class RectifiedWall {
 public:
  static constexpr double kPixel = 0.015;  ///< metres
  static constexpr double kTop = 2.5;      ///< metres above the floor
  static constexpr double kBottom = -0.1;
  static constexpr int kBlock = 4;  ///< pixels; depth is looked up once a block

  /// `reach`: metres from the camera along the floor to which the wall is looked at.
  RectifiedWall(const RgbdView& view, const Surfaces& surfaces, const Wall& wall, double reach);

  const Wall& wall() const { return wall_; }
  int width() const { return color_.cols; }
  int height() const { return color_.rows; }
  bool empty() const { return color_.empty(); }

  double xOf(double column) const { return leastX_ + (column + 0.5) * kPixel; }
  double zOf(double row) const { return kTop - (row + 0.5) * kPixel; }
  double columnOf(double x) const { return (x - leastX_) / kPixel - 0.5; }
  double rowOf(double z) const { return (kTop - z) / kPixel - 0.5; }

  const cv::Mat& color() const { return color_; }  ///< CV_8UC3
  Seen seen(int column, int row) const {
    return static_cast<Seen>(seen_.at<std::uint8_t>(row / kBlock, column / kBlock));
  }
  /// y in the wall's frame of the surface in that direction, metres; NaN where depth is not known.
  float offset(int column, int row) const { return offset_.at<float>(row / kBlock, column / kBlock); }

  /// Points of a plane that lies `offset` metres behind the wall's appear on the wall's as if drawn together towards
  /// the camera's foot by this factor.
  double shrinkage(double offset) const { return wall_.distance / (wall_.distance + offset); }
  /// How far the wall's point is from the camera, and the angle at which it is seen, from the normal.
  double rangeAt(double x) const;
  double obliquenessAt(double x) const;
  /// Metres along the wall that a pixel of the camera's image covers there.
  double footprintAt(double x) const;

 private:
  void chooseSpan(const Surfaces& surfaces, double reach);
  void lookUpDepth(const RgbdView& view, const Surfaces& surfaces);

  Wall wall_;
  geometry::Pose3 T_camera_wall_ = geometry::Pose3::Identity();
  double focalLength_ = 1.0;
  double leastX_ = 0.0;
  cv::Mat color_;
  cv::Mat seen_;
  cv::Mat offset_;
};

}  // namespace prodomos::perception

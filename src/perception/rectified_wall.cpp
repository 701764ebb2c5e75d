// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/rectified_wall.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace prodomos::perception {

using Eigen::Vector3d;

namespace {

/// Before a wall's plane something hides it, behind it one sees through. A leaf hangs at most the thickness of a wall
/// behind it.
constexpr double kHides = 0.2;
constexpr double kDeepestLeaf = 0.35;
constexpr double kSteepestLook = 78.0 * std::numbers::pi / 180.0;

Wall wallOf(const RgbdView& view, const Surfaces& surfaces, const PlanarPatch& patch) {
  // The plane as measured: made upright, it would be wrong by what gravity is known to, and oblique lines would lean.
  const Vector3d away = -patch.plane_in_submap.normal;
  const Vector3d along = away.cross(Vector3d::UnitZ()).normalized();
  const Vector3d camera = view.T_submap_camera.translation();
  Wall wall;
  wall.distance = away.dot(patch.centroid_in_submap - camera);
  wall.T_submap_wall.linear() << along, away, along.cross(away);
  // Down the plane from the camera's foot of the perpendicular to the floor.
  const Vector3d up = along.cross(away);
  wall.T_submap_wall.translation() = camera + wall.distance * away;
  wall.cameraHeight = (wall.T_submap_wall.translation().z() - surfaces.floor_z) / up.z();
  wall.T_submap_wall.translation() -= wall.cameraHeight * up;
  return wall;
}

/// How noise lets a patch's direction and place vary, at its range.
bool belongsTo(const Wall& wall, const PlanarPatch& patch) {
  constexpr double kCosine = 0.985;  // 10°
  const Vector3d centroid = wall.T_submap_wall.inverse() * patch.centroid_in_submap;
  const Vector3d normal = -(wall.T_submap_wall.linear().transpose() * patch.plane_in_submap.normal);
  return normal.y() > kCosine && centroid.y() > -kHides && centroid.y() < kDeepestLeaf;
}

void extend(Wall& wall, const RgbdView& view, const Surfaces& surfaces, const PlanarPatch& patch) {
  const geometry::Pose3 T_wall_camera = wall.T_submap_wall.inverse() * view.T_submap_camera;
  const Vector3d along = T_wall_camera.linear().row(0);
  const auto width = static_cast<std::uint32_t>(surfaces.depth.width());
  for (const std::uint32_t index : patch.cells) {
    const auto& cell = surfaces.depth.at(static_cast<int>(index % width), static_cast<int>(index / width));
    const double x = along.dot(pointOf(cell));
    wall.least_x = std::min(wall.least_x, x);
    wall.most_x = std::max(wall.most_x, x);
  }
  wall.area += patch.area;
}

/// Whether something that moves is seen in the direction of a point, which the image shows.
bool isMover(const RgbdView& view, const sensors::Camera& camera, const Vector3d& point_in_camera) {
  if (view.movers == nullptr || view.movers->empty()) return false;
  const Eigen::Vector2i pixel =
      camera.pixel(point_in_camera.head<2>() / point_in_camera.z()).array().round().cast<int>();
  const bool isInside =
      pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < view.movers->width() && pixel.y() < view.movers->height();
  return isInside && (*view.movers)(pixel.x(), pixel.y()) != 0;
}

}  // namespace

std::vector<Wall> findWalls(const RgbdView& view, const Surfaces& surfaces) {
  constexpr double kUpright = 80.0 * std::numbers::pi / 180.0;
  constexpr double kLeastDistance = 0.2;  // metres; a plane through the camera is seen edge on
  constexpr double kLeastArea = 0.5;      // m²
  constexpr double kLeastLength = 0.5;    // metres
  std::vector<Wall> walls;
  for (const auto& patch : surfaces.patches) {
    if (patch.tilt() < kUpright) continue;
    auto wall = std::ranges::find_if(walls, [&](const Wall& known) { return belongsTo(known, patch); });
    if (wall == walls.end()) {
      Wall found = wallOf(view, surfaces, patch);
      if (found.distance < kLeastDistance) continue;
      found.least_x = std::numeric_limits<double>::infinity();
      found.most_x = -found.least_x;
      wall = walls.insert(walls.end(), found);
    }
    extend(*wall, view, surfaces, patch);
  }
  std::erase_if(walls,
                [](const Wall& wall) { return wall.area < kLeastArea || wall.most_x - wall.least_x < kLeastLength; });
  std::ranges::stable_sort(walls, std::greater{}, &Wall::area);
  return walls;
}

RectifiedWall::RectifiedWall(const RgbdView& view, const Surfaces& surfaces, const Wall& wall, double reach)
    : wall_(wall),
      T_camera_wall_(view.T_submap_camera.inverse() * wall.T_submap_wall),
      focalLength_(surfaces.depth.camera().focalLength()) {
  chooseSpan(surfaces, reach);
  if (!(wall_.most_x - wall_.least_x > 0.3)) return;
  leastX_ = wall_.least_x;
  const int columns = kBlock * static_cast<int>(std::ceil((wall_.most_x - wall_.least_x) / (kPixel * kBlock)));
  const int rows = kBlock * static_cast<int>(std::ceil((kTop - kBottom) / (kPixel * kBlock)));
  const auto& color = view.frame.color;
  const sensors::Camera& camera = surfaces.depth.camera();
  cv::Mat pixels(rows, columns, CV_32FC2);
  const Vector3d along = T_camera_wall_.linear().col(0);
  const Vector3d up = T_camera_wall_.linear().col(2);
  for (int row = 0; row < rows; ++row) {
    auto* pixel = pixels.ptr<cv::Point2f>(row);
    const Vector3d start = T_camera_wall_.translation() + zOf(row) * up;
    for (int column = 0; column < columns; ++column) {
      const Vector3d point = start + xOf(column) * along;
      if (!(point.z() > 0.1)) {
        pixel[column] = {-1e4F, -1e4F};
        continue;
      }
      const Eigen::Vector2f at = camera.pixel(point.head<2>() / point.z()).cast<float>();
      pixel[column] = {at.x(), at.y()};
    }
  }
  // Pixels are only read.
  const cv::Mat image(color.height(), color.width(), CV_8UC3, const_cast<sensors::Rgb*>(color.data()));
  cv::remap(image, color_, pixels, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  seen_ = cv::Mat(rows / kBlock, columns / kBlock, CV_8U, cv::Scalar(0));
  for (int row = 0; row < seen_.rows; ++row) {
    for (int column = 0; column < seen_.cols; ++column) {
      const cv::Point2f at = pixels.at<cv::Point2f>(row * kBlock + kBlock / 2, column * kBlock + kBlock / 2);
      const bool inside = at.x >= 1.0F && at.y >= 1.0F && at.x < static_cast<float>(color.width() - 2) &&
                          at.y < static_cast<float>(color.height() - 2);
      seen_.at<std::uint8_t>(row, column) = static_cast<std::uint8_t>(inside ? Seen::kColor : Seen::kNothing);
    }
  }
  lookUpDepth(view, surfaces);
}

/// From the end of what was seen of the wall some way on: a jamb at its end must be in the picture, and where depth
/// ends for range alone, the wall goes on.
void RectifiedWall::chooseSpan(const Surfaces& surfaces, double reach) {
  constexpr double kBeyondEnd = 0.3;     // metres
  constexpr double kDepthReaches = 3.5;  // metres
  const sensors::Camera& camera = surfaces.depth.camera();
  const double farthest = std::min(std::sqrt(std::max(0.0, reach * reach - wall_.distance * wall_.distance)),
                                   wall_.distance * std::tan(kSteepestLook));
  const auto onward = [&](double x) {
    return std::hypot(x, wall_.distance) > kDepthReaches ? farthest : std::abs(x) + kBeyondEnd;
  };
  const double least = wall_.least_x < 0.0 ? -onward(wall_.least_x) : wall_.least_x - kBeyondEnd;
  const double most = wall_.most_x > 0.0 ? onward(wall_.most_x) : wall_.most_x + kBeyondEnd;
  const double first = std::max(least, -farthest);
  const double last = std::min(most, farthest);
  // Of this, what the image shows at any height.
  constexpr double kStep = 0.05;
  double begin = std::numeric_limits<double>::infinity();
  double end = -begin;
  for (double x = first; x <= last; x += kStep) {
    for (const double z : {0.0, 0.5, 1.0, 1.5, 2.0, 2.4}) {
      const Vector3d point = T_camera_wall_ * Vector3d(x, 0.0, z);
      if (point.z() < 0.1) continue;
      const Eigen::Vector2d pixel = camera.pixel(point.head<2>() / point.z());
      if (pixel.x() < 0.0 || pixel.y() < 0.0 || pixel.x() >= camera.width() || pixel.y() >= camera.height()) continue;
      begin = std::min(begin, x);
      end = std::max(end, x);
      break;
    }
  }
  wall_.least_x = begin;
  wall_.most_x = end;
}

void RectifiedWall::lookUpDepth(const RgbdView& view, const Surfaces& surfaces) {
  const geometry::Pose3 T_wall_camera = wall_.T_submap_wall.inverse() * view.T_submap_camera;
  const Vector3d away = T_wall_camera.linear().row(1);
  offset_ = cv::Mat(seen_.rows, seen_.cols, CV_32F, cv::Scalar(std::numeric_limits<double>::quiet_NaN()));
  constexpr double kMiddle = 0.5 * (kBlock - 1);
  for (int row = 0; row < seen_.rows; ++row) {
    for (int column = 0; column < seen_.cols; ++column) {
      auto& seen = seen_.at<std::uint8_t>(row, column);
      if (seen == static_cast<std::uint8_t>(Seen::kNothing)) continue;
      const Vector3d point =
          T_camera_wall_ * Vector3d(xOf(column * kBlock + kMiddle), 0.0, zOf(row * kBlock + kMiddle));
      if (isMover(view, surfaces.depth.camera(), point)) {
        seen = static_cast<std::uint8_t>(Seen::kHiding);
        continue;
      }
      const auto* cell = surfaces.depth.cellAt(point);
      if (cell == nullptr) continue;
      const double y = away.dot(pointOf(*cell)) - wall_.distance;
      offset_.at<float>(row, column) = static_cast<float>(y);
      seen = static_cast<std::uint8_t>(y < -kHides ? Seen::kHiding : y > kDeepestLeaf ? Seen::kBeyond : Seen::kWall);
    }
  }
}

double RectifiedWall::rangeAt(double x) const {
  return std::hypot(x, wall_.distance);
}

double RectifiedWall::obliquenessAt(double x) const {
  return std::atan2(std::abs(x), wall_.distance);
}

double RectifiedWall::footprintAt(double x) const {
  return rangeAt(x) / (focalLength_ * std::cos(obliquenessAt(x)));
}

}  // namespace prodomos::perception

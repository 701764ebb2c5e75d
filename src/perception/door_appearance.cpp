// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/door_appearance.hpp"

#include <array>
#include <cmath>

namespace prodomos::perception {

namespace {

constexpr std::array<double, 5> kAcross = {-0.36, -0.18, 0.0, 0.18, 0.36};  // shares of the width
constexpr std::array<double, 5> kUpwards = {0.15, 0.35, 0.55, 0.72, 0.88};  // shares of the height
constexpr std::array<double, 3> kBesideUpwards = {0.3, 0.5, 0.7};
constexpr double kBeside = 0.2;    // metres beyond a jamb
constexpr double kInPlane = 0.12;  // metres: handles, panels, a leaf that lies in the wall
constexpr double kBehind = 0.3;    // metres behind the plane: nothing of the door itself
constexpr double kAssumedHeight = 2.0;

enum class Spot { kUnknown, kHidden, kFilled, kBetween, kThrough };

class DoorGauge {
 public:
  DoorGauge(const geometry::Pose3& T_submap_door, const RgbdView& view, const Surfaces& surfaces)
      : depth_(surfaces.depth), T_camera_door_(view.T_submap_camera.inverse() * T_submap_door) {
    normal_in_camera_ = T_camera_door_.linear().col(0);
    if (normal_in_camera_.dot(T_camera_door_.translation()) < 0.0) normal_in_camera_ = -normal_in_camera_;
  }

  Eigen::Vector3d inCamera(double across, double up) const { return T_camera_door_ * Eigen::Vector3d(0.0, across, up); }
  const Eigen::Vector3d& normal() const { return normal_in_camera_; }

  Spot at(double across, double up) const {
    const auto* cell = depth_.cellAt(inCamera(across, up));
    if (cell == nullptr) return Spot::kUnknown;
    const Eigen::Vector3d point = sensors::pointOf(*cell);
    const double frontal = std::abs(normal_in_camera_.dot(point)) / point.z();
    const double noise = 3.0 * sensors::depthSigma(point.z()) * frontal;
    const double behind = normal_in_camera_.dot(point - T_camera_door_.translation());
    if (behind < -kInPlane - noise) return Spot::kHidden;
    if (behind <= kInPlane + noise) return Spot::kFilled;
    return behind > kBehind + noise ? Spot::kThrough : Spot::kBetween;
  }

  bool isInImage(double across, double up) const {
    const Eigen::Vector3d point = inCamera(across, up);
    if (!(point.z() > 0.05)) return false;
    const Eigen::Vector2d pixel = depth_.camera().pixel(point.head<2>() / point.z());
    return pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() < depth_.camera().width() &&
           pixel.y() < depth_.camera().height();
  }

 private:
  const sensors::DepthGrid& depth_;
  geometry::Pose3 T_camera_door_;
  Eigen::Vector3d normal_in_camera_;
};

bool seesThroughBeside(const DoorGauge& gauge, double width, double height) {
  for (const double side : {-1.0, 1.0}) {
    for (const double share : kBesideUpwards) {
      if (gauge.at(side * (width / 2.0 + kBeside), share * height) != Spot::kThrough) return false;
    }
  }
  return true;
}

}  // namespace

DoorAppearance appearanceOf(const geometry::Pose3& T_submap_door, double width, double height, const RgbdView& view,
                            const Surfaces& surfaces) {
  const DoorGauge gauge(T_submap_door, view, surfaces);
  if (!(height > 0.0)) height = kAssumedHeight;
  const Eigen::Vector3d middle = gauge.inCamera(0.0, height / 2.0);
  DoorAppearance appearance;
  appearance.range = middle.norm();
  appearance.obliquity = std::acos(std::min(1.0, std::abs(gauge.normal().dot(middle.normalized()))));
  if (surfaces.depth.known() == 0 || !(middle.z() > 0.0)) return appearance;

  constexpr double kOne = 1.0 / static_cast<double>(kAcross.size() * kUpwards.size());
  appearance.unknown = 0.0;
  for (const double across : kAcross) {
    for (const double up : kUpwards) {
      const Spot spot = gauge.at(across * width, up * height);
      if (spot == Spot::kUnknown) appearance.unknown += kOne;
      if (spot == Spot::kHidden) appearance.hidden += kOne;
      if (spot == Spot::kFilled) appearance.filled += kOne;
      if (spot == Spot::kThrough) appearance.through += kOne;
    }
  }
  constexpr double kMargin = 0.1;  // metres: what bounds it must be seen too
  const double half = width / 2.0 + kMargin;
  appearance.isWhole = gauge.isInImage(-half, height / 2.0) && gauge.isInImage(half, height / 2.0) &&
                       gauge.isInImage(-half, height + kMargin) && gauge.isInImage(half, height + kMargin);
  appearance.hasNoWall = seesThroughBeside(gauge, width, height);
  return appearance;
}

DoorAppearance appearanceOf(const geometry::Pose3& T_sensor_door, double width, const std::vector<ScanBeam>& beams) {
  constexpr int kLeastBeams = 8;
  Eigen::Vector2d normal = T_sensor_door.linear().col(0).head<2>();
  const Eigen::Vector2d middle = T_sensor_door.translation().head<2>();
  if (normal.dot(middle) < 0.0) normal = -normal;
  const double distance = normal.dot(middle);
  DoorAppearance appearance;
  appearance.range = middle.norm();
  appearance.obliquity = std::acos(std::min(1.0, distance / std::max(1e-9, middle.norm())));

  int count = 0;
  int hidden = 0;
  int filled = 0;
  int through = 0;
  for (const auto& beam : beams) {
    const double towards = normal.dot(beam.direction);
    if (!(towards > 0.05)) continue;
    const Eigen::Vector2d onDoor = distance / towards * beam.direction - middle;
    if (std::abs(normal.x() * onDoor.y() - normal.y() * onDoor.x()) > kAcross.back() * width) continue;
    const double behind = beam.range * towards - distance;
    ++count;
    hidden += behind < -kInPlane ? 1 : 0;
    filled += std::abs(behind) <= kInPlane ? 1 : 0;
    through += behind > kBehind ? 1 : 0;
  }
  if (count < kLeastBeams) return appearance;
  appearance.unknown = 0.0;
  appearance.hidden = static_cast<double>(hidden) / count;
  appearance.filled = static_cast<double>(filled) / count;
  appearance.through = static_cast<double>(through) / count;
  return appearance;
}

}  // namespace prodomos::perception

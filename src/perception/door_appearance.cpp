// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/door_appearance.hpp"

#include <array>
#include <cmath>
#include <optional>

namespace prodomos::perception {

namespace {

constexpr std::array<double, 5> kAcross = {-0.36, -0.18, 0.0, 0.18, 0.36};  // shares of the width
constexpr std::array<double, 5> kUpwards = {0.15, 0.35, 0.55, 0.72, 0.88};  // shares of the height
constexpr std::array<double, 3> kBesideUpwards = {0.3, 0.5, 0.7};
constexpr double kBeside = 0.2;    // metres beyond a jamb
constexpr double kInPlane = 0.12;  // metres: handles, panels, a leaf that lies in the wall
constexpr double kBehind = 0.3;    // metres behind the plane: nothing of the door itself
constexpr double kOfLeaf = 0.7;    // metres from the plane; further off is something else
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

  /// Metres that what is seen there lies behind the plane of the door; `noise`: metres of that.
  std::optional<double> depthBehind(double across, double up, double& noise) const {
    const auto* cell = depth_.cellAt(inCamera(across, up));
    if (cell == nullptr) return std::nullopt;
    const Eigen::Vector3d point = sensors::pointOf(*cell);
    const double frontal = std::abs(normal_in_camera_.dot(point)) / point.z();
    noise = 3.0 * sensors::depthSigma(point.z()) * frontal;
    return normal_in_camera_.dot(point - T_camera_door_.translation());
  }

  Spot at(double across, double up) const {
    double noise = 0.0;
    const auto behind = depthBehind(across, up, noise);
    return behind ? spotOf(*behind, noise) : Spot::kUnknown;
  }

  static Spot spotOf(double behind, double noise) {
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

/// Of depths over where they are across: least squares.
class SlopeFit {
 public:
  void add(double across, double behind) {
    ++count_;
    across_ += across;
    behind_ += behind;
    squares_ += across * across;
    products_ += across * behind;
  }
  double slope() const {
    const double spread = squares_ - across_ * across_ / count_;
    return count_ >= kLeast && spread > kLeastSpread ? (products_ - across_ * behind_ / count_) / spread : 0.0;
  }

 private:
  static constexpr int kLeast = 12;
  static constexpr double kLeastSpread = 0.2;  // m²
  int count_ = 0;
  double across_ = 0.0;
  double behind_ = 0.0;
  double squares_ = 0.0;
  double products_ = 0.0;
};

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
  SlopeFit leaf;
  for (const double across : kAcross) {
    for (const double up : kUpwards) {
      double noise = 0.0;
      const auto behind = gauge.depthBehind(across * width, up * height, noise);
      const Spot spot = behind ? DoorGauge::spotOf(*behind, noise) : Spot::kUnknown;
      if (behind && std::abs(*behind) < kOfLeaf) leaf.add(across * width, *behind);
      if (spot == Spot::kUnknown) appearance.unknown += kOne;
      if (spot == Spot::kHidden) appearance.hidden += kOne;
      if (spot == Spot::kFilled) appearance.filled += kOne;
      if (spot == Spot::kThrough) appearance.through += kOne;
    }
  }
  appearance.slope = leaf.slope();
  constexpr double kMargin = 0.1;  // metres: what bounds it must be seen too
  const double half = width / 2.0 + kMargin;
  appearance.isWhole = gauge.isInImage(-half, height / 2.0) && gauge.isInImage(half, height / 2.0) &&
                       gauge.isInImage(-half, height + kMargin) && gauge.isInImage(half, height + kMargin);
  appearance.hasNoWall = seesThroughBeside(gauge, width, height);
  return appearance;
}

}  // namespace prodomos::perception

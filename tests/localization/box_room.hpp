// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/reading.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace prodomos::test {

/// A room seen from within, and boxes that stand in it; z up. Rays are cast one a pixel, without noise.
class BoxRoom {
 public:
  struct Box {
    Eigen::Vector3d least;
    Eigen::Vector3d most;
  };
  enum class Texture { kSpeckled, kBlank };

  BoxRoom(const Eigen::Vector3d& size, std::vector<Box> boxes, Texture texture)
      : size_(size), boxes_(std::move(boxes)), texture_(texture) {}

  /// Three boxes and four walls: structure in all six freedoms from nearly everywhere.
  static BoxRoom furnished(Texture texture = Texture::kSpeckled) {
    return {
        {6.0, 5.0, 2.6},
        {{{3.6, 0.4, 0.0}, {4.4, 1.2, 0.9}}, {{4.4, 3.0, 0.0}, {5.2, 4.0, 1.4}}, {{0.3, 3.5, 0.0}, {1.2, 4.4, 0.7}}},
        texture};
  }
  std::vector<Box>& boxes() { return boxes_; }

  static sensors::CameraIntrinsics camera() { return {262.0, 262.0, 159.5, 119.5, {}}; }

  /// 320 x 240 pixels.
  sensors::RgbdFrame see(const geometry::Pose3& T_world_body,
                         const sensors::CameraIntrinsics& camera = BoxRoom::camera(), int width = 320,
                         int height = 240) const {
    sensors::RgbdFrame frame;
    frame.T_body_camera = sensors::cameraAxesInBody();
    frame.camera = camera;
    frame.depth = sensors::Image<float>(width, height);
    frame.color = sensors::Image<sensors::Rgb>(width, height);
    const geometry::Pose3 T_world_camera = T_world_body * frame.T_body_camera;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const Eigen::Vector3d ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0);
        const Hit hit = cast(T_world_camera.translation(), T_world_camera.linear() * ray);
        frame.depth(x, y) = static_cast<float>(hit.distance);
        frame.color(x, y) = colorAt(T_world_camera.translation() + hit.distance * (T_world_camera.linear() * ray), hit);
      }
    }
    return frame;
  }

 private:
  struct Hit {
    double distance = std::numeric_limits<double>::infinity();
    int axis = 0;
    int box = -1;
  };

  Hit cast(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) const {
    Hit hit;
    for (int axis = 0; axis < 3; ++axis) {
      const double wall = ray(axis) > 0.0 ? size_(axis) : 0.0;
      const double distance = (wall - from(axis)) / ray(axis);
      if (distance > 0.0 && distance < hit.distance) hit = {distance, axis, ray(axis) > 0.0 ? -1 : -2};
    }
    for (int i = 0; i < static_cast<int>(boxes_.size()); ++i) {
      const Box& box = boxes_[static_cast<std::size_t>(i)];
      double enter = 0.0;
      double leave = hit.distance;
      int axisOfEntry = -1;
      for (int axis = 0; axis < 3; ++axis) {
        double a = (box.least(axis) - from(axis)) / ray(axis);
        double b = (box.most(axis) - from(axis)) / ray(axis);
        if (a > b) std::swap(a, b);
        if (a > enter) {
          enter = a;
          axisOfEntry = axis;
        }
        leave = std::min(leave, b);
      }
      if (axisOfEntry >= 0 && enter < leave) hit = {enter, axisOfEntry, i};
    }
    return hit;
  }

  /// Patches of 9 cm and of 4 cm, each face with its own; on boxes they move along with the box.
  sensors::Rgb colorAt(const Eigen::Vector3d& point, const Hit& hit) const {
    if (texture_ == Texture::kBlank) return {180, 180, 180};
    const Eigen::Vector3d on = hit.box < 0 ? point : point - boxes_[static_cast<std::size_t>(hit.box)].least;
    const double u = on((hit.axis + 1) % 3);
    const double v = on((hit.axis + 2) % 3);
    const auto patch = [&](double size) {
      auto key = static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(u / size))) * 0x9e3779b97f4a7c15U;
      key ^= static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(v / size))) * 0xc2b2ae3d27d4eb4fU;
      key ^= static_cast<std::uint64_t>(hit.axis * 16 + hit.box + 3) * 0x165667b19e3779f9U;
      key = (key ^ (key >> 29)) * 0xbf58476d1ce4e5b9U;
      return static_cast<int>((key ^ (key >> 32)) % 128);
    };
    const auto gray = static_cast<std::uint8_t>(patch(0.09) + patch(0.04));
    return {gray, gray, static_cast<std::uint8_t>(255 - gray)};
  }

  Eigen::Vector3d size_;
  std::vector<Box> boxes_;
  Texture texture_;
};

}  // namespace prodomos::test

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/camera.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace prodomos::localization::rgbd {

using sensors::Camera;

/// A corner of the image with its descriptor, and how far away it is.
struct KeyPoint {
  float rayX, rayY;                         ///< undistorted, on the plane one metre ahead
  float depth;                              ///< metres; 0: not known, or at the edge of something
  float sigma;                              ///< pixels; grows with the scale it was found at
  std::array<std::uint64_t, 4> descriptor;  ///< ORB (Rublee et al. 2011)
};

inline Eigen::Vector2d rayOf(const KeyPoint& point) {
  return {static_cast<double>(point.rayX), static_cast<double>(point.rayY)};
}
inline Eigen::Vector3d pointOf(const KeyPoint& point) {
  return static_cast<double>(point.depth) * rayOf(point).homogeneous();
}

/// Indices of two key points that look alike.
struct Match {
  std::uint32_t reference;
  std::uint32_t current;
};

/// At most `count` corners, spread over the image; none on movers, none where there is no colour.
std::vector<KeyPoint> findKeyPoints(const Camera& camera, const sensors::RgbdFrame& frame, const sensors::Mask* movers,
                                    int count, double maxDepth);

/// Whatever looks alike, wherever it is: mutually best, and clearly better than the second.
std::vector<Match> matchAnywhere(std::span<const KeyPoint> reference, std::span<const KeyPoint> current);

/// Key points of the reference with depth, and what looks alike within `radius` pixels of where they must be seen.
std::vector<Match> matchNear(std::span<const KeyPoint> reference, std::span<const KeyPoint> current,
                             const geometry::Pose3& T_current_reference, const Camera& camera, double radius);

}  // namespace prodomos::localization::rgbd

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/worlds/door_frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace prodomos::simulation {
namespace {

/// Direction of the side of the smallest rectangle round the frame, seen from above, that runs through the wall: across
/// the opening. One of its sides lies along an edge of the mesh.
double directionThrough(const Surface& frame) {
  double best = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& triangle : frame.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3f edge = frame.vertices[triangle[(i + 1) % 3]] - frame.vertices[triangle[i]];
      if (edge.head<2>().norm() < 0.02F) continue;
      const double angle = std::atan2(edge.y(), edge.x());
      const Eigen::Rotation2Df turn(static_cast<float>(-angle));
      Eigen::AlignedBox2f bounds;
      for (const auto& vertex : frame.vertices) bounds.extend(turn * vertex.head<2>());
      if (bounds.volume() >= least - 1e-6F) continue;
      least = bounds.volume();
      best = bounds.sizes().x() < bounds.sizes().y() ? angle : angle + std::numbers::pi / 2.0;
    }
  }
  return geometry::normalizeAngle(best);
}

}  // namespace

std::optional<FramedOpening> openingOf(const Surface& frame) {
  const double direction = directionThrough(frame);
  const Eigen::Rotation2Dd turn(-direction);
  Eigen::AlignedBox3d bounds;
  std::vector<Eigen::Vector3d> corners;
  for (const auto& vertex : frame.vertices) {
    Eigen::Vector3d corner = vertex.cast<double>();
    corner.head<2>() = turn * corner.head<2>();
    corners.push_back(corner);
    bounds.extend(corner);
  }
  // The inner faces: the innermost corners left and right of the middle, and the lowest above it.
  const Eigen::Vector3d middle = bounds.center();
  double left = bounds.max().y();
  double right = bounds.min().y();
  double lintel = bounds.max().z();
  for (const auto& corner : corners) {
    if (corner.y() > middle.y()) left = std::min(left, corner.y());
    if (corner.y() < middle.y()) right = std::max(right, corner.y());
    if (corner.z() > middle.z()) lintel = std::min(lintel, corner.z());
  }
  FramedOpening opening{.bottom = bounds.min().z(), .width = left - right, .height = lintel - bounds.min().z()};
  constexpr double kNarrowest = 0.4;
  constexpr double kLowest = 1.5;
  if (opening.width < kNarrowest || opening.height < kLowest) return std::nullopt;
  const Eigen::Vector2d centre = turn.inverse() * Eigen::Vector2d(middle.x(), (left + right) / 2.0);
  opening.pose = {centre.x(), centre.y(), direction};
  for (const auto& corner : cornersOf({bounds.min().head<2>(), bounds.max().head<2>()})) {
    opening.footprint.emplace_back(turn.inverse() * corner);
  }
  return opening;
}

}  // namespace prodomos::simulation

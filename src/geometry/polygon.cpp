// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/polygon.hpp"

namespace prodomos::geometry {

double signedArea(const Polygon& polygon) {
  double doubled = 0.0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Eigen::Vector2d a = polygon[i] - polygon[0];
    const Eigen::Vector2d b = polygon[i + 1] - polygon[0];
    doubled += a.x() * b.y() - a.y() * b.x();
  }
  return doubled / 2.0;
}

bool contains(const Polygon& polygon, const Eigen::Vector2d& point) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const auto& a = polygon[i];
    const auto& b = polygon[j];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    if (point.x() < a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

Polygon transformed(const Pose2& T_a_b, const Polygon& polygon_in_b) {
  return transformed(toPose3(T_a_b), polygon_in_b);
}

Polygon transformed(const Pose3& T_a_b, const Polygon& polygon_in_b) {
  Polygon polygon;
  for (const auto& corner : polygon_in_b) {
    polygon.push_back((T_a_b * Eigen::Vector3d(corner.x(), corner.y(), 0.0)).head<2>());
  }
  return polygon;
}

}  // namespace prodomos::geometry

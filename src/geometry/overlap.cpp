// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/overlap.hpp"

#include "prodomos/geometry/polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace prodomos::geometry {

namespace {

using Face = std::vector<Eigen::Vector3d>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The part of a convex polygon for which height() is not positive (Sutherland and Hodgman 1974). height() must be
/// linear.
template <typename Point, typename Height>
std::vector<Point> cut(const std::vector<Point>& polygon, const Height& height) {
  std::vector<Point> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& here = polygon[i];
    const Point& next = polygon[(i + 1) % polygon.size()];
    const double heightHere = height(here);
    const double heightNext = height(next);
    if (heightHere <= 0.0) kept.push_back(here);
    if ((heightHere < 0.0 && heightNext > 0.0) || (heightHere > 0.0 && heightNext < 0.0)) {
      kept.push_back(here + heightHere / (heightHere - heightNext) * (next - here));
    }
  }
  return kept;
}

/// A triangle, counter-clockwise, that counts as much as its sign.
struct SignedTriangle {
  Polygon corners;
  double sign = 1.0;
};

/// Triangles about the first corner. They overlap where the polygon is not convex, but summed with their signs they
/// cover its inside once and its outside not at all.
std::vector<SignedTriangle> fanOf(const Polygon& polygon, const Eigen::Vector2d& origin) {
  std::vector<SignedTriangle> fan;
  const double orientation = signedArea(polygon) < 0.0 ? -1.0 : 1.0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    SignedTriangle triangle{{polygon[0] - origin, polygon[i] - origin, polygon[i + 1] - origin}, orientation};
    const double area = signedArea(triangle.corners);
    if (area == 0.0) continue;
    if (area < 0.0) {
      std::swap(triangle.corners[1], triangle.corners[2]);
      triangle.sign = -orientation;
    }
    fan.push_back(std::move(triangle));
  }
  return fan;
}

double sharedAreaOfTriangles(Polygon a, const Polygon& b) {
  for (std::size_t i = 0; i < b.size() && !a.empty(); ++i) {
    const Eigen::Vector2d edge = b[(i + 1) % b.size()] - b[i];
    a = cut(a, [&](const Eigen::Vector2d& point) { return -cross(edge, point - b[i]); });
  }
  return std::abs(signedArea(a));
}

/// Outward faces of a box, counter-clockwise seen from outside.
std::vector<Face> facesOf(const OrientedBox& box, const Pose3& T_target_frame) {
  const Pose3 T_target_box = T_target_frame * box.T_frame_box;
  const Eigen::Vector3d half = 0.5 * box.size;
  std::vector<Face> faces;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const double side : {-1.0, 1.0}) {
      Face face;
      for (const auto& [alongU, alongV] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
        Eigen::Vector3d corner;
        corner[axis] = side * half[axis];
        corner[u] = alongU * half[u];
        corner[v] = alongV * half[v];
        face.push_back(T_target_box * corner);
      }
      if (side < 0.0) std::ranges::reverse(face);
      faces.push_back(std::move(face));
    }
  }
  return faces;
}

/// The face where a convex solid was cut: the points there, counter-clockwise about the normal.
Face capOf(Face points, const Eigen::Vector3d& normal) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& point : points) middle += point / static_cast<double>(points.size());
  const Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d v = normal.cross(u);
  const auto angle = [&](const Eigen::Vector3d& point) {
    return std::atan2(v.dot(point - middle), u.dot(point - middle));
  };
  std::ranges::sort(points, {}, angle);
  return points;
}

/// The part of a convex solid with normal · p <= offset.
std::vector<Face> cutSolid(const std::vector<Face>& faces, const Eigen::Vector3d& normal, double offset) {
  constexpr double kOnPlane = 1e-9;  // metres: faces that lie in the plane are not cut by rounding
  const auto height = [&](const Eigen::Vector3d& point) { return normal.dot(point) - offset; };
  const bool isCut = std::ranges::any_of(faces, [&](const Face& face) {
    return std::ranges::any_of(face, [&](const auto& p) { return height(p) > kOnPlane; });
  });
  if (!isCut) return faces;
  std::vector<Face> kept;
  Face rim;
  for (const auto& face : faces) {
    auto part = cut(face, height);
    std::ranges::copy_if(part, std::back_inserter(rim), [&](const auto& p) { return height(p) > -kOnPlane; });
    if (part.size() >= 3) kept.push_back(std::move(part));
  }
  if (rim.size() >= 3) kept.push_back(capOf(std::move(rim), normal));
  return kept;
}

/// By the divergence theorem, about a corner.
double volumeOf(const std::vector<Face>& faces) {
  double sixfold = 0.0;
  for (const auto& face : faces) {
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      const Eigen::Vector3d origin = faces.front().front();
      sixfold += (face[0] - origin).dot((face[i] - origin).cross(face[i + 1] - origin));
    }
  }
  return sixfold / 6.0;
}

}  // namespace

double areaOf(const Polygon& polygon) {
  return std::abs(signedArea(polygon));
}

double sharedArea(const Polygon& a, const Polygon& b) {
  if (a.size() < 3 || b.size() < 3) return 0.0;
  double area = 0.0;
  const auto fan = fanOf(b, a[0]);
  for (const auto& triangleOfA : fanOf(a, a[0])) {
    for (const auto& triangleOfB : fan) {
      area += triangleOfA.sign * triangleOfB.sign * sharedAreaOfTriangles(triangleOfA.corners, triangleOfB.corners);
    }
  }
  return std::max(area, 0.0);
}

double volumeOf(const OrientedBox& box) {
  return box.size.prod();
}

double sharedVolume(const OrientedBox& a, const OrientedBox& b) {
  auto faces = facesOf(a, b.T_frame_box.inverse());
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      faces = cutSolid(faces, side * Eigen::Vector3d::Unit(axis), 0.5 * b.size[axis]);
    }
  }
  return std::max(volumeOf(faces), 0.0);
}

double intersectionOverUnion(const OrientedBox& a, const OrientedBox& b) {
  const double shared = sharedVolume(a, b);
  const double together = volumeOf(a) + volumeOf(b) - shared;
  return together > 0.0 ? shared / together : 0.0;
}

}  // namespace prodomos::geometry

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scenes/scene_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace prodomos::simulation {

namespace {

constexpr double kSmall = 1e-6;  // metres: rounding, not geometry

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

Eigen::Vector2d unit(double heading) {
  return {std::cos(heading), std::sin(heading)};
}

/// Cross in the middle of both.
bool segmentsCross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                   const Eigen::Vector2d& d) {
  const auto side = [](const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Eigen::Vector2d& point) {
    const double distance = cross(to - from, point - from) / (to - from).norm();
    return std::abs(distance) < kSmall ? 0.0 : distance;
  };
  return side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
}

bool outlinesCross(const Polygon& a, const Polygon& b) {
  for (const auto& wall : wallsOf(a)) {
    for (const auto& other : wallsOf(b)) {
      if (segmentsCross(wall.from, wall.to, other.from, other.to)) return true;
    }
  }
  return false;
}

double distanceToOutline(const Polygon& outline, const Eigen::Vector2d& point) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& wall : wallsOf(outline)) least = std::min(least, distanceToSegment(point, wall.from, wall.to));
  return least;
}

bool containsOrTouches(const Polygon& outline, const Eigen::Vector2d& point) {
  return contains(outline, point) || distanceToOutline(outline, point) < kSmall;
}

bool containsInside(const Polygon& outline, const Eigen::Vector2d& point) {
  return contains(outline, point) && distanceToOutline(outline, point) > kSmall;
}

/// A point in the middle of the widest span of a level line: inside of any simple polygon.
Eigen::Vector2d pointInside(const Polygon& polygon) {
  std::vector<double> levels;
  for (const auto& corner : polygon) levels.push_back(corner.y());
  std::ranges::sort(levels);
  std::size_t widest = 0;
  for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
    if (levels[i + 1] - levels[i] > levels[widest + 1] - levels[widest]) widest = i;
  }
  const double y = (levels[widest] + levels[widest + 1]) / 2.0;
  std::vector<double> crossings;
  for (const auto& wall : wallsOf(polygon)) {
    if ((wall.from.y() > y) == (wall.to.y() > y)) continue;
    crossings.push_back(std::lerp(wall.from.x(), wall.to.x(), (y - wall.from.y()) / (wall.to.y() - wall.from.y())));
  }
  std::ranges::sort(crossings);
  return {(crossings[0] + crossings[1]) / 2.0, y};
}

/// How far the corners reach along an axis.
std::pair<double, double> extentAlong(const Polygon& corners, const Eigen::Vector2d& axis) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const auto& corner : corners) {
    least = std::min(least, corner.dot(axis));
    most = std::max(most, corner.dot(axis));
  }
  return {least, most};
}

}  // namespace

std::vector<WallStretch> wallsOf(const Polygon& outline) {
  std::vector<WallStretch> walls;
  walls.reserve(outline.size());
  for (std::size_t i = 0; i < outline.size(); ++i) walls.push_back({outline[i], outline[(i + 1) % outline.size()]});
  return walls;
}

Polygon tidied(Polygon polygon) {
  if (signedArea(polygon) < 0.0) std::ranges::reverse(polygon);
  Polygon tidy;
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const auto& before = tidy.empty() ? polygon[n - 1] : tidy.back();
    const auto& after = polygon[(i + 1) % n];
    const bool isCorner = std::abs(cross(polygon[i] - before, after - polygon[i])) > kSmall;
    if (isCorner) tidy.push_back(polygon[i]);
  }
  return tidy;
}

Polygon insetBy(const Polygon& polygon, double distance) {
  const auto walls = wallsOf(polygon);
  Polygon inset;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const auto& before = walls[(i + walls.size() - 1) % walls.size()];
    const auto& after = walls[i];
    // The corner moves so far along the bisector that it is `distance` from both walls.
    const Eigen::Vector2d bisector = before.inward() + after.inward();
    inset.emplace_back(after.from + bisector * (2.0 * distance / bisector.squaredNorm()));
  }
  return inset;
}

bool overlap(const Polygon& a, const Polygon& b) {
  if (outlinesCross(a, b)) return true;
  const auto holdsAny = [](const Polygon& outline, const Polygon& other) {
    return std::ranges::any_of(other, [&](const auto& corner) { return containsInside(outline, corner); });
  };
  return holdsAny(a, b) || holdsAny(b, a) || containsInside(a, pointInside(b)) || containsInside(b, pointInside(a));
}

std::vector<WallStretch> commonWalls(const Polygon& room, const Polygon& neighbour) {
  constexpr double kApart = 0.01;  // metres: that a person may be off where two rooms' walls are one
  std::vector<WallStretch> common;
  for (const auto& wall : wallsOf(room)) {
    for (const auto& other : wallsOf(neighbour)) {
      const auto off = [&](const Eigen::Vector2d& point) { return std::abs(cross(wall.along(), point - wall.from)); };
      const bool runsBack = wall.along().dot(other.along()) < 0.0;
      if (!runsBack || off(other.from) > kApart || off(other.to) > kApart) continue;
      const double begin = std::max(0.0, wall.along().dot(other.to - wall.from));
      const double end = std::min(wall.length(), wall.along().dot(other.from - wall.from));
      if (end - begin > kApart) common.push_back({wall.from + begin * wall.along(), wall.from + end * wall.along()});
    }
  }
  return common;
}

double distanceToSegment(const Eigen::Vector2d& point, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double lengthSquared = (b - a).squaredNorm();
  const double t = lengthSquared > 0.0 ? std::clamp((point - a).dot(b - a) / lengthSquared, 0.0, 1.0) : 0.0;
  return (a + t * (b - a) - point).norm();
}

Polygon Footprint::corners() const {
  const Eigen::Vector2d x = unit(heading) * size.x() / 2.0;
  const Eigen::Vector2d y = Eigen::Vector2d(-std::sin(heading), std::cos(heading)) * size.y() / 2.0;
  return {middle - x - y, middle + x - y, middle + x + y, middle - x + y};
}

double Footprint::distanceTo(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d offset = point - middle;
  const double x = std::abs(offset.dot(unit(heading))) - size.x() / 2.0;
  const double y = std::abs(cross(unit(heading), offset)) - size.y() / 2.0;
  return std::hypot(std::max(x, 0.0), std::max(y, 0.0));
}

Footprint placeOf(const Thing& thing) {
  return {thing.T_world_thing.translation().head<2>(), geometry::yaw(thing.T_world_thing), thing.size.head<2>()};
}

Footprint placeOf(const Staircase& stairs) {
  const Eigen::Vector2d foot = stairs.foot.head<2>();
  const Eigen::Vector2d head = headOf(stairs).head<2>();
  return {(foot + head) / 2.0, stairs.direction, {(head - foot).norm(), stairs.width}};
}

bool overlap(const Footprint& a, const Footprint& b) {
  if ((a.middle - b.middle).norm() > (a.size.norm() + b.size.norm()) / 2.0) return false;
  const auto cornersOfA = a.corners();
  const auto cornersOfB = b.corners();
  // Separating axes: two rectangles are apart if they are so along a side of one of them.
  for (const double heading : {a.heading, b.heading}) {
    for (const Eigen::Vector2d& axis : {unit(heading), Eigen::Vector2d(-std::sin(heading), std::cos(heading))}) {
      const auto [leastA, mostA] = extentAlong(cornersOfA, axis);
      const auto [leastB, mostB] = extentAlong(cornersOfB, axis);
      if (mostA <= leastB + kSmall || mostB <= leastA + kSmall) return false;
    }
  }
  return true;
}

bool isWithin(const Polygon& outline, const Footprint& footprint) {
  const auto corners = footprint.corners();
  const auto isIn = [&](const Eigen::Vector2d& corner) { return containsOrTouches(outline, corner); };
  const auto cutsIn = [&](const Eigen::Vector2d& corner) { return containsInside(corners, corner); };
  return std::ranges::all_of(corners, isIn) && std::ranges::none_of(outline, cutsIn) &&
         !outlinesCross(corners, outline);
}

}  // namespace prodomos::simulation

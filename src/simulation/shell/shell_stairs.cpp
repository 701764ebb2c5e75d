// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/polygons.hpp"
#include "simulation/shell/shell_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace prodomos::simulation {

namespace {

constexpr double kRailHeight = 0.92;  // Above the nosings, and above floors.
constexpr double kRailThickness = 0.045;
constexpr double kPostThickness = 0.03;
constexpr double kPostSpacing = 1.0;
constexpr double kFromEdge = 0.05;  // Of a rail, from the edge of flight or hole.
constexpr double kSoffit = 0.18;    // Of concrete below the inner corners of the steps.
constexpr double kLandingThickness = 0.2;

/// Of a flight's own frame: x uphill from the first riser, y to the left, z up from the foot.
geometry::Pose3 poseOf(const Staircase& stairs) {
  return geometry::toPose3({stairs.foot.x(), stairs.foot.y(), stairs.direction}, stairs.foot.z());
}

double runOf(const Staircase& stairs) {
  return (stairs.stepCount - 1) * stairs.stepDepth;
}

double undersideAt(const Staircase& stairs, double x) {
  return std::max(0.0, x * stairs.stepHeight / stairs.stepDepth - kSoffit);
}

/// The side of one step, from the underside up to its tread.
void addCheek(const Staircase& stairs, double x, double top, double y, Surface& surface) {
  const double end = x + stairs.stepDepth;
  std::array<Eigen::Vector3d, 4> corners{
      {{x, y, undersideAt(stairs, x)}, {end, y, undersideAt(stairs, end)}, {end, y, top}, {x, y, top}}};
  if (y > 0.0) std::ranges::reverse(corners);
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (const auto& corner : corners) {
    surface.vertices.push_back(corner.cast<float>());
    surface.textureCoordinates.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.z()));
  }
  surface.triangles.push_back({first, first + 1, first + 2});
  surface.triangles.push_back({first, first + 2, first + 3});
}

/// Risers, treads, underside and both cheeks, in the flight's frame. The last riser ends on a floor.
void addSteps(const Staircase& stairs, Surface& surface) {
  const double left = stairs.width / 2.0;
  const Eigen::Vector3d across(0.0, stairs.width, 0.0);
  for (int step = 0; step < stairs.stepCount; ++step) {
    const double x = step * stairs.stepDepth;
    const double top = (step + 1) * stairs.stepHeight;
    addRectangle(surface, {x, left, step * stairs.stepHeight}, -across, {0.0, 0.0, stairs.stepHeight});
    if (step + 1 == stairs.stepCount) break;
    addRectangle(surface, {x, -left, top}, {stairs.stepDepth, 0.0, 0.0}, across);
    const double rise = undersideAt(stairs, x + stairs.stepDepth) - undersideAt(stairs, x);
    addRectangle(surface, {x, left, undersideAt(stairs, x)}, {stairs.stepDepth, 0.0, rise}, -across);
    addCheek(stairs, x, top, left, surface);
    addCheek(stairs, x, top, -left, surface);
  }
}

/// A rail with posts under it, from one point of the ground to another.
void addRail(const Eigen::Vector3d& from, const Eigen::Vector3d& to, Surface& surface) {
  const Eigen::Vector3d up(0.0, 0.0, kRailHeight);
  addBar(surface, from + up, to + up, kRailThickness);
  addBar(surface, from + up / 2.0, to + up / 2.0, kPostThickness);
  const int spaces = std::max(1, static_cast<int>(std::lround((to - from).norm() / kPostSpacing)));
  for (int post = 0; post <= spaces; ++post) {
    const Eigen::Vector3d foot = from + (to - from) * post / spaces;
    addBar(surface, foot, foot + up, kPostThickness);
  }
}

Surface railSurface(const HouseLook& look) {
  return {.material = look.handrail(), .classId = classId("handrail")};
}

bool isOnLine(const Eigen::Vector2d& point, const Edge& edge, double tolerance) {
  const double along = (point - edge.from).dot(edge.direction());
  return std::abs((point - edge.from).dot(edge.outward())) < tolerance && along > -tolerance &&
         along < edge.length() + tolerance;
}

/// Whether a flight begins or ends there, on this level.
bool isFlightsEnd(const Building& building, const Level& level, const Eigen::Vector2d& point) {
  return std::ranges::any_of(building.stairs, [&](const Staircase& stairs) {
    const Eigen::Vector2d across =
        stairs.width / 2.0 * Eigen::Vector2d(-std::sin(stairs.direction), std::cos(stairs.direction));
    constexpr double kTolerance = 0.05;
    const auto isAt = [&](const Eigen::Vector3d& end) {
      return std::abs(end.z() - level.floorHeight) < kTolerance &&
             isOnLine(point, {end.head<2>() - across, end.head<2>() + across}, kTolerance);
    };
    return isAt(stairs.foot) || isAt(headOf(stairs));
  });
}

bool isAtWall(const Polygon& outline, const Eigen::Vector2d& point) {
  constexpr double kNear = 0.3;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    if (isOnLine(point, edgeOf(outline, i), kNear)) return true;
  }
  return false;
}

}  // namespace

Polygon footprintOf(const Staircase& stairs) {
  const geometry::Pose2 pose{stairs.foot.x(), stairs.foot.y(), stairs.direction};
  const double left = stairs.width / 2.0;
  using Point = Eigen::Vector2d;
  return {pose * Point(0.0, -left), pose * Point(runOf(stairs), -left), pose * Point(runOf(stairs), left),
          pose * Point(0.0, left)};
}

void addBar(Surface& surface, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double thickness) {
  const Eigen::Vector3d along = to - from;
  if (along.norm() <= 0.0) return;
  geometry::Pose3 T_world_bar = geometry::Pose3::Identity();
  T_world_bar.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), along).toRotationMatrix();
  T_world_bar.translation() = (from + to) / 2.0;
  append(surface, boxSurface(T_world_bar, {along.norm(), thickness, thickness}, surface.material, surface.classId,
                             surface.instance));
}

void addFlight(const Building& building, std::size_t index, const HouseLook& look, std::vector<Surface>& surfaces) {
  const Staircase& stairs = building.stairs[index];
  Surface steps{.material = look.stairs(), .classId = classId("stairs"), .instance = stairsInstance(building, index)};
  addSteps(stairs, steps);
  surfaces.push_back(transformed(poseOf(stairs), std::move(steps)));

  Surface rails = railSurface(look);
  for (const double side : {-1.0, 1.0}) {
    const double y = side * (stairs.width / 2.0 - kFromEdge);
    addRail({0.0, y, stairs.stepHeight}, {runOf(stairs), y, stairs.stepCount * stairs.stepHeight}, rails);
  }
  surfaces.push_back(transformed(poseOf(stairs), std::move(rails)));
}

void addLanding(const Building& building, std::size_t index, const HouseLook& look, std::vector<Surface>& surfaces) {
  const Landing& landing = building.landings[index];
  Surface slab{.material = look.stairs(), .classId = classId("floor")};
  const auto addFace = [&](double z, bool facesUp) {
    for (const auto& triangle : triangulate(landing.outline, {})) {
      const auto first = static_cast<std::uint32_t>(slab.vertices.size());
      for (const auto& corner : triangle) {
        slab.vertices.push_back(Eigen::Vector3d(corner.x(), corner.y(), z).cast<float>());
        slab.textureCoordinates.push_back(corner.cast<float>());
      }
      slab.triangles.push_back({first, first + (facesUp ? 1U : 2U), first + (facesUp ? 2U : 1U)});
    }
  };
  addFace(landing.z, true);
  addFace(landing.z - kLandingThickness, false);
  for (std::size_t i = 0; i < landing.outline.size(); ++i) {
    const Edge edge = edgeOf(landing.outline, i);
    const Eigen::Vector2d span = edge.to - edge.from;
    addRectangle(slab, {edge.from.x(), edge.from.y(), landing.z - kLandingThickness}, {span.x(), span.y(), 0.0},
                 {0.0, 0.0, kLandingThickness});
  }
  surfaces.push_back(std::move(slab));
}

void addRailings(const Building& building, const Level& level, const HouseLook& look, std::vector<Surface>& surfaces) {
  Surface rails = railSurface(look);
  for (const auto& hole : level.floorHoles) {
    for (std::size_t i = 0; i < hole.size(); ++i) {
      const Edge edge = edgeOf(hole, i);
      // In short pieces, since a flight may begin or end at a part of an edge.
      constexpr double kPiece = 0.1;
      const int pieces = std::max(1, static_cast<int>(std::lround(edge.length() / kPiece)));
      const auto at = [&](int piece) -> Eigen::Vector2d { return edge.from + (edge.to - edge.from) * piece / pieces; };
      const auto isOpen = [&](int piece) {
        const Eigen::Vector2d middle = (at(piece) + at(piece + 1)) / 2.0;
        return piece >= pieces || isFlightsEnd(building, level, middle) || isAtWall(level.room.outline, middle);
      };
      for (int from = 0; from < pieces; ++from) {
        if (isOpen(from)) continue;
        int to = from + 1;
        while (!isOpen(to)) ++to;
        const Eigen::Vector2d aside = kFromEdge * edge.outward();
        const auto lifted = [&](const Eigen::Vector2d& point) -> Eigen::Vector3d {
          return {point.x(), point.y(), level.floorHeight};
        };
        addRail(lifted(at(from) + aside), lifted(at(to) + aside), rails);
        from = to;
      }
    }
  }
  if (!rails.triangles.empty()) surfaces.push_back(std::move(rails));
}

}  // namespace prodomos::simulation

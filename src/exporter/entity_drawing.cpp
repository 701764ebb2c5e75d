// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/entity_drawing.hpp"

#include "exporter/palette.hpp"

#include <cmath>
#include <numbers>

namespace prodomos::exporter {
namespace {

using Eigen::Vector3d;

// Where a measure is not known, something of the usual size is drawn.
constexpr double kDoorHeight = 2.0;
constexpr double kDoorThickness = 0.06;
constexpr double kStepDepth = 0.28;
constexpr double kStepHeight = 0.17;
constexpr double kHumanHeight = 1.75;
constexpr double kHumanWidth = 0.5;
constexpr double kHumanDepth = 0.3;

/// Draws each class; T_submap_entity is where it stands.
struct Drawer {
  const geometry::Pose3& T_submap_entity;
  std::string label;
  map::Drawing drawing;

  void box(const Vector3d& centre_in_entity, const Vector3d& size, map::Rgba color, const std::string& text) {
    drawing.boxes.push_back({T_submap_entity * Eigen::Translation3d(centre_in_entity), size, color, text});
  }
  void line(const std::vector<Vector3d>& points_in_entity, map::Rgba color) {
    map::DrawnLine drawn{{}, color, ""};
    for (const auto& point : points_in_entity) drawn.points_in_submap.emplace_back(T_submap_entity * point);
    drawing.lines.push_back(std::move(drawn));
  }
  void arrow(const Vector3d& velocity_in_submap, map::Rgba color) {
    if (velocity_in_submap.isZero()) return;
    const Vector3d start = T_submap_entity.translation();
    drawing.lines.push_back({{start, start + velocity_in_submap}, color, ""});
  }

  void operator()(const map::Staircase& stairs) {
    const double rise = stairs.stepHeight > 0.0 ? stairs.stepHeight : kStepHeight;
    const double depth = stairs.stepDepth > 0.0 ? stairs.stepDepth : kStepDepth;
    const int steps = stairs.stepCount > 0 ? stairs.stepCount
                                           : std::max(1, static_cast<int>(std::lround(std::abs(stairs.height) / rise)));
    const double up = stairs.height < 0.0 ? -1.0 : 1.0;
    for (int i = 0; i < steps; ++i) {
      const double fromMiddle = i - 0.5 * (steps - 1);  // the position is the centroid of the flight
      box({fromMiddle * depth, 0.0, up * fromMiddle * rise}, {depth, stairs.stepWidth, rise},
          withAlpha(kStairsColor, 0.7), i == steps - 1 ? label : "");
    }
  }
  void operator()(const map::Door& door) {
    const double height = door.height > 0.0 ? door.height : kDoorHeight;
    const double half = 0.5 * door.width;
    if (door.hasLeaf) {
      box(Vector3d::Zero(), {kDoorThickness, door.width, height}, withAlpha(kDoorColor, 0.6), label);
    } else {
      line({{0.0, -half, -0.5 * height},
            {0.0, -half, 0.5 * height},
            {0.0, half, 0.5 * height},
            {0.0, half, -0.5 * height}},
           kDoorColor);
    }
  }
  void operator()(const map::Human& human) {
    box({0.0, 0.0, 0.5 * kHumanHeight}, {kHumanDepth, kHumanWidth, kHumanHeight}, withAlpha(kHumanColor, 0.6), label);
    arrow(human.velocity, kHumanColor);
  }
  void operator()(const map::ObjectBox& object) {
    box(Vector3d::Zero(), object.size, withAlpha(kObjectColor, 0.5), label);
    arrow(object.velocity, kObjectColor);
  }
  void operator()(const map::Cuboid& cuboid) { box(Vector3d::Zero(), cuboid.size, withAlpha(kMutedColor, 0.5), label); }
  void operator()(const map::PlanePatch& patch) {
    std::vector<Vector3d> outline;
    for (const auto& point : patch.outline_in_patch) outline.emplace_back(point.x(), point.y(), 0.0);
    if (!outline.empty()) outline.push_back(outline.front());
    line(outline, kInkColor);
  }
};

}  // namespace

map::Drawing drawEntity(const map::Entity& entity) {
  Drawer drawer{entity.T_submap_entity, toString(entity.id), {}};
  std::visit(drawer, entity.attributes);
  return std::move(drawer.drawing);
}

}  // namespace prodomos::exporter

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/footprint.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prodomos::exporter {
namespace {

Polyline rectangle(double length, double width) {
  const double x = length / 2.0;
  const double y = width / 2.0;
  return {{-x, -y}, {x, -y}, {x, y}, {-x, y}, {-x, -y}};
}

/// In the x-y-plane of the entity. A closed set: a new class of entities has to say here what it looks like.
struct Lines {
  std::vector<Polyline> operator()(const map::Door& door) const {
    const auto plan = doorPlan(door);
    if (plan.swing.empty()) return {plan.leaf};
    return {plan.leaf, plan.swing};
  }

  std::vector<Polyline> operator()(const map::Staircase& stairs) const {
    constexpr double kUsualSlope = 1.7;  // depth over height, for flights whose steps were not counted
    constexpr double kLeastSize = 0.5;
    const bool counted = stairs.stepCount > 0 && stairs.stepDepth > 0.0;
    const double length =
        std::max(kLeastSize, counted ? stairs.stepCount * stairs.stepDepth : kUsualSlope * std::abs(stairs.height));
    const double width = std::max(kLeastSize, stairs.stepWidth);
    std::vector<Polyline> lines{rectangle(length, width)};
    const int treads = std::clamp(stairs.stepCount, 4, 24);
    for (int i = 1; i < treads; ++i) {
      const double x = length * i / treads - length / 2.0;
      lines.push_back({{x, -width / 2.0}, {x, width / 2.0}});
    }
    const double tip = 0.42 * length;
    const double barb = 0.2 * std::min(length, width);
    lines.push_back({{-tip, 0.0}, {tip, 0.0}});
    lines.push_back({{tip - barb, barb}, {tip, 0.0}, {tip - barb, -barb}});
    return lines;
  }

  std::vector<Polyline> operator()(const map::Human&) const {
    constexpr double kRadius = 0.25;
    constexpr int kCorners = 16;
    Polyline circle;
    for (int i = 0; i <= kCorners; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kCorners;
      circle.emplace_back(kRadius * std::cos(angle), kRadius * std::sin(angle));
    }
    return {circle, {{kRadius, 0.0}, {1.7 * kRadius, 0.0}}};
  }

  std::vector<Polyline> operator()(const map::ObjectBox& box) const { return {rectangle(box.size.x(), box.size.y())}; }
  std::vector<Polyline> operator()(const map::Cuboid& box) const { return {rectangle(box.size.x(), box.size.y())}; }

  std::vector<Polyline> operator()(const map::PlanePatch& patch) const {
    if (patch.outline_in_patch.empty()) return {};
    Polyline outline = patch.outline_in_patch;
    outline.push_back(outline.front());
    return {outline};
  }
};

}  // namespace

DoorPlan doorPlan(const map::Door& door) {
  const double half = door.width / 2.0;
  if (!door.hasLeaf) return {{{0.0, -half}, {0.0, half}}, {}};
  const double angle = door.state == map::DoorState::kOpen   ? std::numbers::pi / 2.0
                       : door.state == map::DoorState::kAjar ? std::numbers::pi / 5.0
                                                             : 0.0;
  const double hinge = door.hingeSide == map::HingeSide::kRight ? -half : half;
  const double side = hinge < 0.0 ? 1.0 : -1.0;  // from the hinge to the other jamb, along y
  const auto leafEnd = [&](double swung) {
    return Eigen::Vector2d(door.width * std::sin(swung), hinge + side * door.width * std::cos(swung));
  };
  DoorPlan plan{{{0.0, hinge}, leafEnd(angle)}, {}};
  if (door.hingeSide == map::HingeSide::kUnknown) return plan;
  constexpr int kSteps = 10;
  for (int step = 0; step <= kSteps; ++step) plan.swing.push_back(leafEnd(step * std::numbers::pi / 2.0 / kSteps));
  return plan;
}

std::vector<Polyline> footprint(const map::Entity& entity, const geometry::Pose3& T_map_submap) {
  const geometry::Pose3 T_map_entity = T_map_submap * entity.T_submap_entity;
  auto lines = std::visit(Lines{}, entity.attributes);
  for (auto& line : lines) {
    for (auto& point : line) point = (T_map_entity * Eigen::Vector3d(point.x(), point.y(), 0.0)).head<2>();
  }
  return lines;
}

}  // namespace prodomos::exporter

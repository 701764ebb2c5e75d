// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/contents.hpp"
#include "exporter/footprint.hpp"
#include "exporter/palette.hpp"
#include "exporter/plan.hpp"

#include <algorithm>
#include <cmath>

namespace prodomos::exporter {
namespace {

/// Draws each class as architects do, as far as they have a sign for it.
struct Symbol {
  const Eigen::Affine2d& T_page_entity;

  Point at(double x, double y) const { return T_page_entity * Point(x, y); }
  double scale() const { return T_page_entity.linear().col(0).norm(); }
  Line line(std::vector<Point> points, Style style, bool closed = false) const {
    for (auto& point : points) point = T_page_entity * point;
    return {.points = std::move(points), .closed = closed, .style = std::move(style)};
  }
  Line box(const Eigen::Vector3d& size, map::Rgba color) const {
    const double x = size.x() / 2;
    const double y = size.y() / 2;
    return line({{-x, -y}, {x, -y}, {x, y}, {-x, y}}, filledAndStroked(withAlpha(color, 0.2), color, 1.0), true);
  }

  /// Leaf and swing; a doorway without a leaf is a threshold between two jambs.
  std::vector<Shape> operator()(const map::Door& door) const {
    const double half = door.width / 2;
    const Line threshold = line({{0, -half}, {0, half}}, stroked(withAlpha(kFreeColor, 0.9), 4.0));
    std::vector<Shape> shapes = {threshold};
    for (const double jamb : {-half, half}) {
      shapes.emplace_back(Circle{.centre = at(0, jamb), .radius = 1.8, .style = filled(kDoorColor)});
    }
    const auto plan = doorPlan(door);
    shapes.emplace_back(
        line(plan.leaf, door.hasLeaf ? stroked(kDoorColor, 2.6) : stroked(kDoorColor, 1.2, {1.0, 3.0})));
    if (!plan.swing.empty()) shapes.emplace_back(line(plan.swing, stroked(kDoorColor, 0.7)));
    return shapes;
  }

  /// The flight with its treads, and an arrow uphill.
  std::vector<Shape> operator()(const map::Staircase& stairs) const {
    constexpr double kUsualDepth = 0.28;
    constexpr double kUsualHeight = 0.17;
    const double depth = stairs.stepDepth > 0 ? stairs.stepDepth : kUsualDepth;
    const double rise = stairs.stepHeight > 0 ? stairs.stepHeight : kUsualHeight;
    const int steps =
        stairs.stepCount > 0 ? stairs.stepCount : std::clamp(static_cast<int>(std::abs(stairs.height) / rise), 3, 30);
    const double x = steps * depth / 2;
    const double y = stairs.stepWidth / 2;
    std::vector<Shape> shapes = {line({{-x, -y}, {x, -y}, {x, y}, {-x, y}},
                                      filledAndStroked(withAlpha(kStairsColor, 0.12), kStairsColor, 1.0), true)};
    for (int step = 1; step < steps; ++step) {
      const double edge = -x + step * depth;
      shapes.emplace_back(line({{edge, -y}, {edge, y}}, stroked(withAlpha(kStairsColor, 0.6), 0.7)));
    }
    const double tip = std::min(0.4, x / 2);
    shapes.emplace_back(line({{-0.85 * x, 0}, {0.85 * x, 0}}, stroked(kStairsColor, 1.6)));
    shapes.emplace_back(
        line({{0.85 * x - tip, 0.6 * tip}, {0.85 * x, 0}, {0.85 * x - tip, -0.6 * tip}}, stroked(kStairsColor, 1.6)));
    return shapes;
  }

  /// A head, and a stroke to where the person faces.
  std::vector<Shape> operator()(const map::Human& /*human*/) const {
    const double radius = std::max(3.0, 0.2 * scale());
    const Style head = filledAndStroked(kHumanColor, kFreeColor, 1.0);
    return {line({{0, 0}, {2.0 * radius / scale(), 0}}, stroked(kHumanColor, 0.5 * radius)),
            Circle{.centre = at(0, 0), .radius = radius, .style = head}};
  }

  std::vector<Shape> operator()(const map::ObjectBox& object) const { return {box(object.size, kHumanColor)}; }

  std::vector<Shape> operator()(const map::Cuboid& cuboid) const { return {box(cuboid.size, kObjectColor)}; }

  /// Seen from above by its outline; where it is steep, that is all but a line.
  std::vector<Shape> operator()(const map::PlanePatch& patch) const {
    return {line(patch.outline_in_patch, stroked(withAlpha(kObjectColor, 0.7), 0.8), true)};
  }
};

/// The entity's x-y-plane as it looks from above.
Eigen::Affine2d pageOf(const Panel& panel, const geometry::Pose3& T_map_entity) {
  Eigen::Affine2d T_page_entity = Eigen::Affine2d::Identity();
  T_page_entity.linear() = panel.scale * T_map_entity.linear().topLeftCorner<2, 2>();
  T_page_entity.linear().row(1) *= -1.0;  // y points down on the page
  T_page_entity.translation() = panel.toPage(T_map_entity.translation());
  return T_page_entity;
}

}  // namespace

std::vector<Shape> entitySymbol(const map::EntityAttributes& attributes, const Eigen::Affine2d& T_page_entity) {
  return std::visit(Symbol{T_page_entity}, attributes);
}

Group drawEntities(const PlanContents& plan) {
  Group group{"entities"};
  for (const auto& entity : plan.view.entities()) {
    const auto T_map_entity = poseInMap(plan.view, entity);
    auto symbol = entitySymbol(entity.attributes, pageOf(*plan.getNode(entity.submap).panel, T_map_entity));
    std::ranges::move(symbol, std::back_inserter(group.shapes));
  }
  return group;
}

}  // namespace prodomos::exporter

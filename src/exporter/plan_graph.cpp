// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/contents.hpp"
#include "exporter/palette.hpp"
#include "exporter/plan.hpp"
#include "exporter/text.hpp"

#include <algorithm>
#include <array>

namespace prodomos::exporter {
namespace {

constexpr double kRadiusForText = 8.0;  // ids stand within circles from this size on, else beside them

std::string tipOf(const PlanContents& plan, const map::Node& node) {
  std::string tip = toString(node.id) + ", " + std::string(toString(node.kind));
  if (node.place) tip += ", place " + std::to_string(*node.place);
  if (const auto* prediction = predictionOf(plan.view, node.id)) {
    return tip + ", probability " + fixed(prediction->probability, 2);
  }
  return tip + ", " + std::to_string(node.readings) + " readings, " + fixed(node.distance, 1) + " m";
}

Style styleOf(const map::Node& node) {
  return node.kind == map::SubMapKind::kPredicted ? predictedNodeStyle() : observedNodeStyle(node.place);
}

/// Finds room for words: what is placed once is not drawn over.
class LabelPlacer {
 public:
  explicit LabelPlacer(const PlanContents& plan) : plan_(plan) {
    const Point half = Point::Constant(plan.nodeRadius);
    for (const auto& placed : plan.nodes) taken_.emplace_back(placed.at - half, placed.at + half);
  }

  /// The base line's start for text beside a circle; none where all around is crowded.
  std::optional<Point> place(const PlacedNode& placed, const std::string& text, double size) {
    const Point extent(textWidth(text, size), size);
    const double gap = plan_.nodeRadius + 3.5;
    const std::array<Point, 8> lowerLeft = {{{gap, 0.35 * size},
                                             {-gap - extent.x(), 0.35 * size},
                                             {-extent.x() / 2, -gap},
                                             {-extent.x() / 2, gap + 0.75 * size},
                                             {0.7 * gap, -0.7 * gap},
                                             {0.7 * gap, 0.7 * gap + 0.75 * size},
                                             {-0.7 * gap - extent.x(), -0.7 * gap},
                                             {-0.7 * gap - extent.x(), 0.7 * gap + 0.75 * size}}};
    for (const auto& offset : lowerLeft) {
      const Point start = placed.at + offset;
      const Eigen::AlignedBox2d box(start + Point(0.0, -0.8 * size), start + Point(extent.x(), 0.1 * size));
      if (!isFree(box) || !isOn(*placed.panel, box)) continue;
      taken_.push_back(box);
      return start;
    }
    return std::nullopt;
  }

 private:
  bool isFree(const Eigen::AlignedBox2d& box) const {
    for (const auto& other : taken_) {
      if (box.intersects(other)) return false;
    }
    return true;
  }
  static bool isOn(const Panel& panel, const Eigen::AlignedBox2d& box) {
    return Eigen::AlignedBox2d(panel.corner, panel.corner + Point(panel.width(), panel.height())).contains(box);
  }

  const PlanContents& plan_;
  std::vector<Eigen::AlignedBox2d> taken_;
};

}  // namespace

Style edgeStyle(map::EdgeKind kind) {
  switch (kind) {
    case map::EdgeKind::kTravelled:
      return stroked(kInkColor, 1.6);
    case map::EdgeKind::kDoor:
      return stroked(kDoorColor, 2.0, {6.0, 4.0});
    case map::EdgeKind::kStairs:
      return stroked(kStairsColor, 2.0, {8.0, 4.0, 1.0, 4.0});
    case map::EdgeKind::kLoop:
      return stroked(kLoopColor, 1.4, {1.0, 3.5});
    case map::EdgeKind::kLift:
      return stroked(kStairsColor, 2.0, {1.0, 4.5});
    case map::EdgeKind::kOverlap:
      return stroked(kOverlapColor, 0.8, {1.0, 3.5});
  }
  return {};
}

Style observedNodeStyle(std::optional<int> place) {
  return filledAndStroked(placeColor(place), kFreeColor, 1.2);
}

Style predictedNodeStyle() {
  return filledAndStroked(kFreeColor, kPredictedColor, 1.6, {3.0, 2.5});
}

Group drawEdges(const PlanContents& plan) {
  const double thin = std::clamp(plan.nodeRadius / 9.0, 0.6, 1.0);  // where nodes are small, edges are thin
  Group group{"edges"};
  for (const auto id : plan.view.graph().edges()) {
    const auto& edge = plan.view.graph().getEdge(id);
    auto style = edgeStyle(edge.kind);
    const bool predicted = plan.getNode(edge.from).node.kind == map::SubMapKind::kPredicted ||
                           plan.getNode(edge.to).node.kind == map::SubMapKind::kPredicted;
    if (predicted) style = stroked(kPredictedColor, 1.6, {4.0, 4.0});
    style.width *= thin;
    if (plan.getNode(edge.from).panel != plan.getNode(edge.to).panel) {  // it runs over things it has no part in
      style.width *= 0.6;
      style.stroke = withAlpha(*style.stroke, 0.5);
    }
    group.shapes.emplace_back(Line{.points = {plan.getNode(edge.from).at, plan.getNode(edge.to).at},
                                   .style = style,
                                   .tip = toString(id) + ", " + std::string(toString(edge.kind))});
  }
  return group;
}

Group drawNodes(const PlanContents& plan) {
  Group group{"nodes"};
  for (const auto& placed : plan.nodes) {
    group.shapes.emplace_back(Circle{.centre = placed.at,
                                     .radius = plan.nodeRadius,
                                     .style = styleOf(placed.node),
                                     .tip = tipOf(plan, placed.node)});
  }
  return group;
}

Group drawLabels(const PlanContents& plan) {
  Group group{"labels"};
  LabelPlacer placer(plan);
  for (const auto& placed : plan.nodes) {
    const bool predicted = placed.node.kind == map::SubMapKind::kPredicted;
    const auto color = predicted ? kPredictedColor : kInkColor;
    const std::string number = std::to_string(placed.node.id.value);
    if (plan.nodeRadius >= kRadiusForText) {
      const double size = plan.nodeRadius * (number.size() < 3 ? 1.0 : 2.6 / static_cast<double>(number.size()));
      group.shapes.emplace_back(Text{.at = placed.at + Point(0.0, 0.36 * size),
                                     .text = number,
                                     .size = size,
                                     .color = predicted ? kPredictedColor : kFreeColor,
                                     .anchor = Anchor::kMiddle,
                                     .bold = true});
      continue;
    }
    constexpr double kSize = 8.5;
    if (const auto start = placer.place(placed, number, kSize)) {
      group.shapes.emplace_back(Text{.at = *start, .text = number, .size = kSize, .color = color, .halo = true});
    }
  }
  for (const auto& placed : plan.nodes) {
    if (placed.node.kind != map::SubMapKind::kPredicted) continue;
    const auto* const prediction = predictionOf(plan.view, placed.node.id);
    if (prediction == nullptr) continue;
    constexpr double kSize = 10.0;
    const std::string text = "p = " + fixed(prediction->probability, 2);
    if (const auto start = placer.place(placed, text, kSize)) {
      group.shapes.emplace_back(
          Text{.at = *start, .text = text, .size = kSize, .color = kPredictedColor, .halo = true});
    }
  }
  return group;
}

}  // namespace prodomos::exporter

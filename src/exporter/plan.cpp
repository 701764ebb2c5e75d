// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/plan.hpp"

#include "exporter/contents.hpp"
#include "exporter/formats.hpp"
#include "exporter/palette.hpp"
#include "exporter/text.hpp"
#include "exporter/write_file.hpp"

#include <algorithm>
#include <numeric>

namespace prodomos::exporter {
namespace {

constexpr double kMargin = 28.0;
constexpr double kHeader = 62.0;
constexpr double kFloorTitle = 22.0;
constexpr double kBetweenPanels = 28.0;
constexpr double kMapWidth = 1500.0;   // the most that all panels take
constexpr double kMapHeight = 1000.0;  // the most that a panel takes
constexpr double kMostScale = 60.0;    // units a metre: small maps are not blown up
constexpr double kLeastPageWidth = 760.0;
constexpr double kPngScale = 2.0;  // sharp in print

Eigen::AlignedBox2d extentOf(const map::MapView& view, const std::vector<map::TrajectoryPoint>& trajectory,
                             const Panel& panel) {
  constexpr double kRim = 0.75;  // metres
  Eigen::AlignedBox2d extent;
  const auto box = panel.grid.knownBox();
  if (!box.empty()) {
    const double resolution = panel.grid.resolution();
    extent.extend(resolution * Eigen::Vector2d(box.first.x, box.first.y));
    extent.extend(resolution * Eigen::Vector2d(box.last.x + 1, box.last.y + 1));
  }
  const auto& graph = view.graph();
  const auto extendTo = [&extent](const Eigen::Vector3d& point) { extent.extend(Eigen::Vector2d(point.head<2>())); };
  for (const auto id : graph.nodes()) {
    const auto& node = graph.getNode(id);
    if (onFloor(node.floor, panel.floor)) extendTo(node.T_map_submap.translation());
  }
  for (const auto& point : trajectory) {
    const auto* const node = graph.findNode(point.submap);
    if (node != nullptr && onFloor(node->floor, panel.floor)) extendTo(point.T_map_body.translation());
  }
  for (const auto& prediction : view.predictions()) {
    const auto* const node = graph.findNode(prediction.node);
    const bool isOpen = prediction.state == map::PredictionState::kOpen;
    if (node == nullptr || !isOpen || !onFloor(node->floor, panel.floor)) continue;
    const auto extendAll = [&](const std::vector<Eigen::Vector2d>& outline_in_node) {
      for (const auto& corner : outline_in_node) {
        extendTo(node->T_map_submap * Eigen::Vector3d(corner.x(), corner.y(), 0.0));
      }
    };
    extendAll(prediction.room_in_node);
    for (const auto& area : prediction.areas) extendAll(area.outline_in_node);
  }
  if (extent.isEmpty()) extent.extend(Eigen::Vector2d::Zero());
  return {extent.min().array() - kRim, extent.max().array() + kRim};
}

std::vector<Panel> panelsOf(const map::MapView& view, const std::vector<map::TrajectoryPoint>& trajectory) {
  std::vector<Panel> panels;
  for (const auto floor : floorsOf(view)) {
    Panel panel{.floor = floor, .grid = map::fuseGrids(view, floor)};
    panel.extent_in_map = extentOf(view, trajectory, panel);
    panels.push_back(std::move(panel));
  }
  double width = 0.0;
  double height = 0.0;
  for (const auto& panel : panels) {
    width += panel.extent_in_map.sizes().x();
    height = std::max(height, panel.extent_in_map.sizes().y());
  }
  const double scale = std::min({kMapWidth / width, kMapHeight / height, kMostScale});
  double left = kMargin;
  for (auto& panel : panels) {
    panel.scale = scale;
    panel.corner = {left, kHeader + (panels.size() > 1 ? kFloorTitle : 0.0)};
    left += panel.width() + kBetweenPanels;
  }
  return panels;
}

/// So that circles seldom touch: by the median distance from a node to the nearest other one.
double nodeRadiusFor(const std::vector<PlacedNode>& nodes) {
  constexpr double kLeast = 3.5;
  constexpr double kMost = 11.0;
  std::vector<double> nearest;
  for (const auto& node : nodes) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& other : nodes) {
      if (other.node.id != node.node.id && other.panel == node.panel)
        least = std::min(least, (other.at - node.at).norm());
    }
    nearest.push_back(least);
  }
  if (nearest.empty()) return kMost;
  const auto middle = nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2);
  std::ranges::nth_element(nearest, middle);
  return std::clamp(0.42 * *middle, kLeast, kMost);
}

PlanContents contentsOf(const map::MapView& view) {
  PlanContents plan{.view = view, .trajectory = view.trajectory()};
  plan.panels = panelsOf(view, plan.trajectory);
  for (const auto id : view.graph().nodes()) {
    const auto& node = view.graph().getNode(id);
    const auto panel = std::ranges::find_if(plan.panels, [&](const Panel& p) { return onFloor(node.floor, p.floor); });
    plan.nodes.push_back({node, &*panel, panel->toPage(node.T_map_submap.translation())});
  }
  plan.nodeRadius = nodeRadiusFor(plan.nodes);
  return plan;
}

std::string counted(std::size_t count, const std::string& singular, const std::string& plural) {
  return std::to_string(count) + ' ' + (count == 1 ? singular : plural);
}

std::string subtitle(const map::MapView& view) {
  const std::size_t observed = observedNodes(view).size();
  const std::size_t all = view.graph().nodes().size();
  double distance = 0.0;
  for (const auto& session : view.sessions()) distance += session.distance;
  std::string text = counted(observed, "sub-map", "sub-maps");
  if (all > observed) text += " · " + std::to_string(all - observed) + " predicted";
  text += " · " + counted(view.graph().edges().size(), "edge", "edges");
  text += " · " + counted(view.graph().places().size(), "place", "places");
  if (!view.entities().empty()) text += " · " + counted(view.entities().size(), "entity", "entities");
  return text + " · " + fixed(distance, 1) + " m travelled";
}

Group drawHeader(const PlanContents& plan) {
  Group group{"title"};
  group.shapes.emplace_back(
      Text{.at = {kMargin, 34.0}, .text = logNames(plan.view), .size = 20.0, .color = kInkColor, .bold = true});
  group.shapes.emplace_back(
      Text{.at = {kMargin, 53.0}, .text = subtitle(plan.view), .size = 12.0, .color = kMutedColor});
  if (plan.panels.size() < 2) return group;
  for (const auto& panel : plan.panels) {
    group.shapes.emplace_back(Text{.at = panel.corner + Point(0.0, -7.0),
                                   .text = "floor " + std::to_string(*panel.floor),
                                   .size = 12.0,
                                   .color = kInkColor,
                                   .bold = true});
  }
  return group;
}

}  // namespace

const PlacedNode& PlanContents::getNode(base::SubMapId id) const {
  return *std::ranges::lower_bound(nodes, id, {}, [](const PlacedNode& placed) { return placed.node.id; });
}

Picture planOf(const map::MapView& view) {
  const auto plan = contentsOf(view);
  const auto& last = plan.panels.back();
  const double right = std::max(last.corner.x() + last.width(), kLeastPageWidth - kMargin);
  double bottom = 0.0;
  for (const auto& panel : plan.panels) bottom = std::max(bottom, panel.corner.y() + panel.height());
  auto [legend, legendHeight] = drawLegend(plan, kMargin, bottom + 18.0, right - kMargin);

  Picture picture{.width = std::ceil(right + kMargin),
                  .height = std::ceil(bottom + 18.0 + legendHeight + kMargin / 2),
                  .title = logNames(view)};
  const Line paper{.points = {{0, 0}, {picture.width, 0}, {picture.width, picture.height}, {0, picture.height}},
                   .closed = true,
                   .style = filled(kFreeColor)};
  picture.groups.push_back({"paper", {paper}});
  picture.groups.push_back(drawHeader(plan));
  for (const auto draw :
       {drawGrids, drawPredictedAreas, drawTrajectory, drawTrails, drawEdges, drawEntities, drawNodes, drawLabels}) {
    picture.groups.push_back(draw(plan));
  }
  picture.groups.push_back(std::move(legend));
  return picture;
}

void writeSvg(const map::MapView& view, const Path& path) {
  writeFile(path, toSvg(planOf(view)));
}

void writePng(const map::MapView& view, const Path& path) {
  writeFile(path, toPng(planOf(view), kPngScale));
}

}  // namespace prodomos::exporter

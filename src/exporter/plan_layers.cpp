// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/polygon.hpp"

#include "exporter/contents.hpp"
#include "exporter/palette.hpp"
#include "exporter/plan.hpp"
#include "exporter/text.hpp"

#include <algorithm>
#include <cmath>

namespace prodomos::exporter {
namespace {

/// Of a block of cells: a wall stays visible however small the plan.
map::CellState stateOfBlock(const map::OccupancyGrid& grid, geometry::CellIndex first, int size) {
  auto state = map::CellState::kUnknown;
  for (int y = first.y; y < first.y + size; ++y) {
    for (int x = first.x; x < first.x + size; ++x) state = std::max(state, grid.state({x, y}));
  }
  return state;
}
static_assert(map::CellState::kUnknown < map::CellState::kFree && map::CellState::kFree < map::CellState::kOccupied);

map::Rgba colorOf(map::CellState state) {
  switch (state) {
    case map::CellState::kFree:
      return kFreeColor;
    case map::CellState::kOccupied:
      return kOccupiedColor;
    case map::CellState::kUnknown:
      break;
  }
  return kUnknownColor;
}

Line frameOf(const Panel& panel, Style style) {
  const Point across(panel.width(), 0.0);
  const Point down(0.0, panel.height());
  return {.points = {panel.corner, panel.corner + across, panel.corner + across + down, panel.corner + down},
          .closed = true,
          .style = std::move(style)};
}

/// One pixel a block of cells, blocks being as large as half a unit of the page: finer would not be seen.
std::optional<Raster> gridRaster(const Panel& panel) {
  const auto box = panel.grid.knownBox();
  if (box.empty()) return std::nullopt;
  const double resolution = panel.grid.resolution();
  const int block = std::max(1, static_cast<int>(std::floor(0.5 / (resolution * panel.scale))));
  const int width = (box.width() + block - 1) / block;
  const int height = (box.height() + block - 1) / block;
  sensors::Image<map::Rgba> pixels(width, height);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const geometry::CellIndex first{box.first.x + column * block, box.first.y + (height - 1 - row) * block};
      pixels(column, row) = colorOf(stateOfBlock(panel.grid, first, block));
    }
  }
  const Eigen::Vector2d corner_in_map(box.first.x * resolution, (box.first.y + height * block) * resolution);
  return Raster{panel.toPage(corner_in_map), block * resolution * panel.scale, pixels};
}

std::string nameOf(const map::Prediction& prediction) {
  return toString(prediction.id) + ": " + std::string(toString(prediction.state)) + ", probability " +
         fixed(prediction.probability, 2);
}

}  // namespace

Group drawGrids(const PlanContents& plan) {
  Group group{"grid"};
  for (const auto& panel : plan.panels) {
    group.shapes.emplace_back(frameOf(panel, filled(kUnknownColor)));
    if (const auto raster = gridRaster(panel)) group.shapes.emplace_back(*raster);
    group.shapes.emplace_back(frameOf(panel, stroked(withAlpha(kMutedColor, 0.5), 0.6)));
  }
  return group;
}

Group drawPredictedAreas(const PlanContents& plan) {
  Group group{"predicted-areas"};
  const auto addOutline = [&](const map::Prediction& prediction, const geometry::Polygon& outline_in_node, Line line) {
    const auto& placed = plan.getNode(prediction.node);
    for (const auto& corner : geometry::transformed(placed.node.T_map_submap, outline_in_node)) {
      line.points.push_back(placed.panel->toPage(corner));
    }
    if (line.points.size() > 2) group.shapes.emplace_back(std::move(line));
  };
  for (const auto& prediction : plan.view.predictions()) {
    if (prediction.state != map::PredictionState::kOpen) continue;  // of the others, one has seen what is there
    addOutline(prediction, prediction.room_in_node,
               {.closed = true,
                .style = filledAndStroked(withAlpha(kPredictedColor, 0.06), kPredictedColor, 0.9, {1.5, 2.5}),
                .tip = nameOf(prediction) + ", likely room of " + brief(std::round(prediction.expectedArea)) + " m²"});
    const auto color = prediction.isConditional() ? kHumanColor : kPredictedColor;
    const std::string condition = prediction.isConditional() ? ", free if the person leaves" : "";
    for (const auto& area : prediction.areas) {
      addOutline(prediction, area.outline_in_node,
                 {.closed = true,
                  .style = filledAndStroked(withAlpha(color, 0.13), color, 1.1, {5.0, 3.0}),
                  .tip = nameOf(prediction) + condition + ", threshold " + brief(area.threshold)});
    }
  }
  return group;
}

Group drawTrajectory(const PlanContents& plan) {
  constexpr double kLeastStep = 0.6;  // units of the page; less would not be seen
  Group group{"trajectory"};
  Line line{.style = stroked(withAlpha(kTrajectoryColor, 0.75), 1.0)};
  const auto finish = [&] {
    if (line.points.size() > 1) group.shapes.emplace_back(line);
    line.points.clear();
  };
  const Panel* panel = nullptr;
  base::SessionId session;
  for (const auto& point : plan.trajectory) {
    if (!plan.view.graph().hasNode(point.submap)) continue;
    const auto& placed = plan.getNode(point.submap);
    if (placed.panel != panel || point.session != session) finish();
    panel = placed.panel;
    session = point.session;
    const Point at = panel->toPage(point.T_map_body.translation());
    if (line.points.empty() || (at - line.points.back()).norm() >= kLeastStep) line.points.push_back(at);
  }
  finish();
  return group;
}

Group drawTrails(const PlanContents& plan) {
  Group group{"trails"};
  for (const auto& trail : trailsOf(plan.view)) {
    Line line{.style = stroked(withAlpha(kHumanColor, 0.6), 1.2, {0.5, 2.5})};
    const auto& panel = *plan.getNode(trail.submap).panel;
    for (const auto& point : trail.points_in_map) line.points.push_back(panel.toPage(point));
    group.shapes.emplace_back(std::move(line));
  }
  return group;
}

}  // namespace prodomos::exporter

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/fused_grid.hpp"
#include "prodomos/map/map_view.hpp"

#include "exporter/picture.hpp"

#include <Eigen/Geometry>

/// The plan of a map, its floors side by side: fused grid, graph, trajectory, entities, predictions, legend.
namespace prodomos::exporter {

Picture planOf(const map::MapView& view);

/// One floor on the page.
struct Panel {
  std::optional<int> floor;
  map::OccupancyGrid grid;
  Eigen::AlignedBox2d extent_in_map{};  ///< metres
  Point corner = Point::Zero();         ///< upper left, on the page
  double scale = 1.0;                   ///< units of the page a metre

  double width() const { return extent_in_map.sizes().x() * scale; }
  double height() const { return extent_in_map.sizes().y() * scale; }
  /// A point of the map, 2D or 3D seen from above.
  template <typename Derived>
  Point toPage(const Eigen::MatrixBase<Derived>& point_in_map) const {
    return corner +
           scale * Point(point_in_map.x() - extent_in_map.min().x(), extent_in_map.max().y() - point_in_map.y());
  }
};

/// A sub-map on the page. One without a floor stands on the first panel.
struct PlacedNode {
  map::Node node;
  const Panel* panel = nullptr;
  Point at = Point::Zero();
};

/// What the parts of the plan are drawn from.
struct PlanContents {
  const map::MapView& view;
  std::vector<map::TrajectoryPoint> trajectory{};
  std::vector<Panel> panels{};
  std::vector<PlacedNode> nodes{};  ///< ascending
  double nodeRadius = 8.0;

  const PlacedNode& getNode(base::SubMapId id) const;
};

// The parts, each a layer of the drawing; each in a file of its own or with its likes.
Group drawGrids(const PlanContents& plan);
Group drawPredictedAreas(const PlanContents& plan);
Group drawTrajectory(const PlanContents& plan);
Group drawTrails(const PlanContents& plan);
Group drawEntities(const PlanContents& plan);
Group drawEdges(const PlanContents& plan);
Group drawNodes(const PlanContents& plan);
Group drawLabels(const PlanContents& plan);
/// A scale bar and what is explained beside it; grows downwards from `top`. Returns its height too.
std::pair<Group, double> drawLegend(const PlanContents& plan, double left, double top, double width);

Style edgeStyle(map::EdgeKind kind);
Style observedNodeStyle(std::optional<int> place);
Style predictedNodeStyle();
/// The symbol of the entity; `T_page_entity` carries its metres (x ahead, y to the left) onto the page.
std::vector<Shape> entitySymbol(const map::EntityAttributes& attributes, const Eigen::Affine2d& T_page_entity);

}  // namespace prodomos::exporter

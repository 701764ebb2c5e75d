// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/scene3d.hpp"

#include "prodomos/map/fused_grid.hpp"

#include "exporter/contents.hpp"
#include "exporter/drawn_objects.hpp"
#include "exporter/entity_drawing.hpp"
#include "exporter/formats.hpp"
#include "exporter/mrpt_file.hpp"
#include "exporter/palette.hpp"

#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSphere.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace prodomos::exporter {
namespace {

using Eigen::Vector3d;
using mrpt::opengl::CSetOfObjects;

constexpr double kNodeHeight = 1.6;         // above the floor: over what is seen, below the next floor
constexpr double kNodeRadius = 0.22;        // metres; more on large maps
constexpr double kNodeShare = 0.0055;       // of the map's diagonal
constexpr double kTrajectoryHeight = 0.03;  // above the floor
constexpr double kPlaneDepth = 0.08;        // below the points of lasers whose height a log does not know
constexpr double kPlaneShare = 0.003;       // of the map's diagonal: depth is coarse where the camera stands far off

Vector3d lifted(const map::Node& node) {
  return node.T_map_submap * Vector3d(0.0, 0.0, kNodeHeight);
}

CSetOfObjects::Ptr group(const std::string& name) {
  auto objects = CSetOfObjects::Create();
  objects->setName(name);
  return objects;
}

double heightOf(const map::MapView& view, std::optional<int> floor) {
  const auto row = std::ranges::find_if(view.floors(), [&](const auto& each) { return each.number == floor; });
  return row == view.floors().end() ? 0.0 : row->height;
}

Eigen::AlignedBox3d extentOf(const map::OccupancyGrid& grid, double height) {
  geometry::CellBox walls;
  const auto known = grid.knownBox();
  for (int y = known.first.y; y <= known.last.y; ++y) {
    for (int x = known.first.x; x <= known.last.x; ++x) {
      if (grid.state({x, y}) == map::CellState::kOccupied) walls.add({x, y});
    }
  }
  Eigen::AlignedBox3d extent;
  if (walls.empty()) return extent;
  extent.extend(Vector3d(walls.first.x * grid.resolution(), walls.first.y * grid.resolution(), height));
  extent.extend(Vector3d((walls.last.x + 1) * grid.resolution(), (walls.last.y + 1) * grid.resolution(), height));
  return extent;
}

/// The fused grid of each floor, at its height.
CSetOfObjects::Ptr floorObjects(const map::MapView& view, const Pen& pen, Eigen::AlignedBox3d& extent) {
  auto objects = group("floors");
  for (const auto floor : floorsOf(view)) {
    const auto grid = map::fuseGrids(view, floor);
    const double height = heightOf(view, floor);
    extent.extend(extentOf(grid, height));
    auto plane = toObjects(grid.draw(), pen);
    plane->setLocation(0.0, 0.0, height - std::max(kPlaneDepth, kPlaneShare * extent.diagonal().norm()));
    objects->insert(plane);
  }
  return objects;
}

/// What the layers of the sub-maps draw; the grids are in the floors already.
CSetOfObjects::Ptr layerObjects(const map::MapView& view, const Pen& pen) {
  auto objects = group("layers");
  for (const auto& node : observedNodes(view)) {
    for (const auto& type : view.layersOf(node.id)) {
      const auto layer = type == map::OccupancyGrid::kTypeId ? nullptr : view.findLayer(node.id, type);
      if (!layer) continue;
      auto drawn = toObjects(layer->draw(), pen);
      drawn->setName(toString(node.id) + " " + type);
      drawn->setPose(toMrpt(node.T_map_submap));
      objects->insert(drawn);
    }
  }
  return objects;
}

CSetOfObjects::Ptr entityObjects(const map::MapView& view, const Pen& pen) {
  auto objects = group("entities");
  for (const auto& entity : view.entities()) {
    auto drawn = toObjects(drawEntity(entity), pen);
    drawn->setName(toString(entity.id));
    drawn->setPose(toMrpt(view.graph().getNode(entity.submap).T_map_submap));
    objects->insert(drawn);
  }
  return objects;
}

/// Outlines of the floor that is expected and not seen.
CSetOfObjects::Ptr predictionObjects(const map::MapView& view, const Pen& pen) {
  auto objects = group("predictions");
  for (const auto& prediction : view.predictions()) {
    const auto* node = view.graph().findNode(prediction.node);
    if (node == nullptr || prediction.state != map::PredictionState::kOpen) continue;
    const auto color = prediction.isConditional() ? kHumanColor : kPredictedColor;
    map::Drawing drawing;
    for (const auto& area : prediction.areas) {
      map::DrawnLine outline{{}, color, ""};
      for (const auto& point : area.outline_in_node) outline.points_in_submap.emplace_back(point.x(), point.y(), 0.02);
      if (!outline.points_in_submap.empty()) outline.points_in_submap.push_back(outline.points_in_submap.front());
      drawing.lines.push_back(std::move(outline));
    }
    auto drawn = toObjects(drawing, pen);
    drawn->setName(toString(prediction.id));
    drawn->setPose(toMrpt(node->T_map_submap));
    objects->insert(drawn);
  }
  return objects;
}

CSetOfObjects::Ptr trajectoryObjects(const map::MapView& view, const Pen& pen) {
  auto objects = group("trajectory");
  std::map<base::SessionId, map::DrawnLine> lines;
  for (const auto& point : view.trajectory()) {
    auto& line = lines.try_emplace(point.session, map::DrawnLine{{}, kTrajectoryColor, ""}).first->second;
    line.points_in_submap.emplace_back(point.T_map_body * Vector3d(0.0, 0.0, kTrajectoryHeight));
  }
  for (auto& [session, line] : lines) {
    map::Drawing drawing;
    drawing.lines.push_back(std::move(line));
    auto drawn = toObjects(drawing, pen);
    drawn->setName(toString(session));
    objects->insert(drawn);
  }
  return objects;
}

CSetOfObjects::Ptr trailObjects(const map::MapView& view, const Pen& pen) {
  auto objects = group("trails");
  for (const auto& trail : trailsOf(view)) {
    map::DrawnLine line{{}, kHumanColor, ""};
    for (const auto& point : trail.points_in_map) {
      line.points_in_submap.emplace_back(point + Vector3d(0.0, 0.0, kTrajectoryHeight));
    }
    map::Drawing drawing;
    drawing.lines.push_back(std::move(line));
    auto drawn = toObjects(drawing, pen);
    drawn->setName(toString(trail.track));
    objects->insert(drawn);
  }
  return objects;
}

map::Rgba edgeColor(map::EdgeKind kind) {
  switch (kind) {
    case map::EdgeKind::kTravelled:
      return kInkColor;
    case map::EdgeKind::kDoor:
      return kDoorColor;
    case map::EdgeKind::kStairs:
    case map::EdgeKind::kLift:
      return kStairsColor;
    case map::EdgeKind::kLoop:
      return kLoopColor;
    case map::EdgeKind::kOverlap:
      return kOverlapColor;
  }
  return kInkColor;
}

/// Nodes above their floors, each on a stem that stands on its origin, and the edges between them.
CSetOfObjects::Ptr graphObjects(const map::MapView& view, const Pen& pen, double radius) {
  auto objects = group("graph");
  map::Drawing stems;
  for (const auto id : view.graph().nodes()) {
    const auto& node = view.graph().getNode(id);
    const bool predicted = node.kind == map::SubMapKind::kPredicted;
    const auto color = predicted ? kPredictedColor : placeColor(node.place);
    auto sphere = mrpt::opengl::CSphere::Create(static_cast<float>(radius));
    sphere->setName(toString(id));
    sphere->setColor_u8(toMrpt(withAlpha(color, predicted ? 0.6 : 1.0)));
    sphere->setLocation(toMrpt(lifted(node)));
    objects->insert(sphere);
    stems.lines.push_back({{node.T_map_submap.translation(), lifted(node)}, kMutedColor, ""});
  }
  objects->insert(toObjects(stems, pen));
  for (const auto id : view.graph().edges()) {
    const auto& edge = view.graph().getEdge(id);
    const auto from = lifted(view.graph().getNode(edge.from));
    const auto to = lifted(view.graph().getNode(edge.to));
    auto line = mrpt::opengl::CSetOfLines::Create();
    line->setName(toString(id));
    line->setColor_u8(toMrpt(edgeColor(edge.kind)));
    line->setLineWidth(pen.line(4.0));
    line->appendLine(toMrpt(from), toMrpt(to));
    objects->insert(line);
  }
  return objects;
}

CSetOfObjects::Ptr labelObjects(const map::MapView& view, const Pen& pen, double radius) {
  auto objects = group("labels");
  for (const auto id : view.graph().nodes()) {
    const Vector3d above = lifted(view.graph().getNode(id)) + Vector3d(0.0, 0.0, 1.2 * radius);
    objects->insert(toLabel(toString(id), above, kInkColor, pen));
  }
  return objects;
}

}  // namespace

Scene makeScene(const map::MapView& view, const Pen& pen) {
  Scene scene{mrpt::opengl::COpenGLScene::Create(), {}};
  scene.objects->insert(floorObjects(view, pen, scene.extent_in_map));
  scene.objects->insert(layerObjects(view, pen));
  scene.objects->insert(predictionObjects(view, pen));
  scene.objects->insert(entityObjects(view, pen));
  scene.objects->insert(trajectoryObjects(view, pen));
  scene.objects->insert(trailObjects(view, pen));
  for (const auto id : view.graph().nodes()) scene.extent_in_map.extend(lifted(view.graph().getNode(id)));
  if (scene.extent_in_map.isEmpty()) scene.extent_in_map.extend(Vector3d::Zero());
  const double radius = std::max(kNodeRadius, kNodeShare * scene.extent_in_map.diagonal().norm());
  scene.objects->insert(graphObjects(view, pen, radius));
  scene.objects->insert(labelObjects(view, pen, radius));
  auto viewport = scene.objects->getViewport();
  viewport->setCustomBackgroundColor(mrpt::img::TColorf(toMrpt(kUnknownColor)));
  viewport->lightParameters().ambient = {0.65F, 0.65F, 0.65F, 1.0F};  // colours are read, not only shapes
  viewport->lightParameters().specular = {0.2F, 0.2F, 0.2F, 1.0F};
  return scene;
}

Viewpoint overview(const Eigen::AlignedBox3d& extent, double widthToHeight) {
  constexpr double kMargin = 1.06;
  constexpr auto kRadians = std::numbers::pi / 180.0;

  const Vector3d& least = extent.min();
  const Vector3d& most = extent.max();
  Viewpoint viewpoint{.target = extent.center(), .elevation = 55.0};
  // From the south, as a plan is read; long maps from their long side.
  viewpoint.azimuth = most.y() - least.y() > 1.2 * (most.x() - least.x()) ? 0.0 : -90.0;
  const double azimuth = viewpoint.azimuth * kRadians;
  const double elevation = viewpoint.elevation * kRadians;
  const Vector3d back(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                      std::sin(elevation));
  const Vector3d right = Vector3d::UnitZ().cross(back).normalized();
  const Vector3d up = back.cross(right);

  const double tangent = std::tan(0.5 * viewpoint.fieldOfView * kRadians);
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d point((corner & 1) != 0 ? most.x() : least.x(), (corner & 2) != 0 ? most.y() : least.y(),
                         (corner & 4) != 0 ? most.z() : least.z());
    const Vector3d offset = point - viewpoint.target;
    const double aside = std::max(std::abs(offset.dot(up)), std::abs(offset.dot(right)) / widthToHeight);
    viewpoint.distance = std::max(viewpoint.distance, offset.dot(back) + kMargin * aside / tangent);
  }
  return viewpoint;
}

void setCamera(mrpt::opengl::COpenGLScene& scene, const Viewpoint& viewpoint) {
  auto viewport = scene.getViewport();
  auto& camera = viewport->getCamera();
  camera.setProjectiveFOVdeg(static_cast<float>(viewpoint.fieldOfView));
  camera.setPointingAt(toMrpt(viewpoint.target));
  camera.setAzimuthDegrees(static_cast<float>(viewpoint.azimuth));
  camera.setElevationDegrees(static_cast<float>(viewpoint.elevation));
  camera.setZoomDistance(static_cast<float>(viewpoint.distance));
  viewport->setViewportClipDistances(static_cast<float>(viewpoint.leastDepth()),
                                     static_cast<float>(viewpoint.greatestDepth()));
}

void writeScene3d(const map::MapView& view, const Path& path) {
  const auto scene = makeScene(view);
  setCamera(*scene.objects, overview(scene.extent_in_map, 1.6));
  writeMrptFile(path, *scene.objects);
}

}  // namespace prodomos::exporter

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/contents.hpp"
#include "exporter/formats.hpp"
#include "exporter/json.hpp"
#include "exporter/text.hpp"
#include "exporter/write_file.hpp"

#include <string>

namespace prodomos::exporter {
namespace {

Json coordinates(const Eigen::Vector3d& point) {
  return array(point);
}

Json feature(const std::string& id, std::string_view geometryType, Json coordinates, Json properties) {
  return {{"type", "Feature"},
          {"id", id},
          {"geometry", {{"type", geometryType}, {"coordinates", std::move(coordinates)}}},
          {"properties", std::move(properties)}};
}

Json nodeFeature(const map::Node& node) {
  return feature(toString(node.id), "Point", coordinates(node.T_map_submap.translation()),
                 {{"feature", "node"},
                  {"name", toString(node.id)},
                  {"kind", toString(node.kind)},
                  {"floor", optionalJson(node.floor)},
                  {"place", optionalJson(node.place)},
                  {"yaw", number(geometry::yaw(node.T_map_submap))}});
}

Json edgeFeature(const map::TopologicalGraph& graph, const map::Edge& edge) {
  const Json ends = {coordinates(graph.getNode(edge.from).T_map_submap.translation()),
                     coordinates(graph.getNode(edge.to).T_map_submap.translation())};
  return feature(toString(edge.id), "LineString", ends,
                 {{"feature", "edge"},
                  {"name", toString(edge.id)},
                  {"kind", toString(edge.kind)},
                  {"from", toString(edge.from)},
                  {"to", toString(edge.to)},
                  {"cause", optionalJson(edge.cause)}});
}

Json entityFeature(const map::MapView& view, const map::Entity& entity) {
  const auto pose = poseInMap(view, entity);
  return feature(toString(entity.id), "Point", coordinates(pose.translation()),
                 {{"feature", "entity"},
                  {"name", toString(entity.id)},
                  {"class", map::className(entity.attributes)},
                  {"submap", toString(entity.submap)},
                  {"floor", optionalJson(view.graph().getNode(entity.submap).floor)},
                  {"yaw", number(geometry::yaw(pose))},
                  {"attributes", Json::parse(map::toJson(entity.attributes))}});
}

Json areaFeature(const map::MapView& view, const map::Prediction& prediction, const map::PredictedArea& area) {
  const geometry::Pose3 T_map_node = view.T_map_node(prediction);
  Json ring = Json::array();
  for (const auto& corner : area.outline_in_node) {
    ring.push_back(coordinates(T_map_node * Eigen::Vector3d(corner.x(), corner.y(), 0.0)));
  }
  if (!ring.empty()) ring.push_back(Json(ring.front()));
  const std::string id = toString(prediction.id) + '@' + brief(area.threshold);
  return feature(id, "Polygon", Json::array({std::move(ring)}),
                 {{"feature", "predicted_area"},
                  {"name", toString(prediction.id)},
                  {"state", toString(prediction.state)},
                  {"probability", number(prediction.probability)},
                  {"if_person_leaves", prediction.isConditional()},
                  {"threshold", number(area.threshold)},
                  {"node", toString(prediction.node)},
                  {"floor", optionalJson(floorOf(view, prediction))}});
}

/// A line a session.
Json trajectoryFeatures(const map::MapView& view) {
  Json lines = Json::array();
  const auto trajectory = view.trajectory();
  for (const auto& session : view.sessions()) {
    Json line = Json::array();
    for (const auto& point : trajectory) {
      if (point.session == session.id) line.push_back(coordinates(point.T_map_body.translation()));
    }
    if (line.size() < 2) continue;  // GeoJSON's lines have two points or more
    lines.push_back(
        feature(toString(session.id), "LineString", std::move(line),
                {{"feature", "trajectory"}, {"name", fileName(session.log)}, {"distance", number(session.distance)}}));
  }
  return lines;
}

Json trailFeature(const Trail& trail) {
  Json line = Json::array();
  for (const auto& point : trail.points_in_map) line.push_back(coordinates(point));
  return feature(toString(trail.track), "LineString", std::move(line),
                 {{"feature", "trail"}, {"class", "human"}, {"floor", optionalJson(trail.floor)}});
}

}  // namespace

void writeGeojson(const map::MapView& view, const Path& path) {
  const auto& graph = view.graph();
  Json features = trajectoryFeatures(view);
  for (const auto& trail : trailsOf(view)) features.push_back(trailFeature(trail));
  for (const auto& prediction : view.predictions()) {
    for (const auto& area : prediction.areas) {
      if (area.outline_in_node.size() > 2) features.push_back(areaFeature(view, prediction, area));
    }
  }
  for (const auto id : graph.edges()) features.push_back(edgeFeature(graph, graph.getEdge(id)));
  for (const auto id : graph.nodes()) features.push_back(nodeFeature(graph.getNode(id)));
  for (const auto& entity : view.entities()) features.push_back(entityFeature(view, entity));
  const Json collection = {
      {"type", "FeatureCollection"},
      {"name", logNames(view)},
      {"properties",
       {{"coordinates", "metres in the frame of the map (x, y, z up): local, neither longitude nor latitude"}}},
      {"features", std::move(features)},
  };
  writeFile(path, dumpByLines(collection));
}

}  // namespace prodomos::exporter

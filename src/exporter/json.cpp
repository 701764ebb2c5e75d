// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/json.hpp"

#include "exporter/contents.hpp"
#include "exporter/formats.hpp"
#include "exporter/text.hpp"
#include "exporter/write_file.hpp"

#include <cmath>

namespace prodomos::exporter {

Json number(double value) {
  constexpr double kParts = 1e9;
  if (!std::isfinite(value)) return nullptr;
  return std::abs(value) < 1e6 ? std::round(value * kParts) / kParts + 0.0 : value;  // + 0.0: no "-0.0"
}

Json array(const Eigen::Ref<const Eigen::VectorXd>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number(value));
  return list;
}

Json poseJson(const geometry::Pose3& pose) {
  return {{"position", array(pose.translation())},
          {"quaternion", array(quaternionOf(pose).coeffs())},
          {"yaw", number(geometry::yaw(pose))}};
}

std::string dumpByLines(const Json& object) {
  const auto dump = [](const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); };
  std::string text = "{";
  std::string_view separator = "\n";
  for (const auto& [key, value] : object.items()) {
    text += std::string(separator) + dump(key) + ": ";
    separator = ",\n";
    if (!value.is_array() || value.empty() || !value.front().is_structured()) {
      text += dump(value);
      continue;
    }
    std::string_view comma = "[\n  ";
    for (const auto& element : value) {
      text += std::string(comma) + dump(element);
      comma = ",\n  ";
    }
    text += "\n]";
  }
  return text + "\n}\n";
}

namespace {

using map::Matrix6;

Json upperTriangle(const Matrix6& matrix) {
  Json list = Json::array();
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) list.push_back(number(matrix(row, column)));
  }
  return list;
}

Json sessionJson(const map::Session& session) {
  Json classes = Json::object();
  for (const auto& [id, name] : session.classes) classes[std::to_string(id)] = name;
  return {{"id", toString(session.id)},
          {"log", fileName(session.log)},
          {"kind", session.logKind},
          {"poses", fileName(session.poses)},
          {"version", session.version},
          {"state", toString(session.state)},
          {"begin", base::toString(session.begin)},
          {"end", base::toString(session.end)},
          {"distance", number(session.distance)},
          {"T_map_travel", poseJson(session.T_map_travel)},
          {"classes", std::move(classes)}};
}

Json nodeJson(const map::MapView& view, const map::Node& node) {
  Json layers = Json::object();
  for (const auto& type : view.layersOf(node.id)) {
    Json summary = Json::object();
    if (const auto layer = view.findLayer(node.id, type)) {
      for (const auto& [name, value] : layer->summary()) summary[name] = value;
    }
    layers[type] = std::move(summary);
  }
  return {{"id", toString(node.id)},
          {"kind", toString(node.kind)},
          {"session", toString(node.session)},
          {"floor", optionalJson(node.floor)},
          {"place", optionalJson(node.place)},
          {"T_map_submap", poseJson(node.T_map_submap)},
          {"T_travel_submap", poseJson(node.T_travel_submap)},
          {"covariance", node.covariance ? upperTriangle(*node.covariance) : Json(nullptr)},
          {"begin", base::toString(node.begin)},
          {"end", base::toString(node.end)},
          {"distance", number(node.distance)},
          {"readings", node.readings},
          {"layers", std::move(layers)}};
}

Json edgeJson(const map::Edge& edge) {
  return {{"id", toString(edge.id)},
          {"from", toString(edge.from)},
          {"to", toString(edge.to)},
          {"kind", toString(edge.kind)},
          {"cause", optionalJson(edge.cause)},
          {"T_from_to", poseJson(edge.T_from_to)},
          {"information", upperTriangle(edge.information)}};
}

Json entityJson(const map::MapView& view, const map::Entity& entity) {
  return {{"id", toString(entity.id)},
          {"class", map::className(entity.attributes)},
          {"mobility", toString(map::mobility(entity.attributes))},
          {"submap", toString(entity.submap)},
          {"T_submap_entity", poseJson(entity.T_submap_entity)},
          {"T_map_entity", poseJson(poseInMap(view, entity))},
          {"covariance", upperTriangle(entity.covariance)},
          {"confidence", number(entity.confidence)},
          {"observations", entity.observations},
          {"first_seen", base::toString(entity.firstSeen)},
          {"last_seen", base::toString(entity.lastSeen)},
          {"attributes", Json::parse(map::toJson(entity.attributes))}};
}

Json predictionJson(const map::Prediction& prediction) {
  Json areas = Json::array();
  for (const auto& area : prediction.areas) {
    Json outline = Json::array();
    for (const auto& corner : area.outline_in_node) outline.push_back(array(corner));
    areas.push_back({{"threshold", number(area.threshold)}, {"outline_in_node", std::move(outline)}});
  }
  Json room = Json::array();
  for (const auto& corner : prediction.room_in_node) room.push_back(array(corner));
  return {{"id", toString(prediction.id)},
          {"cause", toString(prediction.cause)},
          {"submap", toString(prediction.submap)},
          {"node", toString(prediction.node)},
          {"T_submap_node", poseJson(prediction.T_submap_node)},
          {"probability", number(prediction.probability)},
          {"expected_area", number(prediction.expectedArea)},
          {"areas", std::move(areas)},
          {"room_in_node", std::move(room)},
          {"made", base::toString(prediction.made)},
          {"state", toString(prediction.state)},
          {"settled", prediction.settled ? Json(base::toString(*prediction.settled)) : Json(nullptr)},
          {"merged_into", optionalJson(prediction.mergedInto)}};
}

Json trajectoryRow(const map::TrajectoryPoint& point) {
  Json row = {toString(point.session), base::toString(point.time), toString(point.submap)};
  for (const auto& pose : {point.T_map_body, point.T_travel_body}) {
    row.push_back(array(pose.translation()));
    row.push_back(array(quaternionOf(pose).coeffs()));
  }
  return row;
}

}  // namespace

void writeJson(const map::MapView& view, const Path& path) {
  const auto& graph = view.graph();
  const Json map = {
      {"format", "prodomos map"},
      {"version", 1},
      {"sessions", listOf(view.sessions(), sessionJson)},
      {"floors", listOf(view.floors(),
                        [](const auto& floor) {
                          return Json{{"number", floor.number}, {"height", number(floor.height)}};
                        })},
      {"places", listOf(graph.places(),
                        [](const auto& place) {
                          return Json{{"number", place.number},
                                      {"submaps", listOf(place.submaps, [](auto id) { return Json(toString(id)); })}};
                        })},
      {"nodes", listOf(graph.nodes(), [&](auto id) { return nodeJson(view, graph.getNode(id)); })},
      {"edges", listOf(graph.edges(), [&](auto id) { return edgeJson(graph.getEdge(id)); })},
      {"entities", listOf(view.entities(), [&](const auto& entity) { return entityJson(view, entity); })},
      {"predictions", listOf(view.predictions(), predictionJson)},
      {"trajectory", listOf(view.trajectory(), trajectoryRow)},
  };
  writeFile(path, dumpByLines(map));
}

}  // namespace prodomos::exporter

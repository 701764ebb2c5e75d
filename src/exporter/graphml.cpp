// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/contents.hpp"
#include "exporter/formats.hpp"
#include "exporter/text.hpp"
#include "exporter/write_file.hpp"

#include <string>

namespace prodomos::exporter {
namespace {

struct Key {
  std::string_view domain;
  std::string_view name;
  std::string_view type;
};

constexpr Key kKeys[] = {
    {"graph", "log", "string"},
    {"node", "label", "string"},
    {"node", "kind", "string"},
    {"node", "session", "string"},
    {"node", "floor", "int"},
    {"node", "place", "int"},
    {"node", "x", "double"},
    {"node", "y", "double"},
    {"node", "z", "double"},
    {"node", "yaw", "double"},
    {"node", "begin", "string"},
    {"node", "end", "string"},
    {"node", "distance", "double"},
    {"node", "readings", "int"},
    {"node", "entities", "int"},
    {"node", "probability", "double"},
    {"node", "expected_area", "double"},
    {"edge", "kind", "string"},
    {"edge", "cause", "string"},
    {"edge", "weight", "double"},
    {"edge", "dx", "double"},
    {"edge", "dy", "double"},
    {"edge", "dz", "double"},
    {"edge", "dyaw", "double"},
};

std::string data(std::string_view domain, std::string_view name, std::string_view value) {
  return "<data key=\"" + std::string(domain) + '_' + std::string(name) + "\">" + xml(value) + "</data>";
}

std::string nodeElement(const map::MapView& view, const map::Node& node) {
  const auto field = [](std::string_view name, std::string_view value) { return data("node", name, value); };
  const auto id = toString(node.id);
  const Eigen::Vector3d position = node.T_map_submap.translation();
  std::string element = "    <node id=\"" + id + "\">";
  element += field("label", id) + field("kind", toString(node.kind)) + field("session", toString(node.session));
  if (node.floor) element += field("floor", std::to_string(*node.floor));
  if (node.place) element += field("place", std::to_string(*node.place));
  element += field("x", fixed(position.x())) + field("y", fixed(position.y())) + field("z", fixed(position.z()));
  element += field("yaw", fixed(geometry::yaw(node.T_map_submap)));
  if (node.kind == map::SubMapKind::kObserved) {
    element += field("begin", base::toString(node.begin)) + field("end", base::toString(node.end));
    element += field("distance", fixed(node.distance)) + field("readings", std::to_string(node.readings));
    element += field("entities", std::to_string(view.entitiesOf(node.id).size()));
  } else if (const auto* prediction = predictionOf(view, node.id)) {
    element += field("probability", fixed(prediction->probability));
    element += field("expected_area", fixed(prediction->expectedArea));
  }
  return element + "</node>\n";
}

std::string edgeElement(const map::Edge& edge) {
  const auto field = [](std::string_view name, std::string_view value) { return data("edge", name, value); };
  const Eigen::Vector3d step = edge.T_from_to.translation();
  std::string element = "    <edge id=\"" + toString(edge.id) + "\" source=\"" + toString(edge.from) + "\" target=\"" +
                        toString(edge.to) + "\">";
  element += field("kind", toString(edge.kind));
  if (edge.cause) element += field("cause", toString(*edge.cause));
  element += field("weight", fixed(step.norm()));  // metres; the name that graph tools take for shortest paths
  element += field("dx", fixed(step.x())) + field("dy", fixed(step.y())) + field("dz", fixed(step.z()));
  element += field("dyaw", fixed(geometry::yaw(edge.T_from_to)));
  return element + "</edge>\n";
}

}  // namespace

void writeGraphml(const map::MapView& view, const Path& path) {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\""
      " xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\""
      " xsi:schemaLocation=\"http://graphml.graphdrawing.org/xmlns"
      " http://graphml.graphdrawing.org/xmlns/1.0/graphml.xsd\">\n";
  for (const auto& [domain, name, type] : kKeys) {
    text += "  <key id=\"" + std::string(domain) + '_' + std::string(name) + "\" for=\"" + std::string(domain) +
            "\" attr.name=\"" + std::string(name) + "\" attr.type=\"" + std::string(type) + "\"/>\n";
  }
  text += "  <graph id=\"prodomos\" edgedefault=\"undirected\">\n    " + data("graph", "log", logNames(view)) + '\n';
  const auto& graph = view.graph();
  for (const auto id : graph.nodes()) text += nodeElement(view, graph.getNode(id));
  for (const auto id : graph.edges()) text += edgeElement(graph.getEdge(id));
  text += "  </graph>\n</graphml>\n";
  writeFile(path, text);
}

}  // namespace prodomos::exporter

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/graph_bytes.hpp"

namespace prodomos::mapper {

void saveNode(base::ByteWriter& out, const map::Node& node) {
  out << node.id.value << node.session.value << node.kind << node.floor.has_value() << node.floor.value_or(0);
  savePose(out, node.T_map_submap);
  savePose(out, node.T_travel_submap);
  saveTime(out, node.begin);
  saveTime(out, node.end);
  out << node.distance << node.readings;
}

map::Node loadNode(base::ByteReader& in) {
  map::Node node;
  in >> node.id.value >> node.session.value >> node.kind;
  const bool hasFloor = in.read<bool>();
  const int floor = in.read<int>();
  if (hasFloor) node.floor = floor;
  node.T_map_submap = loadPose(in);
  node.T_travel_submap = loadPose(in);
  node.begin = loadTime(in);
  node.end = loadTime(in);
  in >> node.distance >> node.readings;
  return node;
}

void saveEdge(base::ByteWriter& out, const map::Edge& edge) {
  out << edge.id.value << edge.from.value << edge.to.value << edge.kind;
  savePose(out, edge.T_from_to);
  saveMatrix(out, edge.information);
  out << edge.cause.has_value() << edge.cause.value_or(base::EntityId{}).value;
}

map::Edge loadEdge(base::ByteReader& in) {
  map::Edge edge;
  in >> edge.id.value >> edge.from.value >> edge.to.value >> edge.kind;
  edge.T_from_to = loadPose(in);
  loadMatrix(in, edge.information);
  const bool hasCause = in.read<bool>();
  const base::EntityId cause{in.read<std::int64_t>()};
  if (hasCause) edge.cause = cause;
  return edge;
}

}  // namespace prodomos::mapper

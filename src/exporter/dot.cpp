// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/contents.hpp"
#include "exporter/formats.hpp"
#include "exporter/palette.hpp"
#include "exporter/text.hpp"
#include "exporter/write_file.hpp"

#include <algorithm>
#include <map>
#include <string>

namespace prodomos::exporter {
namespace {

constexpr double kInchesPerMetre = 0.5;
constexpr double kMetresBetweenFloors = 5.0;

std::string_view edgeStyle(map::EdgeKind kind) {
  switch (kind) {
    case map::EdgeKind::kTravelled:
      return "style=solid";
    case map::EdgeKind::kDoor:
      return "style=dashed, color=\"#d9770b\"";
    case map::EdgeKind::kStairs:
      return "style=dashed, color=\"#7c3aed\"";
    case map::EdgeKind::kLoop:
      return "style=dotted, color=\"#2563eb\"";
    case map::EdgeKind::kLift:
      return "style=dotted, color=\"#7c3aed\"";
    case map::EdgeKind::kOverlap:
      return "style=dotted, color=\"#93b4f5\"";
  }
  return "";
}

std::string nodeLine(const map::Node& node, double shift) {
  const Eigen::Vector3d position = node.T_map_submap.translation();
  std::string tip = std::string(toString(node.kind));
  if (node.place) tip += ", place " + std::to_string(*node.place);
  if (node.floor) tip += ", floor " + std::to_string(*node.floor);
  const bool predicted = node.kind == map::SubMapKind::kPredicted;
  const std::string look = predicted ? "style=dashed, color=\"" + hex(kPredictedColor) + '"'
                                     : "style=filled, fillcolor=\"" + hex(placeColor(node.place)) + '"';
  return "  " + toString(node.id) + " [pos=\"" + fixed((position.x() + shift) * kInchesPerMetre, 4) + ',' +
         fixed(position.y() * kInchesPerMetre, 4) + "!\", tooltip=" + inQuotes(tip) + ", " + look + "];\n";
}

/// Along x, so that floors stand side by side.
std::map<std::optional<int>, double> shiftsOfFloors(const map::TopologicalGraph& graph) {
  std::map<std::optional<int>, std::pair<double, double>> extents;
  for (const auto id : graph.nodes()) {
    const auto& node = graph.getNode(id);
    const double x = node.T_map_submap.translation().x();
    auto& [least, most] = extents.try_emplace(node.floor, x, x).first->second;
    least = std::min(least, x);
    most = std::max(most, x);
  }
  std::map<std::optional<int>, double> shifts;
  double end = 0.0;
  for (const auto& [floor, extent] : extents) {
    shifts[floor] = end - extent.first;
    end += extent.second - extent.first + kMetresBetweenFloors;
  }
  return shifts;
}

}  // namespace

void writeDot(const map::MapView& view, const Path& path) {
  const auto& graph = view.graph();
  std::string text =
      "graph prodomos {\n  graph [layout=neato, outputorder=edgesfirst, label=" + inQuotes(logNames(view)) +
      "];\n  node [shape=circle, fixedsize=true, width=0.35, fontname=\"sans-serif\", fontsize=9];\n";
  const auto shifts = shiftsOfFloors(graph);
  for (const auto id : graph.nodes()) text += nodeLine(graph.getNode(id), shifts.at(graph.getNode(id).floor));
  for (const auto id : graph.edges()) {
    const auto& edge = graph.getEdge(id);
    text += "  " + toString(edge.from) + " -- " + toString(edge.to) + " [id=" + toString(edge.id) +
            ", tooltip=" + inQuotes(toString(edge.kind)) + ", " + std::string(edgeStyle(edge.kind)) + "];\n";
  }
  writeFile(path, text + "}\n");
}

}  // namespace prodomos::exporter

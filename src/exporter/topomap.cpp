// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/contents.hpp"
#include "exporter/formats.hpp"
#include "exporter/text.hpp"
#include "exporter/write_file.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string>

/// The "tmap2" format of LCAS/topological_navigation. What its present version requires (actions, topo_frame_id) stands
/// beside what earlier ones read (parent_frame, localise_by_topic, restrictions); each leaves alone what it does not
/// know.
namespace prodomos::exporter {
namespace {

constexpr double kInfluenceRadius = 0.75;  // metres; the robot "is at" a node within this

/// "22-11-2026_08-04-02": the day of the log, not of the export, so that the same map gives the same bytes.
std::string dayAndHour(base::Time time) {
  using namespace std::chrono;
  const auto day = floor<days>(time);
  const year_month_day date(day);
  const hh_mm_ss clock(floor<std::chrono::seconds>(time - day));
  const auto two = [](auto value) {
    const std::string text = std::to_string(value);
    return text.size() < 2 ? '0' + text : text;
  };
  return two(unsigned{date.day()}) + '-' + two(unsigned{date.month()}) + '-' + std::to_string(int{date.year()}) + '_' +
         two(clock.hours().count()) + '-' + two(clock.minutes().count()) + '-' + two(clock.seconds().count());
}

std::string lastUpdated(const map::MapView& view) {
  base::Time last{};
  for (const auto& session : view.sessions()) last = std::max(last, session.end);
  return dayAndHour(last);
}

std::string header(const map::MapView& view, const std::string& name) {
  const std::string identity =
      "  rotation: {w: 1.0, x: 0.0, y: 0.0, z: 0.0}\n  translation: {x: 0.0, y: 0.0, z: 0.0}\n";
  return "meta:\n  last_updated: " + lastUpdated(view) + "\nname: " + name + "\nmetric_map: " + name +
         "\npointset: " + name + "\ntransformation:\n  parent: map\n  child: topo_map\n  topo_frame_id: topo_map\n" +
         identity +
         "actions:\n"
         "  navigate_to_pose:\n"
         "    action_server: /navigate_to_pose\n"
         "    action_type: nav2_msgs.action.NavigateToPose\n"
         "    composable: false\n"
         "    action_goal_template:\n"
         "      pose:\n"
         "        header: {frame_id: '${node.nav_frame}'}\n"
         "        pose: '${node.pose}'\n";
}

std::string edgeItem(const map::Edge& edge, const map::Node& from, const map::Node& to) {
  const std::string source = toString(from.id);
  const std::string target = toString(to.id);
  const double length = (to.T_map_submap.translation() - from.T_map_submap.translation()).norm();
  return "    - edge_id: " + source + '_' + target + "\n      node: " + target +
         "\n      action: navigate_to_pose\n      action_type: nav2_msgs.action.NavigateToPose\n      config: []\n"
         "      fail_policy: fail\n      fluid_navigation: true\n"
         "      goal: {target_pose: {header: {frame_id: $node.parent_frame}, pose: $node.pose}}\n"
         "      recovery_behaviours_config: ''\n"
         "      restrictions_planning: 'True'\n      restrictions_runtime: 'True'\n"
         "      properties: {edge: " +
         toString(edge.id) + ", kind: " + std::string(toString(edge.kind)) + ", length: " + fixed(length) + "}\n";
}

/// At most one edge between two nodes each way: the edge ids of the format name the two ends alone.
std::string edgeItems(const map::MapView& view, const map::Node& node) {
  const auto& graph = view.graph();
  std::string items;
  for (const auto neighbour : graph.neighbours(node.id)) {
    const auto& other = graph.getNode(neighbour);
    if (neighbour == node.id || other.kind != map::SubMapKind::kObserved) continue;
    for (const auto id : graph.edgesOf(node.id)) {
      const auto& edge = graph.getEdge(id);
      if (edge.from != neighbour && edge.to != neighbour) continue;
      items += edgeItem(edge, node, other);
      break;
    }
  }
  return items.empty() ? "    edges: []\n" : "    edges:\n" + items;
}

std::string properties(const map::Node& node) {
  std::string text = "    properties: {xy_goal_tolerance: 0.3, yaw_goal_tolerance: 6.283";
  if (node.floor) text += ", floor: " + std::to_string(*node.floor);
  if (node.place) text += ", place: " + std::to_string(*node.place);
  return text + "}\n";
}

std::string influenceZone() {
  constexpr int kCorners = 8;
  std::string text = "    verts:\n";
  for (int corner = 0; corner < kCorners; ++corner) {
    const double angle = (corner + 0.5) * 2.0 * std::numbers::pi / kCorners;
    text += "    - {x: " + fixed(kInfluenceRadius * std::cos(angle)) +
            ", y: " + fixed(kInfluenceRadius * std::sin(angle)) + "}\n";
  }
  return text;
}

std::string nodeItem(const map::MapView& view, const map::Node& node, const std::string& name) {
  const std::string id = toString(node.id);
  const Eigen::Vector3d t = node.T_map_submap.translation();
  const Eigen::Quaterniond q = quaternionOf(node.T_map_submap);
  return "- meta: {map: " + name + ", node: " + id + ", pointset: " + name + "}\n  node:\n    name: " + id +
         "\n    nav_frame: '${transformation.topo_frame_id}'\n    parent_frame: map\n    localise_by_topic: ''\n"
         "    pose:\n      orientation: {w: " +
         fixed(q.w()) + ", x: " + fixed(q.x()) + ", y: " + fixed(q.y()) + ", z: " + fixed(q.z()) +
         "}\n      position: {x: " + fixed(t.x()) + ", y: " + fixed(t.y()) + ", z: " + fixed(t.z()) + "}\n" +
         properties(node) + "    restrictions_planning: 'True'\n    restrictions_runtime: 'True'\n" + influenceZone() +
         edgeItems(view, node);
}

}  // namespace

void writeTopomap(const map::MapView& view, const Path& path) {
  const std::string name = inQuotes(logNames(view));
  const auto nodes = observedNodes(view);
  std::string text = header(view, name) + (nodes.empty() ? "nodes: []\n" : "nodes:\n");
  for (const auto& node : nodes) text += nodeItem(view, node, name);
  writeFile(path, text);
}

}  // namespace prodomos::exporter

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/html_data.hpp"

#include "exporter/contents.hpp"
#include "exporter/footprint.hpp"
#include "exporter/html_floors.hpp"
#include "exporter/simplify.hpp"
#include "exporter/text.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace prodomos::exporter {
namespace {

constexpr int kThumbnailPixels = 160;
constexpr double kTrajectoryTolerance = 0.01;  // metres

double seconds(base::Time time) {
  return std::round(static_cast<double>(base::toNanoseconds(time)) * 1e-6) * 1e-3;
}

Json poseOf(const geometry::Pose3& pose) {
  const auto& p = pose.translation();
  return {rounded(p.x()), rounded(p.y()), rounded(p.z()), rounded(geometry::yaw(pose), 1e-4)};
}

Json sessionsOf(const map::MapView& view) {
  Json sessions = Json::array();
  for (const auto& session : view.sessions()) {
    sessions.push_back({{"id", toString(session.id)},
                        {"log", fileName(session.log)},
                        {"kind", session.logKind},
                        {"poses", fileName(session.poses)},
                        {"state", map::toString(session.state)}});
  }
  return sessions;
}

const map::Session* findSession(const map::MapView& view, base::SessionId id) {
  const auto found = std::ranges::find(view.sessions(), id, &map::Session::id);
  return found == view.sessions().end() ? nullptr : &*found;
}

/// How far refinement has moved the sub-map.
double moved(const map::MapView& view, const map::Node& node) {
  const auto* session = findSession(view, node.session);
  if (session == nullptr) return 0.0;
  const geometry::Pose3 T_map_asTravelled = session->T_map_travel * node.T_travel_submap;
  return (node.T_map_submap.translation() - T_map_asTravelled.translation()).norm();
}

/// The corners of what the sub-map's grid knows, in the map frame.
Json outlineOf(const PlacedImage& thumbnail, const geometry::Pose3& T_map_submap) {
  Polyline outline;
  for (const Eigen::Vector2d& share : {Eigen::Vector2d{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
    const Eigen::Vector2d corner = thumbnail.corner + thumbnail.size.cwiseProduct(share);
    outline.push_back((T_map_submap * Eigen::Vector3d(corner.x(), corner.y(), 0.0)).head<2>());
  }
  return pointsJson(outline);
}

/// What its layers hold in numbers, and a thumbnail of its grid.
void addLayers(Json& out, const map::MapView& view, const map::Node& node) {
  for (const auto& type : view.layersOf(node.id)) {
    const auto layer = view.findLayer(node.id, type);
    if (!layer) {
      out["layers"].push_back({{"type", type}, {"fault", "A layer that this version of prodomos does not know."}});
      continue;
    }
    out["layers"].push_back({{"type", type}, {"summary", layer->summary()}});
    const auto* grid = dynamic_cast<const map::OccupancyGrid*>(layer.get());
    const auto thumbnail = grid != nullptr ? thumbnailImage(*grid, kThumbnailPixels) : std::nullopt;
    if (!thumbnail) continue;
    out["outline"] = outlineOf(*thumbnail, node.T_map_submap);
    out["thumb"] = imageJson(*thumbnail);
  }
}

Json nodeOf(const map::MapView& view, const map::Node& node) {
  Json out{{"id", toString(node.id)},
           {"kind", map::toString(node.kind)},
           {"place", optionalJson(node.place)},
           {"floor", optionalJson(node.floor)},
           {"session", toString(node.session)},
           {"begin", seconds(node.begin)},
           {"end", seconds(node.end)},
           {"distance", rounded(node.distance)},
           {"readings", node.readings},
           {"pose", poseOf(node.T_map_submap)},
           {"moved", rounded(moved(view, node))},
           {"layers", Json::array()},
           {"outline", nullptr},
           {"thumb", nullptr}};
  addLayers(out, view, node);
  return out;
}

/// Of x, y and heading, the rest of the pose held; null where the edge carries no information.
Json sigmaOf(const map::Matrix6& information) {
  const std::array<int, 3> planar{0, 1, 5};
  Eigen::Matrix3d block;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      block(row, column) = information(planar[static_cast<std::size_t>(row)], planar[static_cast<std::size_t>(column)]);
    }
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(block);
  if (!block.allFinite() || !lu.isInvertible()) return nullptr;
  const Eigen::Vector3d variances = lu.inverse().diagonal();
  if (variances.minCoeff() < 0.0) return nullptr;
  const Eigen::Vector3d sigma = variances.cwiseSqrt();
  return {rounded(sigma.x(), 1e-4), rounded(sigma.y(), 1e-4), rounded(sigma.z(), 1e-5)};
}

Json edgeOf(const map::Edge& edge) {
  return {{"id", toString(edge.id)},
          {"from", toString(edge.from)},
          {"to", toString(edge.to)},
          {"kind", map::toString(edge.kind)},
          {"cause", optionalJson(edge.cause)},
          {"length", rounded(edge.T_from_to.translation().norm())},
          {"transform", poseOf(edge.T_from_to)},
          {"sigma", sigmaOf(edge.information)}};
}

Json entityOf(const map::MapView& view, const map::Entity& entity) {
  const auto& node = view.graph().getNode(entity.submap);
  Json shape = Json::array();
  for (const auto& line : footprint(entity, node.T_map_submap)) shape.push_back(pointsJson(line));
  return {{"id", toString(entity.id)},
          {"class", map::className(entity.attributes)},
          {"mobility", map::toString(map::mobility(entity.attributes))},
          {"submap", toString(entity.submap)},
          {"floor", optionalJson(node.floor)},
          {"pose", poseOf(node.T_map_submap * entity.T_submap_entity)},
          {"confidence", rounded(entity.confidence)},
          {"observations", entity.observations},
          {"firstSeen", seconds(entity.firstSeen)},
          {"lastSeen", seconds(entity.lastSeen)},
          {"attributes", Json::parse(map::toJson(entity.attributes))},
          {"shape", std::move(shape)}};
}

Json predictionJson(const map::MapView& view, const map::Prediction& prediction) {
  const geometry::Pose3 T_map_node = view.T_map_node(prediction);
  Json areas = Json::array();
  for (const auto& area : prediction.areas) {
    Polyline outline;
    for (const auto& point : area.outline_in_node) {
      outline.push_back((T_map_node * Eigen::Vector3d(point.x(), point.y(), 0.0)).head<2>());
    }
    areas.push_back({{"threshold", rounded(area.threshold)}, {"outline", pointsJson(outline)}});
  }
  return {{"id", toString(prediction.id)},
          {"cause", toString(prediction.cause)},
          {"node", toString(prediction.node)},
          {"floor", optionalJson(floorOf(view, prediction))},
          {"probability", rounded(prediction.probability)},
          {"expectedArea", rounded(prediction.expectedArea)},
          {"state", map::toString(prediction.state)},
          {"made", seconds(prediction.made)},
          {"settled", prediction.settled ? Json(seconds(*prediction.settled)) : Json(nullptr)},
          {"mergedInto", optionalJson(prediction.mergedInto)},
          {"areas", std::move(areas)}};
}

/// Pieces of one session on one floor each, as travelled and as refined.
Json trajectoryOf(const map::MapView& view) {
  Json pieces = Json::array();
  std::optional<base::SessionId> session;
  std::optional<int> floor;
  Polyline travelled;
  Polyline refined;
  const auto finish = [&] {
    if (!refined.empty()) {
      pieces.push_back({{"session", toString(*session)},
                        {"floor", optionalJson(floor)},
                        {"travelled", pointsJson(simplified(travelled, kTrajectoryTolerance))},
                        {"refined", pointsJson(simplified(refined, kTrajectoryTolerance))}});
    }
    travelled.clear();
    refined.clear();
  };
  for (const auto& point : view.trajectory()) {
    const auto* node = view.graph().findNode(point.submap);
    const auto floorHere = node == nullptr ? std::nullopt : node->floor;
    if (session != point.session || floor != floorHere) finish();
    session = point.session;
    floor = floorHere;
    const auto* run = findSession(view, point.session);
    const auto T_map_travel = run == nullptr ? geometry::Pose3::Identity() : run->T_map_travel;
    travelled.push_back((T_map_travel * point.T_travel_body).translation().head<2>());
    refined.push_back(point.T_map_body.translation().head<2>());
  }
  finish();
  return pieces;
}

Json trailsJson(const map::MapView& view) {
  Json trails = Json::array();
  for (const auto& trail : trailsOf(view)) {
    Polyline line;
    for (const auto& point : trail.points_in_map) line.push_back(point.head<2>());
    trails.push_back({{"track", toString(trail.track)},
                      {"floor", optionalJson(trail.floor)},
                      {"points", pointsJson(simplified(line, kTrajectoryTolerance))}});
  }
  return trails;
}

Json totalsOf(const map::MapView& view, double area) {
  const auto observed = observedNodes(view).size();
  const auto places = std::ranges::count_if(view.graph().places(), [&](const map::TopologicalPlace& place) {
    return view.graph().getNode(place.submaps.front()).kind == map::SubMapKind::kObserved;
  });
  double distance = 0.0;
  for (const auto& session : view.sessions()) distance += session.distance;
  return {{"submaps", observed},
          {"predicted", view.graph().nodes().size() - observed},
          {"places", places},
          {"distance", rounded(distance)},
          {"area", rounded(area)}};
}

}  // namespace

Json htmlData(const map::MapView& view, const HtmlOptions& options) {
  const auto& graph = view.graph();
  auto floors = htmlFloors(view);
  return {{"version", PRODOMOS_VERSION},
          {"followSeconds", options.followSeconds},
          {"title", logNames(view)},
          {"totals", totalsOf(view, floors.freeArea)},
          {"sessions", sessionsOf(view)},
          {"floors", std::move(floors.json)},
          {"nodes", listOf(graph.nodes(), [&](base::SubMapId id) { return nodeOf(view, graph.getNode(id)); })},
          {"edges", listOf(graph.edges(), [&](base::EdgeId id) { return edgeOf(graph.getEdge(id)); })},
          {"entities", listOf(view.entities(), [&](const map::Entity& entity) { return entityOf(view, entity); })},
          {"predictions",
           listOf(view.predictions(), [&](const map::Prediction& bet) { return predictionJson(view, bet); })},
          {"trajectory", trajectoryOf(view)},
          {"trails", trailsJson(view)}};
}

}  // namespace prodomos::exporter

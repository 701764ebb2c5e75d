// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/graph_refiner.hpp"

#include "prodomos/base/error.hpp"

#include "mapper/graph_bytes.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <set>
#include <span>

namespace prodomos::mapper {

namespace {

// Candidates of loops are mostly those of the sub-map before.
constexpr std::size_t kRecentLayers = 24;

// What is told to readers of the map file while it grows is that near to the truth; all is told in the end.
constexpr double kLeastMove = 1e-3;  // metres, radians

// Frames of sub-maps stand on the floor, upright: so well is known how two of one floor lie to each other apart from
// what is seen from above.
constexpr double kFloorSigma = 0.05;    // metres
constexpr double kUprightSigma = 0.02;  // radians

// Two components are joined where loops agree how, between so many sub-maps of either: all loops of a single one may be
// wrong, and agree, where it looks like another place.
constexpr std::size_t kWitnesses = 2;
constexpr double kAgreement = 0.5;      // metres
constexpr double kAgreementTurn = 0.1;  // radians

constexpr double kBeside = 40.0;  // metres; two sub-maps hardly reach that far towards each other

/// Of things that take many bytes each.
std::size_t countOf(base::ByteReader& in) {
  const auto count = in.read<std::uint64_t>();
  if (count > in.left()) throw base::Error("expected fewer than " + std::to_string(count) + " parts of a graph");
  return static_cast<std::size_t>(count);
}

map::Matrix6 lifted(const Eigen::Matrix3d& information) {
  map::Matrix6 six = map::Matrix6::Zero();
  six(2, 2) = 1.0 / (kFloorSigma * kFloorSigma);
  six(3, 3) = six(4, 4) = 1.0 / (kUprightSigma * kUprightSigma);
  six(geometry::kPlanarAxes, geometry::kPlanarAxes) = information;
  return six;
}

Eigen::Matrix3d planarPart(const map::Matrix6& six) {
  return six(geometry::kPlanarAxes, geometry::kPlanarAxes);
}

/// Rather than travelled.
bool isFound(const map::Edge& edge) {
  return edge.kind == map::EdgeKind::kLoop || edge.kind == map::EdgeKind::kOverlap;
}

/// Has either of the two seen that the straight line between their origins is free?
bool isWay(const localization::MatchedLayers& from, const localization::MatchedLayers& to,
           const geometry::Pose2& T_from_to) {
  const auto T_to_from = geometry::inverse(T_from_to);
  const auto isFree = [](const map::OccupancyGrid& grid, const Eigen::Vector2d& place) {
    return grid.state(grid.cellAt(place)) == map::CellState::kFree;
  };
  const double step = 0.5 * from.grid->resolution();
  const int steps = static_cast<int>(std::hypot(T_from_to.x, T_from_to.y) / step);
  for (int i = 1; i < steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    const Eigen::Vector2d place_in_from = share * Eigen::Vector2d(T_from_to.x, T_from_to.y);
    const Eigen::Vector2d place_in_to = (1.0 - share) * Eigen::Vector2d(T_to_from.x, T_to_from.y);
    if (!isFree(*from.grid, place_in_from) && !isFree(*to.grid, place_in_to)) return false;
  }
  return true;
}

bool isNear(const geometry::Pose3& a, const geometry::Pose3& b, double distance, double turn) {
  const geometry::Pose3 T_a_b = a.inverse() * b;
  return T_a_b.translation().norm() <= distance && geometry::rotationAngle(T_a_b) <= turn;
}

}  // namespace

GraphRefiner::GraphRefiner(const localization::LoopCloserConfig& config, const map::MapStore& store)
    : store_(store), findsLoops_(config.enabled), closer_(config, [this](base::SubMapId id) { return layersOf(id); }) {
  const auto view = store.view();
  for (const auto id : view.graph().nodes()) {
    const auto& node = view.graph().getNode(id);
    nextNode_ = id.value + 1;
    if (node.kind != map::SubMapKind::kObserved) continue;
    vertices_.push_back({node, node.T_map_submap, true});
    if (!findsLoops_) continue;
    if (const auto layers = layersOf(id); layers.surface && layers.grid) closer_.add(id, layers);
  }
  for (const auto id : view.graph().edges()) {
    const auto& edge = view.graph().getEdge(id);
    nextEdge_ = id.value + 1;
    const bool isObserved = view.graph().getNode(edge.to).kind == map::SubMapKind::kObserved;
    if (isObserved) ties_.push_back({edge, TieState::kBelieved, true});
  }
  // Nor those of bets that were settled.
  for (const auto& prediction : view.predictions()) nextNode_ = std::max(nextNode_, prediction.node.value + 1);
}

GraphRefiner::Vertex& GraphRefiner::vertexOf(base::SubMapId id) {
  return const_cast<Vertex&>(std::as_const(*this).vertexOf(id));
}

const GraphRefiner::Vertex& GraphRefiner::vertexOf(base::SubMapId id) const {
  const auto found = std::ranges::lower_bound(vertices_, id, {}, [](const Vertex& vertex) { return vertex.node.id; });
  if (found == vertices_.end() || found->node.id != id)
    throw base::Error("expected sub-map " + toString(id) + " in the graph");
  return *found;
}

const map::Node& GraphRefiner::node(base::SubMapId id) const {
  return vertexOf(id).node;
}

const geometry::Pose3& GraphRefiner::T_map_submap(base::SubMapId id) const {
  return node(id).T_map_submap;
}

std::vector<base::SubMapId> GraphRefiner::nodesOf(base::SessionId session) const {
  std::vector<base::SubMapId> ids;
  for (const auto& [node, T_map_told, isTold] : vertices_) {
    if (node.session == session) ids.push_back(node.id);
  }
  return ids;
}

std::vector<map::Edge> GraphRefiner::waysOf(base::SessionId session) const {
  std::vector<map::Edge> ways;
  for (const auto& tie : ties_) {
    const bool isWay = tie.state == TieState::kBelieved && tie.edge.kind != map::EdgeKind::kOverlap;
    if (isWay && node(tie.edge.from).session == session) ways.push_back(tie.edge);
  }
  return ways;
}

void GraphRefiner::rename(const map::Edge& way) {
  const auto tie = std::ranges::lower_bound(ties_, way.id, {}, [](const Tie& known) { return known.edge.id; });
  if (tie == ties_.end() || tie->edge.id != way.id) throw base::Error("expected way " + toString(way.id));
  if (tie->edge.kind == way.kind && tie->edge.cause == way.cause) return;
  tie->edge.kind = way.kind;
  tie->edge.cause = way.cause;
  tie->isTold = false;
}

std::vector<map::Node> GraphRefiner::nodes() const {
  std::vector<map::Node> nodes;
  for (const auto& vertex : vertices_) nodes.push_back(vertex.node);
  return nodes;
}

std::vector<map::Node> GraphRefiner::nearest(base::SubMapId id, double reach, std::size_t most) const {
  const auto& middle = node(id);
  const auto distanceTo = [&middle](const map::Node& other) {
    return (other.T_map_submap.translation() - middle.T_map_submap.translation()).norm();
  };
  std::vector<map::Node> near;
  for (const auto otherId : nodesOf(middle.session)) {
    const auto& other = node(otherId);
    if (otherId != id && other.floor == middle.floor && distanceTo(other) <= reach) near.push_back(other);
  }
  std::ranges::stable_sort(near, {}, distanceTo);
  if (near.size() > most) near.resize(most);
  return near;
}

void GraphRefiner::add(const map::Node& node, const std::optional<map::Edge>& edge) {
  vertices_.push_back({node});
  if (edge) ties_.push_back({*edge});
}

void GraphRefiner::move(base::SessionId session, const geometry::Pose3& T_after_before) {
  for (auto& vertex : vertices_) {
    if (vertex.node.session == session) vertex.node.T_map_submap = T_after_before * vertex.node.T_map_submap;
  }
}

void GraphRefiner::close(const map::SubMap& finished) {
  auto& node = vertexOf(finished.node.id).node;
  const auto T_map_submap = node.T_map_submap;
  node = finished.node;
  node.T_map_submap = T_map_submap;
  if (!findsLoops_) return;

  const auto copyOf = [&]<typename Layer>(std::shared_ptr<const Layer>& copy) {
    const auto* layer = finished.findLayer<Layer>();
    if (layer != nullptr) copy = std::make_shared<Layer>(*layer);
  };
  localization::MatchedLayers layers;
  copyOf(layers.surface);
  copyOf(layers.grid);
  if (!layers.surface || !layers.grid || layers.surface->points().empty()) return;
  keepLayers(node.id, layers);
  closer_.add(node.id, layers);

  const auto known = places();
  const auto newest = *std::ranges::find(known, node.id, &localization::LoopPlace::id);
  std::unique_ptr<localization::Covariances<geometry::Pose3>> covariances;  // costly: only where somebody asks
  const auto findCovariance = [&](base::SubMapId from, base::SubMapId to) {
    if (!covariances) covariances = std::make_unique<localization::Covariances<geometry::Pose3>>(poseGraph(false));
    return planarPart(covariances->relative(from.value, to.value));
  };
  const auto loops = closer_.find(newest, known, linked(node.id), findCovariance);
  for (const auto& loop : loops) {
    const auto other = std::ranges::find(known, loop.from, &localization::LoopPlace::id);
    tie(loop, other->component != newest.component);
  }
  if (loops.empty()) return;
  joinComponents();
  const auto found = std::span(ties_).last(loops.size());
  if (std::ranges::any_of(found, [&](const Tie& tie) { return isNews(tie); })) refine(true);
}

/// Does the tie say anything that the poses do not say already? Where rooms have been seen often, hardly any does, and
/// moving the whole map can wait.
bool GraphRefiner::isNews(const Tie& tie) const {
  if (tie.state == TieState::kBetweenComponents) return false;
  const geometry::Pose3 T_from_to = T_map_submap(tie.edge.from).inverse() * T_map_submap(tie.edge.to);
  const geometry::Pose3 deviation = tie.edge.T_from_to.inverse() * T_from_to;
  const Eigen::AngleAxisd turn(deviation.linear());
  Eigen::Matrix<double, 6, 1> error;
  error << deviation.translation(), turn.angle() * turn.axis();
  constexpr double kExpected = 6.0;  // of chi-square with six degrees of freedom
  return error.dot(tie.edge.information * error) > kExpected;
}

void GraphRefiner::tie(const localization::Loop& loop, bool joins) {
  map::Edge edge;
  edge.id = newEdgeId();
  edge.from = loop.from;
  edge.to = loop.to;
  const bool isPassable = isWay(layersOf(loop.from), layersOf(loop.to), loop.match.T_from_to);
  edge.kind = isPassable ? map::EdgeKind::kLoop : map::EdgeKind::kOverlap;
  edge.T_from_to = geometry::toPose3(loop.match.T_from_to);
  edge.information = lifted(loop.match.information);
  ties_.push_back({edge, joins ? TieState::kBetweenComponents : TieState::kBelieved});
}

/// A component moves to where loops say that it lies in another one, once enough of them agree.
void GraphRefiner::joinComponents() {
  const auto component = components();
  const auto componentOf = [&](base::SubMapId id) {
    return component[static_cast<std::size_t>(&vertexOf(id) - vertices_.data())];
  };
  /// Where the loop moves the component of its end.
  const auto moveOf = [&](const Tie& tie) -> geometry::Pose3 {
    return T_map_submap(tie.edge.from) * tie.edge.T_from_to * T_map_submap(tie.edge.to).inverse();
  };
  for (const auto& first : ties_) {
    if (first.state != TieState::kBetweenComponents) continue;
    const int from = componentOf(first.edge.from);
    const int to = componentOf(first.edge.to);
    if (from == to) continue;
    const auto agrees = [&](const Tie& other) {
      return other.state == TieState::kBetweenComponents && componentOf(other.edge.from) == from &&
             componentOf(other.edge.to) == to &&
             isNear(moveOf(first) * T_map_submap(first.edge.to), moveOf(other) * T_map_submap(first.edge.to),
                    kAgreement, kAgreementTurn);
    };
    std::set<base::SubMapId> seenFrom;
    std::set<base::SubMapId> seenTo;
    for (const auto& tie : ties_) {
      if (!agrees(tie)) continue;
      seenFrom.insert(tie.edge.from);
      seenTo.insert(tie.edge.to);
    }
    if (std::min(seenFrom.size(), seenTo.size()) < kWitnesses) continue;
    const geometry::Pose3 T_after_before = moveOf(first);
    for (auto& tie : ties_) {
      if (agrees(tie)) tie.state = TieState::kBelieved;
    }
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      auto& node = vertices_[i].node;
      if (component[i] == to) node.T_map_submap = T_after_before * node.T_map_submap;
    }
    return joinComponents();
  }
  // What is between components that are one by now is a loop like any other.
  for (auto& tie : ties_) {
    if (tie.state == TieState::kBetweenComponents && componentOf(tie.edge.from) == componentOf(tie.edge.to))
      tie.state = TieState::kBelieved;
  }
}

void GraphRefiner::settle() {
  if (findsLoops_ && std::ranges::any_of(ties_, [](const Tie& tie) { return isFound(tie.edge); })) refine(false);
}

void GraphRefiner::refine(bool isIncremental) {
  auto graph = poseGraph(true);
  const auto report = localization::optimize(graph, {.isIncremental = isIncremental});
  std::size_t constraint = 0;
  for (auto& tie : ties_) {
    if (tie.state == TieState::kBetweenComponents) continue;
    tie.state = report.weights[constraint++] < 0.5 ? TieState::kGivenUp : TieState::kBelieved;
  }
  for (std::size_t i = 0; i < vertices_.size(); ++i) vertices_[i].node.T_map_submap = graph.vertices[i].pose;
}

localization::PoseGraph GraphRefiner::poseGraph(bool withDoubtful) const {
  localization::PoseGraph graph;
  graph.vertices.reserve(vertices_.size());
  for (const auto& [node, told, isTold] : vertices_) graph.vertices.push_back({node.id.value, node.T_map_submap});
  for (const auto& [edge, state, isTold] : ties_) {
    const bool isUsed = state == TieState::kBelieved || (withDoubtful && state == TieState::kGivenUp);
    if (!isUsed) continue;
    graph.constraints.push_back({edge.from.value, edge.to.value, edge.T_from_to, edge.information, isFound(edge)});
  }
  return graph;
}

/// Of each vertex, the number of the first vertex that believed ties lead to.
std::vector<int> GraphRefiner::components() const {
  std::vector<int> parent(vertices_.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto rootOf = [&](int i) {
    auto at = static_cast<std::size_t>(i);
    while (parent[at] != static_cast<int>(at)) {
      parent[at] = parent[static_cast<std::size_t>(parent[at])];
      at = static_cast<std::size_t>(parent[at]);
    }
    return static_cast<int>(at);
  };
  for (const auto& tie : ties_) {
    if (tie.state != TieState::kBelieved) continue;
    const int a = rootOf(static_cast<int>(&vertexOf(tie.edge.from) - vertices_.data()));
    const int b = rootOf(static_cast<int>(&vertexOf(tie.edge.to) - vertices_.data()));
    parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = rootOf(static_cast<int>(i));
  return parent;
}

geometry::Pose3 GraphRefiner::T_map_beside() const {
  geometry::Pose3 beside = geometry::Pose3::Identity();
  for (const auto& vertex : vertices_) {
    const double x = vertex.node.T_map_submap.translation().x();
    beside.translation().x() = std::max(beside.translation().x(), x + kBeside);
  }
  return beside;
}

bool GraphRefiner::meetsAnother(base::SessionId session) const {
  const auto component = components();
  std::set<int> own;
  std::set<int> others;
  for (std::size_t i = 0; i < vertices_.size(); ++i)
    (vertices_[i].node.session == session ? own : others).insert(component[i]);
  return std::ranges::any_of(own, [&](int number) { return others.contains(number); });
}

std::vector<localization::LoopPlace> GraphRefiner::places() const {
  const auto component = components();
  std::vector<localization::LoopPlace> places;
  double way = 0.0;
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const auto& node = vertices_[i].node;
    if (i > 0 && vertices_[i - 1].node.session != node.session) way = 0.0;
    if (closer_.knows(node.id)) {
      places.push_back({.id = node.id,
                        .session = node.session,
                        .component = component[i],
                        .floor = node.floor,
                        .way = way,
                        .T_map_submap = geometry::toPose2(node.T_map_submap)});
    }
    way += node.distance;
  }
  return places;
}

std::vector<base::SubMapId> GraphRefiner::linked(base::SubMapId id) const {
  std::vector<base::SubMapId> linked;
  for (const auto& tie : ties_) {
    if (tie.edge.from == id) linked.push_back(tie.edge.to);
    if (tie.edge.to == id) linked.push_back(tie.edge.from);
  }
  return linked;
}

localization::MatchedLayers GraphRefiner::layersOf(base::SubMapId id) {
  const auto found = std::ranges::find(recentLayers_, id, &decltype(recentLayers_)::value_type::first);
  if (found != recentLayers_.end()) return found->second;
  const auto read = [&]<typename Layer>(std::shared_ptr<const Layer>& layer) {
    layer = std::dynamic_pointer_cast<const Layer>(
        std::shared_ptr<const map::MapLayer>(store_.findLayer(id, Layer::kTypeId)));
  };
  localization::MatchedLayers layers;
  read(layers.surface);
  read(layers.grid);
  keepLayers(id, layers);
  return layers;
}

void GraphRefiner::keepLayers(base::SubMapId id, localization::MatchedLayers layers) {
  recentLayers_.emplace_back(id, std::move(layers));
  if (recentLayers_.size() > kRecentLayers) recentLayers_.pop_front();
}

void GraphRefiner::addTo(map::MapChange& change, base::SubMapId running, bool all) {
  std::optional<localization::Covariances<geometry::Pose3>> covariances;
  if (all && !vertices_.empty()) covariances.emplace(poseGraph(false));
  for (auto& [node, T_map_told, isTold] : vertices_) {
    if (node.id == running) continue;
    const double least = all ? 0.0 : kLeastMove;
    if (isTold && !all && isNear(T_map_told, node.T_map_submap, least, least)) continue;
    if (covariances) node.covariance = covariances->of(node.id.value);
    change.nodes.push_back(node);
    T_map_told = node.T_map_submap;
    isTold = true;
  }
  for (auto& tie : ties_) {
    const bool isBelieved = tie.state == TieState::kBelieved;
    if (tie.isTold == isBelieved || tie.edge.to == running) continue;
    if (isBelieved) {
      change.edges.push_back(tie.edge);
    } else {
      change.removedEdges.push_back(tie.edge.id);
    }
    tie.isTold = isBelieved;
  }
}

void GraphRefiner::save(base::ByteWriter& out) const {
  out << nextNode_ << nextEdge_;
  out << static_cast<std::uint64_t>(vertices_.size());
  for (const auto& [node, T_map_told, isTold] : vertices_) {
    saveNode(out, node);
    savePose(out, T_map_told);
    out << isTold;
  }
  out << static_cast<std::uint64_t>(ties_.size());
  for (const auto& [edge, state, isTold] : ties_) {
    saveEdge(out, edge);
    out << state << isTold;
  }
}

void GraphRefiner::load(base::ByteReader& in) {
  in >> nextNode_ >> nextEdge_;
  vertices_.resize(countOf(in));
  for (auto& [node, T_map_told, isTold] : vertices_) {
    node = loadNode(in);
    T_map_told = loadPose(in);
    in >> isTold;
  }
  ties_.resize(countOf(in));
  for (auto& [edge, state, isTold] : ties_) {
    edge = loadEdge(in);
    in >> state >> isTold;
  }
}

}  // namespace prodomos::mapper

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/topological_graph.hpp"

#include "prodomos/base/error.hpp"

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/connected_components.hpp>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <boost/graph/filtered_graph.hpp>
#include <boost/property_map/function_property_map.hpp>

#include <algorithm>
#include <map>

namespace prodomos::map {

namespace {

using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, Node, Edge>;
using Vertex = boost::graph_traits<Graph>::vertex_descriptor;
using Link = boost::graph_traits<Graph>::edge_descriptor;

/// Keeps what does not delimit places.
struct WithinPlace {
  const Graph* graph = nullptr;

  bool operator()(const Link& link) const {
    const auto& edge = (*graph)[link];
    const auto isPredicted = [&](Vertex vertex) { return (*graph)[vertex].kind == SubMapKind::kPredicted; };
    // A loop through a door joins no places, and an overlap is no way.
    return (edge.kind == EdgeKind::kTravelled || edge.kind == EdgeKind::kLoop) && !edge.cause &&
           !isPredicted(source(link, *graph)) && !isPredicted(target(link, *graph));
  }
};

/// Keeps what a robot can go along.
struct Passable {
  const Graph* graph = nullptr;

  bool operator()(const Link& link) const { return (*graph)[link].kind != EdgeKind::kOverlap; }
};

template <typename IdType>
std::vector<IdType> sortedEachOnce(std::vector<IdType> ids) {
  std::ranges::sort(ids);
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

}  // namespace

struct TopologicalGraph::Impl {
  Graph graph;
  // Removing a vertex renumbers the others, so ids are looked up here.
  std::map<base::SubMapId, Vertex> vertices;
  std::map<base::EdgeId, std::pair<base::SubMapId, base::SubMapId>> ends;

  Vertex vertex(base::SubMapId id) const {
    const auto found = vertices.find(id);
    if (found == vertices.end()) throw base::Error("there is no sub-map " + toString(id) + " in the graph");
    return found->second;
  }

  std::optional<Link> findLink(base::EdgeId id) const {
    const auto found = ends.find(id);
    if (found == ends.end()) return std::nullopt;
    for (auto [link, end] = out_edges(vertex(found->second.first), graph); link != end; ++link) {
      if (graph[*link].id == id) return *link;
    }
    return std::nullopt;
  }
};

TopologicalGraph::TopologicalGraph() : impl_(std::make_unique<Impl>()) {}
TopologicalGraph::~TopologicalGraph() = default;
TopologicalGraph::TopologicalGraph(const TopologicalGraph& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
TopologicalGraph& TopologicalGraph::operator=(const TopologicalGraph& other) {
  if (this != &other) impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}
TopologicalGraph::TopologicalGraph(TopologicalGraph&& other) noexcept = default;
TopologicalGraph& TopologicalGraph::operator=(TopologicalGraph&& other) noexcept = default;

void TopologicalGraph::addNode(const Node& node) {
  if (hasNode(node.id)) throw base::Error("the graph has a sub-map " + toString(node.id) + " already");
  impl_->vertices[node.id] = add_vertex(node, impl_->graph);
}

void TopologicalGraph::addEdge(const Edge& edge) {
  if (hasEdge(edge.id)) throw base::Error("the graph has an edge " + toString(edge.id) + " already");
  const Vertex from = impl_->vertex(edge.from);
  const Vertex to = impl_->vertex(edge.to);
  add_edge(from, to, edge, impl_->graph);
  impl_->ends[edge.id] = {edge.from, edge.to};
}

void TopologicalGraph::removeNode(base::SubMapId id) {
  const Vertex gone = impl_->vertex(id);
  for (const auto edge : edgesOf(id)) impl_->ends.erase(edge);
  clear_vertex(gone, impl_->graph);
  remove_vertex(gone, impl_->graph);
  impl_->vertices.erase(id);
  for (auto& [other, vertex] : impl_->vertices) {
    if (vertex > gone) --vertex;
  }
}

void TopologicalGraph::removeEdge(base::EdgeId id) {
  const auto link = impl_->findLink(id);
  if (!link) throw base::Error("there is no edge " + toString(id) + " in the graph");
  remove_edge(*link, impl_->graph);
  impl_->ends.erase(id);
}

const Node* TopologicalGraph::findNode(base::SubMapId id) const {
  const auto found = impl_->vertices.find(id);
  return found == impl_->vertices.end() ? nullptr : &impl_->graph[found->second];
}

const Node& TopologicalGraph::getNode(base::SubMapId id) const {
  return impl_->graph[impl_->vertex(id)];
}
Node& TopologicalGraph::getNode(base::SubMapId id) {
  return impl_->graph[impl_->vertex(id)];
}

const Edge* TopologicalGraph::findEdge(base::EdgeId id) const {
  const auto link = impl_->findLink(id);
  return link ? &impl_->graph[*link] : nullptr;
}

const Edge& TopologicalGraph::getEdge(base::EdgeId id) const {
  const auto* edge = findEdge(id);
  if (edge == nullptr) throw base::Error("there is no edge " + toString(id) + " in the graph");
  return *edge;
}

Edge& TopologicalGraph::getEdge(base::EdgeId id) {
  const auto link = impl_->findLink(id);
  if (!link) throw base::Error("there is no edge " + toString(id) + " in the graph");
  return impl_->graph[*link];
}

std::vector<base::SubMapId> TopologicalGraph::nodes() const {
  std::vector<base::SubMapId> ids;
  ids.reserve(impl_->vertices.size());
  for (const auto& [id, vertex] : impl_->vertices) ids.push_back(id);
  return ids;
}

std::vector<base::EdgeId> TopologicalGraph::edges() const {
  std::vector<base::EdgeId> ids;
  ids.reserve(impl_->ends.size());
  for (const auto& [id, ends] : impl_->ends) ids.push_back(id);
  return ids;
}

std::vector<base::EdgeId> TopologicalGraph::edgesOf(base::SubMapId id) const {
  std::vector<base::EdgeId> ids;
  for (auto [link, end] = out_edges(impl_->vertex(id), impl_->graph); link != end; ++link) {
    ids.push_back(impl_->graph[*link].id);
  }
  return sortedEachOnce(std::move(ids));  // one that leads back comes twice
}

std::vector<base::SubMapId> TopologicalGraph::neighbours(base::SubMapId id) const {
  std::vector<base::SubMapId> ids;
  for (auto [vertex, end] = adjacent_vertices(impl_->vertex(id), impl_->graph); vertex != end; ++vertex) {
    ids.push_back(impl_->graph[*vertex].id);
  }
  return sortedEachOnce(std::move(ids));
}

std::vector<TopologicalPlace> TopologicalGraph::places() const {
  const auto& graph = impl_->graph;
  std::vector<int> component(num_vertices(graph));
  const boost::filtered_graph<Graph, WithinPlace> within(graph, WithinPlace{&graph});
  connected_components(within, component.data());

  std::vector<TopologicalPlace> places;
  std::map<int, std::size_t> placeOfComponent;
  for (const auto& [id, vertex] : impl_->vertices) {
    const auto [known, isNew] = placeOfComponent.try_emplace(component[vertex], places.size());
    if (isNew) places.push_back({static_cast<int>(places.size()), {}});
    places[known->second].submaps.push_back(id);
  }
  return places;
}

int TopologicalGraph::componentCount() const {
  std::vector<int> component(num_vertices(impl_->graph));
  return connected_components(impl_->graph, component.data());
}

std::optional<Route> TopologicalGraph::shortestRoute(base::SubMapId from, base::SubMapId to) const {
  return shortestRoutes(from, {to}).front();
}

std::vector<std::optional<Route>> TopologicalGraph::shortestRoutes(base::SubMapId from,
                                                                   const std::vector<base::SubMapId>& to) const {
  const auto& graph = impl_->graph;
  const Vertex start = impl_->vertex(from);
  const auto length = [&graph](const Link& link) {
    return (graph[source(link, graph)].T_map_submap.translation() -
            graph[target(link, graph)].T_map_submap.translation())
        .norm();
  };
  std::vector<double> distance(num_vertices(graph));
  std::vector<Vertex> before(num_vertices(graph));
  const auto index = get(boost::vertex_index, graph);
  const boost::filtered_graph<Graph, Passable> passable(graph, Passable{&graph});
  dijkstra_shortest_paths(passable, start,
                          boost::weight_map(boost::make_function_property_map<Link>(length))
                              .distance_map(make_iterator_property_map(distance.begin(), index))
                              .predecessor_map(make_iterator_property_map(before.begin(), index)));
  const auto routeTo = [&](base::SubMapId id) -> std::optional<Route> {
    const Vertex goal = impl_->vertex(id);
    if (start != goal && before[goal] == goal) return std::nullopt;
    Route route{.submaps = {id}, .edges = {}, .length = distance[goal]};
    for (Vertex at = goal; at != start; at = before[at]) {
      route.edges.push_back(graph[edge(before[at], at, passable).first].id);
      route.submaps.push_back(graph[before[at]].id);
    }
    std::ranges::reverse(route.submaps);
    std::ranges::reverse(route.edges);
    return route;
  };
  std::vector<std::optional<Route>> routes;
  routes.reserve(to.size());
  for (const auto id : to) routes.push_back(routeTo(id));
  return routes;
}

std::string_view toString(SubMapKind kind) {
  return kind == SubMapKind::kObserved ? "observed" : "predicted";
}

std::string_view toString(EdgeKind kind) {
  switch (kind) {
    case EdgeKind::kTravelled:
      return "travelled";
    case EdgeKind::kDoor:
      return "door";
    case EdgeKind::kStairs:
      return "stairs";
    case EdgeKind::kLoop:
      return "loop";
    case EdgeKind::kLift:
      return "lift";
    case EdgeKind::kOverlap:
      return "overlap";
  }
  return "";
}

}  // namespace prodomos::map

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/topological_graph.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/base/random.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <set>

namespace prodomos::map {
namespace {

using base::EdgeId;
using base::SubMapId;
using testing::ElementsAre;
using testing::IsEmpty;

Node nodeOf(std::int64_t id, double x = 0.0, double y = 0.0, SubMapKind kind = SubMapKind::kObserved) {
  Node node;
  node.id = {id};
  node.kind = kind;
  node.T_map_submap = geometry::toPose3({x, y, 0.0});
  return node;
}

Edge edgeOf(std::int64_t id, std::int64_t from, std::int64_t to, EdgeKind kind = EdgeKind::kTravelled) {
  Edge edge;
  edge.id = {id};
  edge.from = {from};
  edge.to = {to};
  edge.kind = kind;
  return edge;
}

/// The graph once more, as plain as can be.
struct PlainGraph {
  std::map<SubMapId, Node> nodes;
  std::map<EdgeId, Edge> edges;

  void removeNode(SubMapId id) {
    nodes.erase(id);
    std::erase_if(edges, [&](const auto& entry) { return entry.second.from == id || entry.second.to == id; });
  }

  double length(const Edge& edge) const {
    return (nodes.at(edge.from).T_map_submap.translation() - nodes.at(edge.to).T_map_submap.translation()).norm();
  }
};

template <typename Map>
auto keysOf(const Map& map) {
  std::vector<typename Map::key_type> keys;
  for (const auto& [key, value] : map) keys.push_back(key);
  return keys;
}

template <typename Container>
auto anyOf(base::Random& random, const Container& container) {
  return *std::next(container.begin(), random.integer(0, static_cast<int>(container.size()) - 1));
}

/// Grows and shrinks at random.
struct RandomGraphs {
  TopologicalGraph graph;
  PlainGraph plain;
  std::int64_t nextNode = 1;
  std::int64_t nextEdge = 1;

  void change(base::Random& random) {
    const double what = random.uniform();
    if (what < 0.4 || plain.nodes.size() < 2) {
      const auto kind = random.uniform() < 0.2 ? SubMapKind::kPredicted : SubMapKind::kObserved;
      const auto node = nodeOf(nextNode++, random.integer(-9, 9), random.integer(-9, 9), kind);
      graph.addNode(node);
      plain.nodes[node.id] = node;
    } else if (what < 0.8) {
      const auto kind = static_cast<EdgeKind>(random.integer(0, 4));
      const auto edge =
          edgeOf(nextEdge++, anyOf(random, plain.nodes).first.value, anyOf(random, plain.nodes).first.value, kind);
      graph.addEdge(edge);
      plain.edges[edge.id] = edge;
    } else if (what < 0.9 && !plain.edges.empty()) {
      const auto id = anyOf(random, plain.edges).first;
      graph.removeEdge(id);
      plain.edges.erase(id);
    } else {
      const auto id = anyOf(random, plain.nodes).first;
      graph.removeNode(id);
      plain.removeNode(id);
    }
  }
};

void expectSame(const TopologicalGraph& graph, const PlainGraph& plain) {
  ASSERT_EQ(graph.nodes(), keysOf(plain.nodes));
  ASSERT_EQ(graph.edges(), keysOf(plain.edges));
  for (const auto& [id, node] : plain.nodes) {
    ASSERT_TRUE(graph.hasNode(id));
    ASSERT_EQ(graph.getNode(id).id, id);
    ASSERT_EQ(graph.getNode(id).T_map_submap.translation(), node.T_map_submap.translation());
    std::set<EdgeId> edges;
    std::set<SubMapId> neighbours;
    for (const auto& [edgeId, edge] : plain.edges) {
      if (edge.from != id && edge.to != id) continue;
      edges.insert(edgeId);
      neighbours.insert(edge.from == id ? edge.to : edge.from);
    }
    const auto found = graph.edgesOf(id);
    ASSERT_EQ(std::set<EdgeId>(found.begin(), found.end()), edges);
    ASSERT_EQ(found.size(), edges.size()) << "each once, of a loop to itself too";
    ASSERT_EQ(graph.neighbours(id), (std::vector<SubMapId>(neighbours.begin(), neighbours.end())));
  }
  for (const auto& [id, edge] : plain.edges) {
    ASSERT_EQ(graph.getEdge(id).from, edge.from);
    ASSERT_EQ(graph.getEdge(id).to, edge.to);
    ASSERT_EQ(graph.getEdge(id).kind, edge.kind);
  }
}

/// Union-find.
std::map<SubMapId, SubMapId> leastOfParts(const PlainGraph& plain, const std::function<bool(const Edge&)>& joins) {
  std::map<SubMapId, SubMapId> root;
  for (const auto& [id, node] : plain.nodes) root[id] = id;
  const auto rootOf = [&](SubMapId id) {
    while (root[id] != id) id = root[id];
    return id;
  };
  for (const auto& [id, edge] : plain.edges) {
    if (!joins(edge)) continue;
    const auto one = rootOf(edge.from);
    const auto other = rootOf(edge.to);
    root[std::max(one, other)] = std::min(one, other);
  }
  for (auto& [id, ignored] : root) root[id] = rootOf(id);
  return root;
}

// --- against the oracles

TEST(TopologicalGraph, KeepsItsIdsWhileOthersAreRemoved) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    base::Random random(seed);
    RandomGraphs both;
    for (int i = 0; i < 300; ++i) {
      both.change(random);
      ASSERT_NO_FATAL_FAILURE(expectSame(both.graph, both.plain)) << "seed " << seed << " change " << i;
    }
  }
}

TEST(TopologicalGraph, PlacesAreWhatStaysConnectedWithoutDoorsStairsAndLifts) {
  for (const std::uint64_t seed : {4, 5, 6}) {
    base::Random random(seed);
    RandomGraphs both;
    for (int i = 0; i < 200; ++i) {
      both.change(random);
      const auto least = leastOfParts(both.plain, [&](const Edge& edge) {
        return (edge.kind == EdgeKind::kTravelled || edge.kind == EdgeKind::kLoop) &&
               both.plain.nodes.at(edge.from).kind == SubMapKind::kObserved &&
               both.plain.nodes.at(edge.to).kind == SubMapKind::kObserved;
      });
      std::map<SubMapId, std::vector<SubMapId>> expected;  // by the least sub-map
      for (const auto& [id, first] : least) expected[first].push_back(id);
      const auto places = both.graph.places();
      ASSERT_EQ(places.size(), expected.size());
      int number = 0;
      for (const auto& [first, submaps] : expected) {
        ASSERT_EQ(places[static_cast<std::size_t>(number)].number, number);
        ASSERT_EQ(places[static_cast<std::size_t>(number)].submaps, submaps);
        ++number;
      }
      const auto parts = leastOfParts(both.plain, [](const Edge&) { return true; });
      std::set<SubMapId> roots;
      for (const auto& [id, root] : parts) roots.insert(root);
      ASSERT_EQ(both.graph.componentCount(), static_cast<int>(roots.size()));
    }
  }
}

TEST(TopologicalGraph, RoutesAreAsShortAsFloydAndWarshallsAre) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  base::Random random(7);
  for (int run = 0; run < 15; ++run) {
    RandomGraphs both;
    for (int i = 0; i < 60; ++i) both.change(random);
    const auto ids = both.graph.nodes();
    std::map<std::pair<SubMapId, SubMapId>, double> distance;
    for (const auto a : ids) {
      for (const auto b : ids) distance[{a, b}] = a == b ? 0.0 : kNever;
    }
    for (const auto& [id, edge] : both.plain.edges) {
      auto& forth = distance[{edge.from, edge.to}];
      forth = distance[{edge.to, edge.from}] = std::min(forth, both.plain.length(edge));
    }
    for (const auto via : ids) {
      for (const auto a : ids) {
        for (const auto b : ids) distance[{a, b}] = std::min(distance[{a, b}], distance[{a, via}] + distance[{via, b}]);
      }
    }
    for (const auto a : ids) {
      for (const auto b : ids) {
        const auto route = both.graph.shortestRoute(a, b);
        ASSERT_EQ(route.has_value(), distance[std::make_pair(a, b)] < kNever);
        if (!route) continue;
        ASSERT_NEAR(route->length, distance[std::make_pair(a, b)], 1e-9);
        ASSERT_EQ(route->submaps.front(), a);
        ASSERT_EQ(route->submaps.back(), b);
        ASSERT_EQ(route->edges.size() + 1, route->submaps.size());
        double length = 0.0;
        for (std::size_t i = 0; i < route->edges.size(); ++i) {
          const auto& edge = both.plain.edges.at(route->edges[i]);
          const std::set<SubMapId> ends{edge.from, edge.to};
          ASSERT_EQ(ends, (std::set<SubMapId>{route->submaps[i], route->submaps[i + 1]}));
          length += both.plain.length(edge);
        }
        ASSERT_NEAR(length, route->length, 1e-9);
      }
      const auto routes = both.graph.shortestRoutes(a, {ids.begin(), ids.end()});
      ASSERT_EQ(routes.size(), ids.size());
      for (std::size_t i = 0; i < ids.size(); ++i) {
        const auto one = both.graph.shortestRoute(a, *std::next(ids.begin(), static_cast<std::ptrdiff_t>(i)));
        ASSERT_EQ(routes[i].has_value(), one.has_value());
        if (!one) continue;
        ASSERT_EQ(routes[i]->submaps, one->submaps);
      }
    }
  }
}

// --- by hand

TEST(TopologicalGraph, IsEmptyAtFirst) {
  const TopologicalGraph graph;
  EXPECT_THAT(graph.nodes(), IsEmpty());
  EXPECT_THAT(graph.edges(), IsEmpty());
  EXPECT_THAT(graph.places(), IsEmpty());
  EXPECT_EQ(graph.componentCount(), 0);
}

TEST(TopologicalGraph, APredictedSubMapIsAPlaceOfItsOwn) {
  TopologicalGraph graph;
  graph.addNode(nodeOf(1));
  graph.addNode(nodeOf(2));
  graph.addNode(nodeOf(3, 0, 0, SubMapKind::kPredicted));
  graph.addEdge(edgeOf(1, 1, 2));
  graph.addEdge(edgeOf(2, 2, 3));
  const auto places = graph.places();
  ASSERT_EQ(places.size(), 2U);
  EXPECT_THAT(places[0].submaps, ElementsAre(SubMapId{1}, SubMapId{2}));
  EXPECT_THAT(places[1].submaps, ElementsAre(SubMapId{3}));
}

TEST(TopologicalGraph, ALoopThroughADoorAndAnOverlapJoinNoPlaces) {
  TopologicalGraph graph;
  for (int i = 1; i <= 4; ++i) graph.addNode(nodeOf(i));
  auto through = edgeOf(1, 1, 2);
  through.kind = EdgeKind::kLoop;
  through.cause = base::EntityId{7};
  auto loop = edgeOf(2, 2, 3);
  loop.kind = EdgeKind::kLoop;
  auto overlap = edgeOf(3, 3, 4);
  overlap.kind = EdgeKind::kOverlap;
  for (const auto& edge : {through, loop, overlap}) graph.addEdge(edge);
  const auto places = graph.places();
  ASSERT_EQ(places.size(), 3U);
  EXPECT_THAT(places[1].submaps, ElementsAre(SubMapId{2}, SubMapId{3}));
}

TEST(TopologicalGraph, IsWalkedBothWays) {
  TopologicalGraph graph;
  graph.addNode(nodeOf(1));
  graph.addNode(nodeOf(2, 3, 4));
  graph.addEdge(edgeOf(1, 1, 2));
  for (const auto& [from, to] : {std::pair{1, 2}, {2, 1}}) {
    const auto route = graph.shortestRoute({from}, {to});
    ASSERT_TRUE(route);
    EXPECT_DOUBLE_EQ(route->length, 5.0);
    EXPECT_THAT(route->submaps, ElementsAre(SubMapId{from}, SubMapId{to}));
    EXPECT_THAT(route->edges, ElementsAre(EdgeId{1}));
  }
}

TEST(TopologicalGraph, TheWayToWhereOneIsHasNoLength) {
  TopologicalGraph graph;
  graph.addNode(nodeOf(5));
  const auto route = graph.shortestRoute({5}, {5});
  ASSERT_TRUE(route);
  EXPECT_EQ(route->length, 0.0);
  EXPECT_THAT(route->submaps, ElementsAre(SubMapId{5}));
  EXPECT_THAT(route->edges, IsEmpty());
}

TEST(TopologicalGraph, FollowsRefinedPoses) {
  TopologicalGraph graph;
  for (int i = 1; i <= 4; ++i) graph.addNode(nodeOf(i, i == 2 ? 9 : i, 0));
  for (const auto& edge : {edgeOf(1, 1, 2), edgeOf(2, 2, 4), edgeOf(3, 1, 3), edgeOf(4, 3, 4)}) graph.addEdge(edge);
  EXPECT_THAT(graph.shortestRoute({1}, {4})->edges, ElementsAre(EdgeId{3}, EdgeId{4}));
  graph.getNode({2}).T_map_submap.translation().x() = 2;
  graph.getNode({3}).T_map_submap.translation().y() = 5;
  EXPECT_THAT(graph.shortestRoute({1}, {4})->edges, ElementsAre(EdgeId{1}, EdgeId{2}));
}

TEST(TopologicalGraph, ACopyIsOfItsOwn) {
  TopologicalGraph graph;
  graph.addNode(nodeOf(1));
  graph.addNode(nodeOf(2));
  graph.addEdge(edgeOf(1, 1, 2));
  auto copy = graph;
  copy.removeNode({1});
  EXPECT_THAT(graph.nodes(), ElementsAre(SubMapId{1}, SubMapId{2}));
  EXPECT_THAT(copy.nodes(), ElementsAre(SubMapId{2}));
  EXPECT_THAT(copy.edges(), IsEmpty());
  graph = copy;
  EXPECT_THAT(graph.nodes(), ElementsAre(SubMapId{2}));
  const auto moved = std::move(copy);
  EXPECT_THAT(moved.nodes(), ElementsAre(SubMapId{2}));
}

TEST(TopologicalGraph, RefusesIdsThatAreTakenAndEndsThatAreMissing) {
  TopologicalGraph graph;
  graph.addNode(nodeOf(1));
  graph.addNode(nodeOf(2));
  graph.addEdge(edgeOf(1, 1, 2));
  EXPECT_THROW(graph.addNode(nodeOf(1)), base::Error);
  EXPECT_THROW(graph.addEdge(edgeOf(1, 2, 1)), base::Error);
  EXPECT_THROW(graph.addEdge(edgeOf(2, 1, 9)), base::Error);
  EXPECT_THROW(graph.addEdge(edgeOf(2, 9, 1)), base::Error);
  EXPECT_THAT(graph.nodes(), ElementsAre(SubMapId{1}, SubMapId{2}));
  EXPECT_THAT(graph.edges(), ElementsAre(EdgeId{1}));
}

TEST(TopologicalGraph, SaysWhichIdIsNotThere) {
  TopologicalGraph graph;
  EXPECT_EQ(graph.findNode({7}), nullptr);
  EXPECT_EQ(graph.findEdge({7}), nullptr);
  EXPECT_FALSE(graph.hasNode({7}));
  EXPECT_FALSE(graph.hasEdge({7}));
  const auto expectError = [](const std::function<void()>& act, const char* id) {
    try {
      act();
      ADD_FAILURE() << "no error about " << id;
    } catch (const base::Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(id));
    }
  };
  expectError([&] { graph.getNode({7}); }, "s7");
  expectError([&] { graph.removeNode({7}); }, "s7");
  expectError([&] { graph.edgesOf({7}); }, "s7");
  expectError([&] { graph.neighbours({7}); }, "s7");
  expectError([&] { graph.shortestRoute({7}, {8}); }, "s7");
  expectError([&] { graph.getEdge({7}); }, "e7");
  expectError([&] { graph.removeEdge({7}); }, "e7");
}

}  // namespace
}  // namespace prodomos::map

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/id.hpp"
#include "prodomos/base/time.hpp"
#include "prodomos/geometry/pose.hpp"

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace prodomos::map {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

enum class SubMapKind { kObserved, kPredicted };

/// A sub-map as the graph knows it: all but its layers and entities.
struct Node {
  base::SubMapId id;
  base::SessionId session;
  SubMapKind kind = SubMapKind::kObserved;
  std::optional<int> floor;  ///< number of the floor, 0 where the first session began
  std::optional<int> place;  ///< number of the topological place; a property of the whole graph
  geometry::Pose3 T_map_submap = geometry::Pose3::Identity();     ///< as refined: what everybody should use
  geometry::Pose3 T_travel_submap = geometry::Pose3::Identity();  ///< as travelled, never changed afterwards
  /// Of T_map_submap relative to the map's first sub-map: (translation in metres, rotation vector in radians) in the
  /// axes of the sub-map. None until poses are refined.
  std::optional<Matrix6> covariance{};
  base::Time begin{};
  base::Time end{};
  double distance = 0.0;  ///< metres travelled within
  int readings = 0;       ///< integrated
};

/// How one gets from one sub-map to the other. An overlap is no way: both show the same place, which ties their poses,
/// but between their origins nobody has seen free floor.
enum class EdgeKind { kTravelled, kDoor, kStairs, kLoop, kLift, kOverlap };

/// Reachability between two sub-maps.
struct Edge {
  base::EdgeId id;
  base::SubMapId from;
  base::SubMapId to;
  EdgeKind kind = EdgeKind::kTravelled;
  geometry::Pose3 T_from_to = geometry::Pose3::Identity();
  /// Of deviations of the measured T_from_to in its own axes, those of `to`: translation in metres, then rotation
  /// vector in radians. As in localization::Constraint, g2o (but for its half angles) and GTSAM (but for its order).
  Matrix6 information = Matrix6::Zero();
  std::optional<base::EntityId> cause;  ///< the door or staircase; also of a loop that leads through a door
};

/// What is left connected when all edges are cut that lead through a door, up or down (002 §II-A); overlaps are none.
struct TopologicalPlace {
  int number = 0;
  std::vector<base::SubMapId> submaps;  ///< ascending
};

struct Route {
  std::vector<base::SubMapId> submaps;  ///< from start to goal
  std::vector<base::EdgeId> edges;      ///< one fewer
  double length = 0.0;                  ///< metres, from origin to origin
};

/// Nodes are sub-maps, edges reachability (002 §II-A); on Boost.Graph, with ids that stay when others are removed.
class TopologicalGraph {
 public:
  TopologicalGraph();
  ~TopologicalGraph();
  TopologicalGraph(const TopologicalGraph& other);
  TopologicalGraph& operator=(const TopologicalGraph& other);
  TopologicalGraph(TopologicalGraph&& other) noexcept;
  TopologicalGraph& operator=(TopologicalGraph&& other) noexcept;

  /// Throws base::Error where the id is taken.
  void addNode(const Node& node);
  /// Throws base::Error where the id is taken or an end is missing.
  void addEdge(const Edge& edge);
  void removeNode(base::SubMapId id);  ///< and its edges
  void removeEdge(base::EdgeId id);

  bool hasNode(base::SubMapId id) const { return findNode(id) != nullptr; }
  const Node* findNode(base::SubMapId id) const;  ///< null where there is none
  const Node& getNode(base::SubMapId id) const;   ///< throws base::Error where there is none
  Node& getNode(base::SubMapId id);
  bool hasEdge(base::EdgeId id) const { return findEdge(id) != nullptr; }
  const Edge* findEdge(base::EdgeId id) const;
  const Edge& getEdge(base::EdgeId id) const;
  Edge& getEdge(base::EdgeId id);

  std::vector<base::SubMapId> nodes() const;                        ///< ascending
  std::vector<base::EdgeId> edges() const;                          ///< ascending
  std::vector<base::EdgeId> edgesOf(base::SubMapId id) const;       ///< ascending
  std::vector<base::SubMapId> neighbours(base::SubMapId id) const;  ///< ascending, each once

  /// Ordered by their least sub-map; a predicted node is a place of its own.
  std::vector<TopologicalPlace> places() const;
  /// How many parts the graph falls into, all edges counting.
  int componentCount() const;
  /// The shortest by distance between origins (Dijkstra), overlaps apart; none where the two are not connected.
  std::optional<Route> shortestRoute(base::SubMapId from, base::SubMapId to) const;
  /// To each of them, at little more than the cost of one.
  std::vector<std::optional<Route>> shortestRoutes(base::SubMapId from, const std::vector<base::SubMapId>& to) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// "observed", "predicted".
std::string_view toString(SubMapKind kind);
/// "travelled", "door", "stairs", "loop", "lift", "overlap".
std::string_view toString(EdgeKind kind);

}  // namespace prodomos::map

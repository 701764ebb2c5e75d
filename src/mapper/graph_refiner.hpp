// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/bytes.hpp"
#include "prodomos/localization/loop_closer.hpp"
#include "prodomos/localization/pose_graph.hpp"
#include "prodomos/map/map_store.hpp"

#include <deque>
#include <optional>
#include <vector>

namespace prodomos::mapper {

/// Holds the graph of all observed sub-maps, of all sessions, and keeps its poses the best: looks for loops of each
/// sub-map that is finished, and refines all poses when one is found.
class GraphRefiner {
 public:
  /// Knows what the store holds.
  GraphRefiner(const localization::LoopCloserConfig& config, const map::MapStore& store);

  base::SubMapId newNodeId() { return {nextNode_++}; }
  base::EdgeId newEdgeId() { return {nextEdge_++}; }

  /// A sub-map begins; the edge leads to it. Without one, it begins a component of its own.
  void add(const map::Node& node, const std::optional<map::Edge>& edge);
  /// A sub-map is finished: its layers are final.
  void close(const map::SubMap& finished);
  /// The log has ended: weighs all loops against each other once more, from scratch.
  void settle();
  /// Moves all sub-maps of a session, as a whole.
  void move(base::SessionId session, const geometry::Pose3& T_after_before);

  /// Ways between sub-maps of the session, loops among them, by id.
  std::vector<map::Edge> waysOf(base::SessionId session) const;
  /// Kind and cause of a way are those now.
  void rename(const map::Edge& way);

  const map::Node& node(base::SubMapId id) const;
  const geometry::Pose3& T_map_submap(base::SubMapId id) const;
  /// All, by id.
  std::vector<map::Node> nodes() const;
  /// Of the session, by id.
  std::vector<base::SubMapId> nodesOf(base::SessionId session) const;
  /// Others of the same session and floor whose origins are no farther than `reach`: the nearest first, at most `most`.
  std::vector<map::Node> nearest(base::SubMapId id, double reach, std::size_t most) const;
  /// A place to the right of all sub-maps, for a session that has not met them yet; the origin where there are none.
  geometry::Pose3 T_map_beside() const;
  /// Does a chain of edges lead from this session to another one?
  bool meetsAnother(base::SessionId session) const;

  /// What has changed since the last call, apart from the sub-map that is running: nodes moved, loops found and given
  /// up. With `all`, every node that is off at all from what was told last, and the covariances of all.
  void addTo(map::MapChange& change, base::SubMapId running, bool all);

  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);

 private:
  struct Vertex {
    map::Node node;
    geometry::Pose3 T_map_told = geometry::Pose3::Identity();  ///< where the map file has it
    bool isTold = false;
  };
  enum class TieState { kBelieved, kGivenUp, kBetweenComponents };
  struct Tie {
    map::Edge edge;
    TieState state = TieState::kBelieved;
    bool isTold = false;
  };

  Vertex& vertexOf(base::SubMapId id);
  const Vertex& vertexOf(base::SubMapId id) const;
  std::vector<int> components() const;
  std::vector<localization::LoopPlace> places() const;
  std::vector<base::SubMapId> linked(base::SubMapId id) const;
  localization::PoseGraph poseGraph(bool withDoubtful) const;
  localization::MatchedLayers layersOf(base::SubMapId id);
  void keepLayers(base::SubMapId id, localization::MatchedLayers layers);

  void tie(const localization::Loop& loop, bool joins);
  void joinComponents();
  bool isNews(const Tie& tie) const;
  void refine(bool isIncremental);

  const map::MapStore& store_;
  bool findsLoops_;
  localization::LoopCloser closer_;
  std::int64_t nextNode_ = 0;
  std::int64_t nextEdge_ = 0;
  std::vector<Vertex> vertices_;  // ascending by id
  std::vector<Tie> ties_;         // ascending by id
  std::deque<std::pair<base::SubMapId, localization::MatchedLayers>> recentLayers_;
};

}  // namespace prodomos::mapper

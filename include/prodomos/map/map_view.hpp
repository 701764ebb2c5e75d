// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/entity.hpp"
#include "prodomos/map/layer.hpp"
#include "prodomos/map/prediction.hpp"
#include "prodomos/map/records.hpp"
#include "prodomos/map/submap.hpp"
#include "prodomos/map/topological_graph.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace prodomos::map {

class Database;

/// What changed after a revision.
struct MapChanges {
  std::int64_t revision = 0;  ///< up to and including this one
  std::vector<base::SubMapId> nodes;
  std::vector<base::EdgeId> edges;
  std::vector<base::EntityId> entities;
  std::vector<base::PredictionId> predictions;
  std::vector<Event> events;
};

/// A map to read, from a file or of a running mapper. Graph, entities and predictions are those of one revision, held
/// in memory; layers and trajectory are read when asked for.
class MapView {
 public:
  /// Throws base::FileError where the file is missing, no map, damaged or of a newer schema.
  static MapView open(const std::filesystem::path& path);

  std::int64_t revision() const { return revision_; }
  const std::vector<Session>& sessions() const { return sessions_; }
  const std::vector<Floor>& floors() const { return floors_; }
  const TopologicalGraph& graph() const { return graph_; }
  const std::vector<Entity>& entities() const { return entities_; }
  std::vector<Entity> entitiesOf(base::SubMapId submap) const;
  const std::vector<Prediction>& predictions() const { return predictions_; }
  /// Where the prediction's node lies, or, of a settled one, lay.
  geometry::Pose3 T_map_node(const Prediction& prediction) const {
    return graph_.getNode(prediction.submap).T_map_submap * prediction.T_submap_node;
  }

  /// Types of the layers that the sub-map holds, in the order in which they are drawn; also of types unknown here.
  std::vector<std::string> layersOf(base::SubMapId submap) const;
  /// Null where the sub-map has no such layer or the type is unknown to this version. Throws base::FileError where its
  /// bytes are damaged (checksum) or of a newer version.
  std::shared_ptr<const MapLayer> findLayer(base::SubMapId submap, std::string_view typeId) const;
  /// The same as its own class: `view.findLayer<OccupancyGrid>(id)`.
  template <typename Layer>
  std::shared_ptr<const Layer> findLayer(base::SubMapId submap) const {
    return std::dynamic_pointer_cast<const Layer>(findLayer(submap, Layer::kTypeId));
  }

  std::vector<TrajectoryPoint> trajectory() const;  ///< of all sessions, in the order of session and time
  /// The same one by one, for those who must not hold a long log at once.
  void visitTrajectory(const std::function<void(const TrajectoryPoint&)>& visit) const;
  std::vector<Event> events() const;
  std::vector<Track> tracks() const;  ///< by id, with all their states
  /// For planners that keep up with a map that grows.
  MapChanges changesSince(std::int64_t revision) const;

 private:
  friend class MapStore;
  explicit MapView(std::shared_ptr<Database> database);
  void load();

  std::shared_ptr<Database> database_;
  std::int64_t revision_ = 0;
  std::vector<Session> sessions_;
  std::vector<Floor> floors_;
  TopologicalGraph graph_;
  std::vector<Entity> entities_;
  std::vector<Prediction> predictions_;
  std::shared_ptr<const SubMap> running_;  // of a running mapper: the sub-map that is not yet in the store
};

}  // namespace prodomos::map

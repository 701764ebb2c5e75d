// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/entity.hpp"
#include "prodomos/map/map_view.hpp"
#include "prodomos/map/prediction.hpp"
#include "prodomos/map/records.hpp"
#include "prodomos/map/submap.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace prodomos::map {

class Database;

/// Everything that one commit changes. Rows whose id is there already are replaced. A session
/// that is complete loses its checkpoint.
struct MapChange {
  std::vector<Session> sessions;
  std::vector<Floor> floors;
  std::vector<Node> nodes;
  std::vector<Edge> edges;
  std::vector<base::EdgeId> removedEdges;  ///< loops that were given up
  std::vector<Entity> entities;
  std::vector<Prediction> predictions;
  std::vector<TrajectoryPoint> trajectory;
  std::vector<Event> events;
  std::vector<std::pair<base::SubMapId, const MapLayer*>> layers;
  std::optional<Checkpoint> checkpoint;
  std::vector<Track> tracks{};  ///< their states are added to those that are there; of one time, replaced
  /// Doors and stairs that were refuted, or turned out to be others seen before. Edges through them lose their cause;
  /// one that a prediction bets on stays for the ledger's sake, with confidence 0.
  std::vector<base::EntityId> removedEntities{};
  std::vector<base::SubMapId> removedNodes{};  ///< predicted ones that were settled, and their edges
};

/// The map file: SQLite in WAL mode, documented in docs/map-file.md. One store writes at a time; any number of MapViews
/// may read meanwhile, from this process or others.
class MapStore {
 public:
  /// A new file. Throws base::FileError where it cannot be written or something is there already.
  static MapStore create(const std::filesystem::path& path);
  /// An existing file, to be grown or resumed. Throws base::FileError where it is no map, damaged or of a newer
  /// schema.
  static MapStore openForWriting(const std::filesystem::path& path);
  /// In memory only, for programs that map without keeping a file.
  static MapStore inMemory();

  MapStore(MapStore&&) noexcept;
  MapStore& operator=(MapStore&&) noexcept;
  ~MapStore();

  /// All or nothing, in one transaction; returns the new revision. Throws base::FileError (disk full, …), after which
  /// the file holds what it held before.
  std::int64_t commit(const MapChange& change);
  std::optional<Checkpoint> findCheckpoint(base::SessionId session) const;
  /// As MapView::findLayer(), of what is committed.
  std::unique_ptr<MapLayer> findLayer(base::SubMapId submap, std::string_view typeId) const;
  /// What is committed, and, of a running mapper, the sub-map that is not yet, with the edge that leads to it. Its
  /// entities, wherever they lie, stand for the committed ones of the same id.
  MapView view(std::shared_ptr<const SubMap> running = nullptr, const std::optional<Edge>& edgeTo = std::nullopt) const;
  /// Brings everything into the one file (no -wal beside it) as far as readers allow.
  void close();

 private:
  explicit MapStore(std::shared_ptr<Database> database);
  std::shared_ptr<Database> database_;
};

}  // namespace prodomos::map

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/map_store.hpp"

#include "map/blob.hpp"
#include "map/database.hpp"
#include "map/rows.hpp"
#include "map/schema.hpp"

namespace prodomos::map {

namespace {

/// Writes the rows of one commit, inside its transaction.
class ChangeWriter {
 public:
  ChangeWriter(const Database& database, std::int64_t revision) : database_(database), revision_(revision) {}

  void write(const std::vector<Session>& sessions) {
    auto row = database_.prepare(upsertion("session", "id",
                                           "log, log_kind, config, poses, version, classes, state, begin_ns, end_ns, "
                                           "distance, " +
                                               poseColumns() + ", revision"));
    for (const auto& s : sessions) {
      row << s.id << s.log << s.logKind << s.config << s.poses << s.version << toJson(s.classes) << toString(s.state)
          << s.begin << s.end << s.distance << s.T_map_travel << revision_;
      row.run();
      if (s.state != SessionState::kComplete) continue;
      auto done = database_.prepare("DELETE FROM checkpoint WHERE session = ?");
      done << s.id;
      done.run();
    }
  }

  void write(const std::vector<Floor>& floors) {
    auto row = database_.prepare(upsertion("floor", "number", "height, revision"));
    for (const auto& floor : floors) {
      row << floor.number << floor.height << revision_;
      row.run();
    }
  }

  /// All but the place, which is the whole graph's to say.
  void write(const std::vector<Node>& nodes) {
    auto row =
        database_.prepare(upsertion("node", "id",
                                    "session, kind, floor, begin_ns, end_ns, distance, readings, " + poseColumns() +
                                        ", " + poseColumns("travel_") + ", covariance, revision"));
    for (const auto& node : nodes) {
      row << node.id << node.session << toString(node.kind) << node.floor << node.begin << node.end << node.distance
          << node.readings << node.T_map_submap << node.T_travel_submap
          << (node.covariance ? std::optional(upperTriangle(*node.covariance)) : std::nullopt) << revision_;
      row.run();
    }
  }

  void write(const std::vector<Edge>& edges) {
    auto row = database_.prepare(
        upsertion("edge", "id", "from_node, to_node, kind, " + poseColumns() + ", information, entity, revision"));
    for (const auto& edge : edges) {
      row << edge.id << edge.from << edge.to << toString(edge.kind) << edge.T_from_to << upperTriangle(edge.information)
          << edge.cause << revision_;
      row.run();
    }
  }

  void remove(const std::vector<base::EdgeId>& edges) {
    auto row = database_.prepare("DELETE FROM edge WHERE id = ?");
    for (const auto id : edges) {
      row << id;
      row.run();
    }
  }

  void remove(const std::vector<base::SubMapId>& nodes) {
    auto edges = database_.prepare(
        "DELETE FROM edge WHERE ?1 IN (from_node, to_node) AND ?1 IN (SELECT id FROM node WHERE kind = 'predicted')");
    auto row = database_.prepare("DELETE FROM node WHERE id = ? AND kind = 'predicted'");
    for (const auto id : nodes) {
      edges << id;
      edges.run();
      row << id;
      row.run();
    }
  }

  void write(const std::vector<Entity>& entities) {
    auto row = database_.prepare(upsertion("entity", "id",
                                           "node, class, mobility, " + poseColumns() +
                                               ", attributes, confidence, observations, first_seen_ns, last_seen_ns, "
                                               "covariance, points, revision"));
    for (const auto& entity : entities) {
      const std::span points(entity.points_in_submap);
      row << entity.id << entity.submap << className(entity.attributes) << toString(mobility(entity.attributes))
          << entity.T_submap_entity << toJson(entity.attributes) << entity.confidence << entity.observations
          << entity.firstSeen << entity.lastSeen << upperTriangle(entity.covariance)
          << std::span<const std::byte>(std::as_bytes(points)) << revision_;
      row.run();
    }
  }

  void remove(const std::vector<base::EntityId>& entities) {
    auto edge = database_.prepare("UPDATE edge SET entity = NULL, revision = ? WHERE entity = ?");
    auto row = database_.prepare("DELETE FROM entity WHERE id = ? AND id NOT IN (SELECT entity FROM prediction)");
    auto bet = database_.prepare("UPDATE entity SET confidence = 0, revision = ? WHERE id = ?");
    for (const auto id : entities) {
      edge << revision_ << id;
      edge.run();
      row << id;
      row.run();
      bet << revision_ << id;
      bet.run();
    }
  }

  void write(const std::vector<Prediction>& predictions) {
    auto row = database_.prepare(upsertion("prediction", "id",
                                           "entity, submap, node, " + poseColumns() +
                                               ", probability, expected_area, areas, room, made_ns, state, "
                                               "settled_ns, merged_into, viewpoint_x, viewpoint_y, "
                                               "viewpoint_theta, blocked_ns, revision"));
    for (const auto& prediction : predictions) {
      const auto& viewpoint = prediction.viewpoint_in_submap;
      const auto ofViewpoint = [&](double geometry::Pose2::*coordinate) {
        return viewpoint ? std::optional(*viewpoint.*coordinate) : std::nullopt;
      };
      row << prediction.id << prediction.cause << prediction.submap << prediction.node << prediction.T_submap_node
          << prediction.probability << prediction.expectedArea << toJson(prediction.areas)
          << toJson(prediction.room_in_node) << prediction.made << toString(prediction.state) << prediction.settled
          << prediction.mergedInto << ofViewpoint(&geometry::Pose2::x) << ofViewpoint(&geometry::Pose2::y)
          << ofViewpoint(&geometry::Pose2::theta) << prediction.blocked << revision_;
      row.run();
    }
  }

  /// Within their sub-maps, so that they need not be written again when these move.
  void write(const std::vector<TrajectoryPoint>& points) {
    auto row = database_.prepare(insertion("trajectory_point", "session, time_ns, node, " + poseColumns()));
    base::SubMapId submap{-1};
    geometry::Pose3 T_submap_travel;
    for (const auto& point : points) {
      if (point.submap != submap) {
        submap = point.submap;
        T_submap_travel = travelPose(submap).inverse();
      }
      row << point.session << point.time << point.submap << T_submap_travel * point.T_travel_body;
      row.run();
    }
  }

  void write(const std::vector<Event>& events) {
    auto row = database_.prepare(insertion("event", "time_ns, session, kind, subject, payload, revision"));
    for (const auto& event : events) {
      row << event.time << event.session << event.kind << event.subject << event.payload << revision_;
      row.run();
    }
  }

  void write(const std::vector<Track>& tracks) {
    auto row = database_.prepare(upsertion("track", "id", "session, class, attributes, entity, revision"));
    auto state = database_.prepare(
        upsertion("track_state", "track, time_ns", "node, " + poseColumns() + ", vx, vy, vz, attributes, revision"));
    for (const auto& track : tracks) {
      row << track.id << track.session << track.className << track.attributes << track.entity << revision_;
      row.run();
      for (const auto& s : track.states) {
        const auto speed = [&](int axis) {
          return s.velocity_in_submap ? std::optional((*s.velocity_in_submap)[axis]) : std::nullopt;
        };
        state << track.id << s.time << s.submap << s.T_submap_thing << speed(0) << speed(1) << speed(2) << s.attributes
              << revision_;
        state.run();
      }
    }
  }

  void write(const std::vector<std::pair<base::SubMapId, const MapLayer*>>& layers) {
    auto row = database_.prepare(upsertion("layer", "node, type", "version, codec, raw_size, crc32, data, revision"));
    for (const auto& [submap, layer] : layers) {
      base::ByteWriter raw;
      layer->save(raw);
      const auto packed = compress(raw.bytes());
      row << submap << layer->typeId() << layer->version() << "zlib" << static_cast<std::int64_t>(raw.bytes().size())
          << checksum(packed) << std::span(packed) << revision_;
      row.run();
    }
  }

  void write(const Checkpoint& checkpoint) {
    auto row = database_.prepare(upsertion("checkpoint", "session", "crc32, state, revision"));
    row << checkpoint.session << checksum(checkpoint.state) << std::span(checkpoint.state) << revision_;
    row.run();
  }

  /// Which place a node belongs to depends on all edges.
  void updatePlaces() {
    const auto graph = readGraph(database_);
    auto row = database_.prepare("UPDATE node SET place = ?, revision = ? WHERE id = ?");
    for (const auto& place : graph.places()) {
      for (const auto id : place.submaps) {
        if (graph.getNode(id).place == place.number) continue;
        row << place.number << revision_ << id;
        row.run();
      }
    }
  }

 private:
  geometry::Pose3 travelPose(base::SubMapId submap) const {
    auto row = database_.prepare("SELECT " + poseColumns("travel_") + " FROM node WHERE id = ?");
    row << submap;
    if (!row.step()) throw base::Error("expected sub-map " + toString(submap) + " before its trajectory");
    return getPose(row, 0);
  }

  const Database& database_;
  std::int64_t revision_;
};

}  // namespace

MapStore::MapStore(std::shared_ptr<Database> database) : database_(std::move(database)) {
  database_->execute("PRAGMA foreign_keys = ON");
}
MapStore::MapStore(MapStore&&) noexcept = default;
MapStore& MapStore::operator=(MapStore&&) noexcept = default;
MapStore::~MapStore() = default;

MapStore MapStore::create(const std::filesystem::path& path) {
  if (std::filesystem::exists(path)) throw base::FileError(path.string() + ": is there already");
  // Made beside it: whenever this process is killed, a map that is there can be opened.
  const std::string unfinished = path.string() + ".part";
  const auto clear = [&] {
    std::error_code none;
    for (const char* part : {"", "-journal"}) std::filesystem::remove(unfinished + part, none);
  };
  clear();
  try {
    createSchema(Database(unfinished, Database::Access::kCreate));
    std::filesystem::rename(unfinished, path);
  } catch (const std::filesystem::filesystem_error& fault) {
    clear();
    throw base::FileError(path.string() + ": cannot be written (" + fault.code().message() + ")");
  } catch (...) {
    clear();
    throw;
  }
  return openForWriting(path);
}

MapStore MapStore::openForWriting(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path))
    throw base::FileError(base::expectedFound(path.string(), "a map", "no such file"));
  auto database = std::make_shared<Database>(path, Database::Access::kWrite);
  checkSchema(*database);
  database->execute("PRAGMA journal_mode = WAL");
  database->execute("PRAGMA synchronous = NORMAL");
  upgradeSchema(*database);
  return MapStore(std::move(database));
}

MapStore MapStore::inMemory() {
  auto database = std::make_shared<Database>("", Database::Access::kCreate);
  createSchema(*database);
  return MapStore(std::move(database));
}

std::int64_t MapStore::commit(const MapChange& change) {
  Database::Transaction transaction(*database_);
  const std::int64_t revision = 1 + database_->number("SELECT max(id) FROM revision");
  {
    auto row = database_->prepare("INSERT INTO revision (id, session, time_ns) VALUES (?,?,?)");
    std::optional<base::SessionId> session;
    base::Time time{};
    if (!change.events.empty()) {
      session = change.events.back().session;
      time = change.events.back().time;
    }
    row << revision << session << time;
    row.run();
  }
  ChangeWriter writer(*database_, revision);
  writer.write(change.sessions);
  writer.write(change.floors);
  writer.write(change.nodes);
  writer.write(change.entities);
  writer.write(change.edges);
  writer.remove(change.removedEdges);
  writer.remove(change.removedNodes);
  writer.write(change.predictions);
  writer.remove(change.removedEntities);
  writer.write(change.trajectory);
  writer.write(change.events);
  writer.write(change.tracks);
  writer.write(change.layers);
  if (change.checkpoint) writer.write(*change.checkpoint);
  if (!change.nodes.empty() || !change.edges.empty() || !change.removedEdges.empty() || !change.removedNodes.empty()) {
    writer.updatePlaces();
  }
  transaction.commit();
  return revision;
}

std::optional<Checkpoint> MapStore::findCheckpoint(base::SessionId session) const {
  auto row = database_->prepare("SELECT crc32, state FROM checkpoint WHERE session = ?");
  row << session;
  if (!row.step()) return std::nullopt;
  Checkpoint checkpoint{session, row.get<std::vector<std::byte>>(1)};
  if (checksum(checkpoint.state) != row.get<std::int64_t>(0)) {
    throw base::FileError(database_->path() + ": the checkpoint of session " + toString(session) +
                          " is damaged (its checksum differs)");
  }
  return checkpoint;
}

std::unique_ptr<MapLayer> MapStore::findLayer(base::SubMapId submap, std::string_view typeId) const {
  return readLayer(*database_, submap, typeId);
}

MapView MapStore::view(std::shared_ptr<const SubMap> running, const std::optional<Edge>& edgeTo) const {
  MapView view(database_);
  if (!running) return view;
  view.graph_.addNode(running->node);
  if (edgeTo) view.graph_.addEdge(*edgeTo);
  for (const auto& place : view.graph_.places()) {
    for (const auto id : place.submaps) view.graph_.getNode(id).place = place.number;
  }
  for (const auto& entity : running->entities) {
    const auto stored = std::ranges::find(view.entities_, entity.id, &Entity::id);
    if (stored != view.entities_.end()) {
      *stored = entity;
    } else {
      view.entities_.push_back(entity);
    }
  }
  view.running_ = std::move(running);
  return view;
}

void MapStore::close() {
  database_->execute("PRAGMA wal_checkpoint(TRUNCATE)");
  // A finished map is one file, which also opens where nothing can be written beside it. Readers may keep it in WAL
  // mode.
  database_->tryToExecute("PRAGMA journal_mode = DELETE");
  database_.reset();
}

}  // namespace prodomos::map

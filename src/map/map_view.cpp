// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/map_view.hpp"

#include "prodomos/map/config.hpp"

#include "map/database.hpp"
#include "map/names.hpp"
#include "map/rows.hpp"
#include "map/schema.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace prodomos::map {

namespace {

std::vector<Session> readSessions(const Database& database) {
  std::vector<Session> sessions;
  auto row = database.prepare(
      "SELECT id, log, log_kind, config, poses, version, classes, state, begin_ns, end_ns, distance, "
      "x, y, z, qx, qy, qz, qw FROM session ORDER BY id");
  while (row.step()) {
    Session session;
    session.id = getId<base::SessionId>(row, 0);
    session.log = row.get<std::string>(1);
    session.logKind = row.get<std::string>(2);
    session.config = row.get<std::string>(3);
    session.poses = row.get<std::string>(4);
    session.version = row.get<std::string>(5);
    session.classes = classTableFrom(row.get<std::string>(6));
    session.state = fromName(row.get<std::string>(7), SessionState::kComplete);
    session.begin = getTime(row, 8);
    session.end = getTime(row, 9);
    session.distance = row.get<double>(10);
    session.T_map_travel = getPose(row, 11);
    sessions.push_back(std::move(session));
  }
  return sessions;
}

std::vector<Entity> readEntities(const Database& database) {
  std::vector<Entity> entities;
  auto row = database.prepare(
      "SELECT id, node, class, x, y, z, qx, qy, qz, qw, attributes, confidence, observations, first_seen_ns, "
      "last_seen_ns, covariance, points FROM entity ORDER BY id");
  while (row.step()) {
    Entity entity;
    entity.id = getId<base::EntityId>(row, 0);
    entity.submap = getId<base::SubMapId>(row, 1);
    entity.T_submap_entity = getPose(row, 3);
    entity.attributes = entityAttributesFromJson(row.get<std::string>(2), row.get<std::string>(10));
    entity.confidence = row.find<double>(11).value_or(std::numeric_limits<double>::quiet_NaN());
    entity.observations = row.get<int>(12);
    entity.firstSeen = getTime(row, 13);
    entity.lastSeen = getTime(row, 14);
    entity.covariance = symmetricFrom(row.get<std::string>(15));
    const auto bytes = row.get<std::vector<std::byte>>(16);
    entity.points_in_submap.resize(bytes.size() / sizeof(Eigen::Vector3f));
    if (!bytes.empty()) std::memcpy(entity.points_in_submap.data()->data(), bytes.data(), bytes.size());
    entities.push_back(std::move(entity));
  }
  return entities;
}

std::vector<Prediction> readPredictions(const Database& database) {
  std::vector<Prediction> predictions;
  if (!hasPredictions(database)) return predictions;
  auto row = database.prepare(
      "SELECT id, entity, submap, node, probability, expected_area, areas, room, made_ns, state, "
      "settled_ns, merged_into, viewpoint_x, viewpoint_y, viewpoint_theta, blocked_ns, " +
      poseColumns() + " FROM prediction ORDER BY id");
  while (row.step()) {
    Prediction prediction;
    prediction.id = getId<base::PredictionId>(row, 0);
    prediction.cause = getId<base::EntityId>(row, 1);
    prediction.submap = getId<base::SubMapId>(row, 2);
    prediction.node = getId<base::SubMapId>(row, 3);
    prediction.probability = row.get<double>(4);
    prediction.expectedArea = row.get<double>(5);
    prediction.areas = predictedAreasFrom(row.get<std::string>(6));
    prediction.room_in_node = outlineFrom(row.get<std::string>(7));
    prediction.made = getTime(row, 8);
    prediction.state = fromName(row.get<std::string>(9), PredictionState::kMerged);
    if (row.find<std::int64_t>(10)) prediction.settled = getTime(row, 10);
    prediction.mergedInto = findId<base::SubMapId>(row, 11);
    if (row.find<double>(12)) {
      prediction.viewpoint_in_submap = {row.get<double>(12), row.get<double>(13), row.get<double>(14)};
    }
    if (row.find<std::int64_t>(15)) prediction.blocked = getTime(row, 15);
    prediction.T_submap_node = getPose(row, 16);
    predictions.push_back(std::move(prediction));
  }
  return predictions;
}

std::vector<Event> readEvents(const Database& database, std::int64_t afterRevision) {
  std::vector<Event> events;
  auto row =
      database.prepare("SELECT time_ns, session, kind, subject, payload FROM event WHERE revision > ? ORDER BY id");
  row << afterRevision;
  while (row.step()) {
    events.push_back({getTime(row, 0), getId<base::SessionId>(row, 1), row.get<std::string>(2), row.get<std::string>(3),
                      row.get<std::string>(4)});
  }
  return events;
}

template <typename IdType>
std::vector<IdType> readIdsAfter(const Database& database, const std::string& table, std::int64_t revision) {
  std::vector<IdType> ids;
  auto row = database.prepare("SELECT id FROM " + table + " WHERE revision > ? ORDER BY id");
  row << revision;
  while (row.step()) ids.push_back(getId<IdType>(row, 0));
  return ids;
}

}  // namespace

MapView::MapView(std::shared_ptr<Database> database) : database_(std::move(database)) {
  load();
}

MapView MapView::open(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path))
    throw base::FileError(base::expectedFound(path.string(), "a map", "no such file"));
  if (std::filesystem::is_directory(path)) {
    throw base::FileError(base::expectedFound(path.string(), "a map file", "a folder"));
  }
  auto database = std::make_shared<Database>(path, Database::Access::kRead);
  checkSchema(*database);
  return MapView(std::move(database));
}

void MapView::load() {
  const Database::Snapshot snapshot(*database_);
  try {
    revision_ = database_->number("SELECT max(id) FROM revision");
    sessions_ = readSessions(*database_);
    auto row = database_->prepare("SELECT number, height FROM floor ORDER BY number");
    while (row.step()) floors_.push_back({row.get<int>(0), row.get<double>(1)});
    graph_ = readGraph(*database_);
    entities_ = readEntities(*database_);
    predictions_ = readPredictions(*database_);
  } catch (const base::FileError&) {
    throw;
  } catch (const std::exception& fault) {  // a value that no prodomos writes
    throw base::FileError(database_->path() + ": the map file is damaged (" + fault.what() + ")");
  }
}

std::vector<Entity> MapView::entitiesOf(base::SubMapId submap) const {
  std::vector<Entity> found;
  std::ranges::copy_if(entities_, std::back_inserter(found),
                       [&](const Entity& entity) { return entity.submap == submap; });
  return found;
}

std::vector<std::string> MapView::layersOf(base::SubMapId submap) const {
  std::vector<std::string> types;
  if (running_ && running_->node.id == submap) {
    for (const auto& layer : running_->layers) types.emplace_back(layer->typeId());
    return types;
  }
  auto row = database_->prepare("SELECT type FROM layer WHERE node = ? ORDER BY type");
  row << submap;
  while (row.step()) types.push_back(row.get<std::string>(0));
  const auto order = layerTypes();
  std::ranges::stable_sort(types, {},
                           [&](const std::string& type) { return std::ranges::find(order, type) - order.begin(); });
  return types;
}

std::shared_ptr<const MapLayer> MapView::findLayer(base::SubMapId submap, std::string_view typeId) const {
  if (running_ && running_->node.id == submap) {
    const auto* layer = running_->findLayer(typeId);
    return layer == nullptr ? nullptr : std::shared_ptr<const MapLayer>(running_, layer);
  }
  return readLayer(*database_, submap, typeId);
}

std::vector<TrajectoryPoint> MapView::trajectory() const {
  std::vector<TrajectoryPoint> points;
  visitTrajectory([&](const TrajectoryPoint& point) { points.push_back(point); });
  return points;
}

void MapView::visitTrajectory(const std::function<void(const TrajectoryPoint&)>& visit) const {
  auto row = database_->prepare(
      "SELECT session, time_ns, node, travel_x, travel_y, travel_z, travel_qx, travel_qy, travel_qz, travel_qw, "
      "x, y, z, qx, qy, qz, qw FROM trajectory ORDER BY session, id");
  while (row.step()) {
    visit({getId<base::SessionId>(row, 0), getTime(row, 1), getId<base::SubMapId>(row, 2), getPose(row, 3),
           getPose(row, 10)});
  }
}

std::vector<Event> MapView::events() const {
  return readEvents(*database_, 0);
}

std::vector<Track> MapView::tracks() const {
  const Database::Snapshot snapshot(*database_);
  std::vector<Track> tracks;
  auto row =
      database_->prepare("SELECT id, session, class, attributes, " +
                         std::string(tracksHaveEntities(*database_) ? "entity" : "NULL") + " FROM track ORDER BY id");
  while (row.step()) {
    Track track{getId<base::TrackId>(row, 0),
                getId<base::SessionId>(row, 1),
                row.get<std::string>(2),
                row.get<std::string>(3),
                {},
                findId<base::EntityId>(row, 4)};
    auto state = database_->prepare(
        "SELECT time_ns, node, x, y, z, qx, qy, qz, qw, vx, vy, vz, attributes FROM track_state WHERE track = ? "
        "ORDER BY time_ns");
    state << track.id;
    while (state.step()) {
      TrackState s{getTime(state, 0), getId<base::SubMapId>(state, 1), getPose(state, 2), std::nullopt,
                   state.get<std::string>(12)};
      if (state.find<double>(9)) {
        s.velocity_in_submap = {state.get<double>(9), state.get<double>(10), state.get<double>(11)};
      }
      track.states.push_back(std::move(s));
    }
    tracks.push_back(std::move(track));
  }
  return tracks;
}

MapChanges MapView::changesSince(std::int64_t revision) const {
  const Database::Snapshot snapshot(*database_);
  MapChanges changes;
  changes.revision = database_->number("SELECT max(id) FROM revision");
  changes.nodes = readIdsAfter<base::SubMapId>(*database_, "node", revision);
  changes.edges = readIdsAfter<base::EdgeId>(*database_, "edge", revision);
  changes.entities = readIdsAfter<base::EntityId>(*database_, "entity", revision);
  changes.predictions = readIdsAfter<base::PredictionId>(*database_, "prediction", revision);
  changes.events = readEvents(*database_, revision);
  return changes;
}

}  // namespace prodomos::map

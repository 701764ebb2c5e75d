// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "map/schema.hpp"

namespace prodomos::map {

namespace {

// Described column by column in docs/map-file.md. Every row that can change carries the revision that wrote it last.
// Poses: metres and a unit quaternion, T_map_submap (refined) without prefix, as travelled with the prefix travel_.
constexpr const char* kTables = R"sql(
CREATE TABLE revision (
  id INTEGER PRIMARY KEY, session INTEGER, time_ns INTEGER NOT NULL,
  committed_at TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')));

CREATE TABLE session (
  id INTEGER PRIMARY KEY, log TEXT NOT NULL, log_kind TEXT NOT NULL, config TEXT NOT NULL, poses TEXT NOT NULL,
  version TEXT NOT NULL, classes TEXT NOT NULL, state TEXT NOT NULL, begin_ns INTEGER NOT NULL, end_ns INTEGER NOT NULL,
  distance REAL NOT NULL,
  x REAL NOT NULL, y REAL NOT NULL, z REAL NOT NULL, qx REAL NOT NULL, qy REAL NOT NULL, qz REAL NOT NULL, qw REAL NOT NULL,
  revision INTEGER NOT NULL);

CREATE TABLE floor (number INTEGER PRIMARY KEY, height REAL NOT NULL, revision INTEGER NOT NULL);

CREATE TABLE node (
  id INTEGER PRIMARY KEY, session INTEGER NOT NULL REFERENCES session, kind TEXT NOT NULL,
  floor INTEGER REFERENCES floor, place INTEGER,
  begin_ns INTEGER NOT NULL, end_ns INTEGER NOT NULL, distance REAL NOT NULL, readings INTEGER NOT NULL,
  x REAL NOT NULL, y REAL NOT NULL, z REAL NOT NULL, qx REAL NOT NULL, qy REAL NOT NULL, qz REAL NOT NULL, qw REAL NOT NULL,
  travel_x REAL NOT NULL, travel_y REAL NOT NULL, travel_z REAL NOT NULL,
  travel_qx REAL NOT NULL, travel_qy REAL NOT NULL, travel_qz REAL NOT NULL, travel_qw REAL NOT NULL,
  revision INTEGER NOT NULL);

CREATE TABLE entity (
  id INTEGER PRIMARY KEY, node INTEGER NOT NULL REFERENCES node, class TEXT NOT NULL, mobility TEXT NOT NULL,
  x REAL NOT NULL, y REAL NOT NULL, z REAL NOT NULL, qx REAL NOT NULL, qy REAL NOT NULL, qz REAL NOT NULL, qw REAL NOT NULL,
  attributes TEXT NOT NULL, confidence REAL, observations INTEGER NOT NULL,
  first_seen_ns INTEGER NOT NULL, last_seen_ns INTEGER NOT NULL, covariance TEXT NOT NULL, points BLOB,
  revision INTEGER NOT NULL);
CREATE INDEX entity_by_node ON entity (node);

CREATE TABLE edge (
  id INTEGER PRIMARY KEY, from_node INTEGER NOT NULL REFERENCES node, to_node INTEGER NOT NULL REFERENCES node,
  kind TEXT NOT NULL,
  x REAL NOT NULL, y REAL NOT NULL, z REAL NOT NULL, qx REAL NOT NULL, qy REAL NOT NULL, qz REAL NOT NULL, qw REAL NOT NULL,
  information TEXT NOT NULL, entity INTEGER REFERENCES entity, revision INTEGER NOT NULL);

CREATE TABLE prediction (
  id INTEGER PRIMARY KEY, entity INTEGER NOT NULL REFERENCES entity, node INTEGER NOT NULL REFERENCES node,
  probability REAL NOT NULL, expected_area REAL NOT NULL, areas TEXT NOT NULL, made_ns INTEGER NOT NULL,
  state TEXT NOT NULL, settled_ns INTEGER, merged_into INTEGER REFERENCES node, score TEXT, revision INTEGER NOT NULL);

CREATE TABLE track (
  id INTEGER PRIMARY KEY, session INTEGER NOT NULL REFERENCES session, class TEXT NOT NULL, attributes TEXT NOT NULL,
  revision INTEGER NOT NULL);
CREATE TABLE track_state (
  track INTEGER NOT NULL REFERENCES track, time_ns INTEGER NOT NULL, node INTEGER NOT NULL REFERENCES node,
  x REAL NOT NULL, y REAL NOT NULL, z REAL NOT NULL, qx REAL NOT NULL, qy REAL NOT NULL, qz REAL NOT NULL, qw REAL NOT NULL,
  vx REAL, vy REAL, vz REAL, attributes TEXT NOT NULL, revision INTEGER NOT NULL,
  PRIMARY KEY (track, time_ns)) WITHOUT ROWID;

CREATE TABLE trajectory (
  id INTEGER PRIMARY KEY, session INTEGER NOT NULL REFERENCES session, time_ns INTEGER NOT NULL,
  node INTEGER NOT NULL REFERENCES node,
  x REAL NOT NULL, y REAL NOT NULL, z REAL NOT NULL, qx REAL NOT NULL, qy REAL NOT NULL, qz REAL NOT NULL, qw REAL NOT NULL,
  travel_x REAL NOT NULL, travel_y REAL NOT NULL, travel_z REAL NOT NULL,
  travel_qx REAL NOT NULL, travel_qy REAL NOT NULL, travel_qz REAL NOT NULL, travel_qw REAL NOT NULL);
CREATE INDEX trajectory_by_node ON trajectory (node);

CREATE TABLE event (
  id INTEGER PRIMARY KEY, time_ns INTEGER NOT NULL, session INTEGER NOT NULL REFERENCES session, kind TEXT NOT NULL,
  subject TEXT NOT NULL, payload TEXT NOT NULL, revision INTEGER NOT NULL);

CREATE TABLE layer (
  node INTEGER NOT NULL REFERENCES node, type TEXT NOT NULL, version INTEGER NOT NULL, codec TEXT NOT NULL,
  raw_size INTEGER NOT NULL, crc32 INTEGER NOT NULL, data BLOB NOT NULL, revision INTEGER NOT NULL,
  PRIMARY KEY (node, type));

CREATE TABLE checkpoint (
  session INTEGER PRIMARY KEY REFERENCES session, crc32 INTEGER NOT NULL, state BLOB NOT NULL, revision INTEGER NOT NULL);
)sql";

}  // namespace

void createSchema(const Database& database) {
  database.execute("PRAGMA journal_mode = WAL");
  database.execute("PRAGMA synchronous = NORMAL");
  Database::Transaction transaction(database);
  database.execute("PRAGMA application_id = " + std::to_string(kApplicationId));
  database.execute("PRAGMA user_version = " + std::to_string(kSchemaVersion));
  database.execute(kTables);
  transaction.commit();
}

void checkSchema(const Database& database) {
  const auto application = database.number("PRAGMA application_id");
  if (application != kApplicationId) {
    throw base::FileError(base::expectedFound(database.path(), "a prodomos map", "another kind of SQLite file"));
  }
  const auto version = database.number("PRAGMA user_version");
  if (version > kSchemaVersion) {
    throw base::FileError(base::expectedFound(database.path(),
                                              "a map of schema version " + std::to_string(kSchemaVersion) + " or older",
                                              "version " + std::to_string(version) + "; a newer prodomos wrote it"));
  }
}

}  // namespace prodomos::map

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "map/schema.hpp"

#include "map/rows.hpp"

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
  covariance TEXT, revision INTEGER NOT NULL);

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

CREATE TABLE track (
  id INTEGER PRIMARY KEY, session INTEGER NOT NULL REFERENCES session, class TEXT NOT NULL, attributes TEXT NOT NULL,
  revision INTEGER NOT NULL, entity INTEGER REFERENCES entity);
CREATE TABLE track_state (
  track INTEGER NOT NULL REFERENCES track, time_ns INTEGER NOT NULL, node INTEGER NOT NULL REFERENCES node,
  x REAL NOT NULL, y REAL NOT NULL, z REAL NOT NULL, qx REAL NOT NULL, qy REAL NOT NULL, qz REAL NOT NULL, qw REAL NOT NULL,
  vx REAL, vy REAL, vz REAL, attributes TEXT NOT NULL, revision INTEGER NOT NULL,
  PRIMARY KEY (track, time_ns)) WITHOUT ROWID;

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

// The node of a prediction that was settled is in the graph no more.
constexpr const char* kPredictionTable = R"sql(
CREATE TABLE prediction (
  id INTEGER PRIMARY KEY, entity INTEGER NOT NULL REFERENCES entity, submap INTEGER NOT NULL REFERENCES node,
  node INTEGER NOT NULL,
  x REAL NOT NULL, y REAL NOT NULL, z REAL NOT NULL, qx REAL NOT NULL, qy REAL NOT NULL, qz REAL NOT NULL, qw REAL NOT NULL,
  probability REAL NOT NULL, expected_area REAL NOT NULL, areas TEXT NOT NULL, room TEXT NOT NULL,
  viewpoint_x REAL, viewpoint_y REAL, viewpoint_theta REAL, made_ns INTEGER NOT NULL, state TEXT NOT NULL,
  settled_ns INTEGER, blocked_ns INTEGER, merged_into INTEGER REFERENCES node, revision INTEGER NOT NULL);
)sql";

// Where the robot was within its sub-map, which never moves internally: refinement moves the sub-maps alone.
constexpr const char* kTrajectoryTable = R"sql(
CREATE TABLE trajectory_point (
  id INTEGER PRIMARY KEY, session INTEGER NOT NULL REFERENCES session, time_ns INTEGER NOT NULL,
  node INTEGER NOT NULL REFERENCES node,
  x REAL NOT NULL, y REAL NOT NULL, z REAL NOT NULL, qx REAL NOT NULL, qy REAL NOT NULL, qz REAL NOT NULL, qw REAL NOT NULL);
)sql";

// T_map_submap * T_submap_body of the node n and the point p, or with the prefix "travel_" for $ the same as travelled.
constexpr const char* kComposedPose = R"sql(,
  n.$x + (1 - 2*(n.$qy*n.$qy + n.$qz*n.$qz))*p.x + 2*(n.$qx*n.$qy - n.$qz*n.$qw)*p.y + 2*(n.$qx*n.$qz + n.$qy*n.$qw)*p.z AS $x,
  n.$y + 2*(n.$qx*n.$qy + n.$qz*n.$qw)*p.x + (1 - 2*(n.$qx*n.$qx + n.$qz*n.$qz))*p.y + 2*(n.$qy*n.$qz - n.$qx*n.$qw)*p.z AS $y,
  n.$z + 2*(n.$qx*n.$qz - n.$qy*n.$qw)*p.x + 2*(n.$qy*n.$qz + n.$qx*n.$qw)*p.y + (1 - 2*(n.$qx*n.$qx + n.$qy*n.$qy))*p.z AS $z,
  n.$qw*p.qx + n.$qx*p.qw + n.$qy*p.qz - n.$qz*p.qy AS $qx,
  n.$qw*p.qy - n.$qx*p.qz + n.$qy*p.qw + n.$qz*p.qx AS $qy,
  n.$qw*p.qz + n.$qx*p.qy - n.$qy*p.qx + n.$qz*p.qw AS $qz,
  n.$qw*p.qw - n.$qx*p.qx - n.$qy*p.qy - n.$qz*p.qz AS $qw)sql";

// The same rotation with qw >= 0.
constexpr const char* kPositivePose = R"sql(, $x, $y, $z,
  CASE WHEN $qw < 0 THEN -$qx ELSE $qx END AS $qx, CASE WHEN $qw < 0 THEN -$qy ELSE $qy END AS $qy,
  CASE WHEN $qw < 0 THEN -$qz ELSE $qz END AS $qz, abs($qw) AS $qw)sql";

std::string withPrefix(std::string sql, const std::string& prefix) {
  for (auto at = sql.find('$'); at != std::string::npos; at = sql.find('$', at)) sql.replace(at, 1, prefix);
  return sql;
}

/// The trajectory in the map and as travelled, for readers in all languages.
std::string trajectoryView() {
  return "CREATE VIEW trajectory AS SELECT id, session, time_ns, node" + withPrefix(kPositivePose, "") +
         withPrefix(kPositivePose, "travel_") + "\nFROM (SELECT p.id, p.session, p.time_ns, p.node" +
         withPrefix(kComposedPose, "") + withPrefix(kComposedPose, "travel_") +
         "\n  FROM trajectory_point AS p JOIN node AS n ON n.id = p.node)";
}

std::int64_t versionOf(const Database& database) {
  return database.number("PRAGMA user_version");
}

/// Of the first version, which kept both poses of each point, and rewrote them whenever their sub-map moved.
void moveTrajectoryIntoSubMaps(const Database& database) {
  database.execute("ALTER TABLE trajectory RENAME TO trajectory_1");
  database.execute(kTrajectoryTable);
  auto old = database.prepare("SELECT t.id, t.session, t.time_ns, t.node, " + poseColumns("t.travel_") + ", " +
                              poseColumns("n.travel_") + " FROM trajectory_1 AS t JOIN node AS n ON n.id = t.node");
  auto row = database.prepare(insertion("trajectory_point", "id, session, time_ns, node, " + poseColumns()));
  while (old.step()) {
    for (int column = 0; column < 4; ++column) row << old.get<std::int64_t>(column);
    row << getPose(old, 11).inverse() * getPose(old, 4);
    row.run();
  }
}

}  // namespace

void createSchema(const Database& database) {
  Database::Transaction transaction(database);
  database.execute("PRAGMA application_id = " + std::to_string(kApplicationId));
  database.execute("PRAGMA user_version = " + std::to_string(kSchemaVersion));
  database.execute(kTables);
  database.execute(kPredictionTable);
  database.execute(kTrajectoryTable);
  database.execute(trajectoryView());
  transaction.commit();
}

void upgradeSchema(const Database& database) {
  if (versionOf(database) == kSchemaVersion) return;
  Database::Transaction transaction(database);
  if (versionOf(database) < 2) {
    database.execute("ALTER TABLE node ADD COLUMN covariance TEXT");
    moveTrajectoryIntoSubMaps(database);
    database.execute("DROP TABLE trajectory_1");
    database.execute(trajectoryView());
  }
  database.execute("DROP TABLE prediction");  // nobody wrote any before version 3
  database.execute(kPredictionTable);
  database.execute("ALTER TABLE track ADD COLUMN entity INTEGER REFERENCES entity");
  database.execute("PRAGMA user_version = " + std::to_string(kSchemaVersion));
  transaction.commit();
}

bool hasCovariances(const Database& database) {
  return versionOf(database) >= 2;
}

bool hasPredictions(const Database& database) {
  return versionOf(database) >= 3;
}

bool tracksHaveEntities(const Database& database) {
  return versionOf(database) >= 3;
}

void checkSchema(const Database& database) {
  const auto application = database.number("PRAGMA application_id");
  if (application != kApplicationId) {
    throw base::FileError(base::expectedFound(database.path(), "a prodomos map", "another kind of SQLite file"));
  }
  const auto version = versionOf(database);
  if (version > kSchemaVersion) {
    throw base::FileError(base::expectedFound(database.path(),
                                              "a map of schema version " + std::to_string(kSchemaVersion) + " or older",
                                              "version " + std::to_string(version) + "; a newer prodomos wrote it"));
  }
}

}  // namespace prodomos::map

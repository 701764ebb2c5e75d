// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "map/rows.hpp"

#include "prodomos/map/config.hpp"

#include "map/blob.hpp"
#include "map/names.hpp"
#include "map/schema.hpp"

#include <nlohmann/json.hpp>

#include <limits>

namespace prodomos::map {

using nlohmann::json;

namespace {

/// JSON has no NaN: written as null, read back here.
double real(const json& number) {
  return number.is_null() ? std::numeric_limits<double>::quiet_NaN() : number.get<double>();
}

/// The parts of "a, b, c".
std::vector<std::string> namesIn(const std::string& columns) {
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin < columns.size();) {
    const auto end = std::min(columns.find(", ", begin), columns.size());
    names.push_back(columns.substr(begin, end - begin));
    begin = end + 2;
  }
  return names;
}

/// Names come from logs, and may hold bytes that are no UTF-8.
std::string dump(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

json jsonOf(const std::vector<Eigen::Vector2d>& outline) {
  json corners = json::array();
  for (const auto& corner : outline) corners.push_back({corner.x(), corner.y()});
  return corners;
}

std::vector<Eigen::Vector2d> outlineFrom(const json& corners) {
  std::vector<Eigen::Vector2d> outline;
  for (const auto& corner : corners) outline.emplace_back(real(corner.at(0)), real(corner.at(1)));
  return outline;
}

}  // namespace

std::string poseColumns(const std::string& prefix) {
  std::string columns;
  for (const char* name : {"x", "y", "z", "qx", "qy", "qz", "qw"}) {
    columns += (columns.empty() ? "" : ", ") + prefix + name;
  }
  return columns;
}

std::string insertion(const std::string& table, const std::string& columns) {
  std::string marks = "?";
  for (std::size_t i = 1; i < namesIn(columns).size(); ++i) marks += ",?";
  return "INSERT INTO " + table + " (" + columns + ") VALUES (" + marks + ")";
}

std::string upsertion(const std::string& table, const std::string& key, const std::string& others) {
  std::string changes;
  for (const auto& name : namesIn(others)) changes += (changes.empty() ? "" : ", ") + name + " = excluded." + name;
  return insertion(table, key + ", " + others) + " ON CONFLICT (" + key + ") DO UPDATE SET " + changes;
}

Statement& operator<<(Statement& statement, const geometry::Pose3& pose) {
  const auto& t = pose.translation();
  Eigen::Quaterniond q(pose.linear());
  q.normalize();
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  return statement << t.x() << t.y() << t.z() << q.x() << q.y() << q.z() << q.w();
}

geometry::Pose3 getPose(const Statement& row, int firstColumn) {
  const auto at = [&](int offset) { return row.get<double>(firstColumn + offset); };
  return geometry::fromQuaternion({at(0), at(1), at(2)}, Eigen::Quaterniond(at(6), at(3), at(4), at(5)));
}

std::string upperTriangle(const Matrix6& matrix) {
  json numbers = json::array();
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) numbers.push_back(matrix(row, column));
  }
  return dump(numbers);
}

Matrix6 symmetricFrom(const std::string& upperTriangle) {
  const auto numbers = json::parse(upperTriangle);
  Matrix6 matrix;
  std::size_t at = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      matrix(row, column) = matrix(column, row) = real(numbers.at(at++));
    }
  }
  return matrix;
}

std::string toJson(const sensors::ClassTable& classes) {
  json table = json::object();
  for (const auto& [id, name] : classes) table[std::to_string(id)] = name;
  return dump(table);
}

sensors::ClassTable classTableFrom(const std::string& json) {
  sensors::ClassTable classes;
  const auto table = nlohmann::json::parse(json);
  for (const auto& [id, name] : table.items()) classes[std::stoi(id)] = name;
  return classes;
}

std::string toJson(const std::vector<Eigen::Vector2d>& outline) {
  return dump(jsonOf(outline));
}

std::vector<Eigen::Vector2d> outlineFrom(const std::string& text) {
  return outlineFrom(json::parse(text));
}

std::string toJson(const std::vector<PredictedArea>& areas) {
  json list = json::array();
  for (const auto& area : areas) {
    list.push_back({{"threshold", area.threshold}, {"outline", jsonOf(area.outline_in_node)}});
  }
  return dump(list);
}

std::vector<PredictedArea> predictedAreasFrom(const std::string& text) {
  std::vector<PredictedArea> areas;
  for (const auto& entry : json::parse(text)) {
    areas.push_back({real(entry.at("threshold")), outlineFrom(entry.at("outline"))});
  }
  return areas;
}

std::unique_ptr<MapLayer> readLayer(const Database& database, base::SubMapId submap, std::string_view typeId) {
  auto row = database.prepare("SELECT version, raw_size, crc32, data FROM layer WHERE node = ? AND type = ?");
  row << submap << typeId;
  if (!row.step()) return nullptr;
  auto layer = makeLayer(typeId, {});
  if (layer == nullptr) return nullptr;

  const auto place = database.path() + ": layer " + std::string(typeId) + " of sub-map " + toString(submap);
  const auto packed = row.get<std::vector<std::byte>>(3);
  const int version = row.get<int>(0);
  if (checksum(packed) != row.get<std::int64_t>(2)) throw base::FileError(place + " is damaged (its checksum differs)");
  if (version > layer->version()) {
    throw base::FileError(base::expectedFound(place, "version " + std::to_string(layer->version()) + " or older",
                                              "version " + std::to_string(version) + "; a newer prodomos wrote it"));
  }
  try {
    const auto raw = decompress(packed, static_cast<std::size_t>(row.get<std::int64_t>(1)));
    base::ByteReader reader(raw);
    layer->load(reader, version);
  } catch (const base::Error& fault) {
    throw base::FileError(place + ": " + fault.what());
  }
  return layer;
}

TopologicalGraph readGraph(const Database& database) {
  TopologicalGraph graph;
  auto row = database.prepare("SELECT id, session, kind, floor, place, begin_ns, end_ns, distance, readings, " +
                              poseColumns() + ", " + poseColumns("travel_") + ", " +
                              (hasCovariances(database) ? "covariance" : "NULL") + " FROM node ORDER BY id");
  while (row.step()) {
    Node node;
    node.id = getId<base::SubMapId>(row, 0);
    node.session = getId<base::SessionId>(row, 1);
    node.kind = fromName(row.get<std::string>(2), SubMapKind::kPredicted);
    node.floor = row.find<int>(3);
    node.place = row.find<int>(4);
    node.begin = getTime(row, 5);
    node.end = getTime(row, 6);
    node.distance = row.get<double>(7);
    node.readings = row.get<int>(8);
    node.T_map_submap = getPose(row, 9);
    node.T_travel_submap = getPose(row, 16);
    if (const auto covariance = row.find<std::string>(23)) node.covariance = symmetricFrom(*covariance);
    graph.addNode(node);
  }
  auto link = database.prepare(
      "SELECT id, from_node, to_node, kind, x, y, z, qx, qy, qz, qw, information, entity FROM edge ORDER BY id");
  while (link.step()) {
    Edge edge;
    edge.id = getId<base::EdgeId>(link, 0);
    edge.from = getId<base::SubMapId>(link, 1);
    edge.to = getId<base::SubMapId>(link, 2);
    edge.kind = fromName(link.get<std::string>(3), EdgeKind::kOverlap);
    edge.T_from_to = getPose(link, 4);
    edge.information = symmetricFrom(link.get<std::string>(11));
    edge.cause = findId<base::EntityId>(link, 12);
    graph.addEdge(edge);
  }
  return graph;
}

}  // namespace prodomos::map

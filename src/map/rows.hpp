// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/id.hpp"
#include "prodomos/base/time.hpp"
#include "prodomos/map/entity.hpp"
#include "prodomos/map/layer.hpp"
#include "prodomos/map/prediction.hpp"
#include "prodomos/map/records.hpp"
#include "prodomos/map/topological_graph.hpp"

#include "map/database.hpp"

/// How the values of a map are laid out in the columns of its file: what MapStore writes, MapView reads.
namespace prodomos::map {

template <char Letter>
Statement& operator<<(Statement& statement, base::Id<Letter> id) {
  return statement << id.value;
}
template <char Letter>
Statement& operator<<(Statement& statement, const std::optional<base::Id<Letter>>& id) {
  return statement << (id ? std::optional(id->value) : std::nullopt);
}
inline Statement& operator<<(Statement& statement, base::Time time) {
  return statement << base::toNanoseconds(time);
}
inline Statement& operator<<(Statement& statement, const std::optional<base::Time>& time) {
  return statement << (time ? std::optional(base::toNanoseconds(*time)) : std::nullopt);
}
/// Seven columns: x, y, z, qx, qy, qz, qw with qw >= 0.
Statement& operator<<(Statement& statement, const geometry::Pose3& pose);

template <typename IdType>
IdType getId(const Statement& row, int column) {
  return IdType{row.get<std::int64_t>(column)};
}
template <typename IdType>
std::optional<IdType> findId(const Statement& row, int column) {
  const auto value = row.find<std::int64_t>(column);
  return value ? std::optional(IdType{*value}) : std::nullopt;
}
inline base::Time getTime(const Statement& row, int column) {
  return base::fromNanoseconds(row.get<std::int64_t>(column));
}
geometry::Pose3 getPose(const Statement& row, int firstColumn);
/// The names of a pose's columns, "x, y, z, qx, qy, qz, qw", each with the prefix.
std::string poseColumns(const std::string& prefix = "");

/// SQL that inserts a row of these columns.
std::string insertion(const std::string& table, const std::string& columns);
/// The same; but where a row of this key is there already, its other columns are changed in place. Rows are never
/// replaced, for others refer to them.
std::string upsertion(const std::string& table, const std::string& key, const std::string& others);

/// The upper triangle, row by row, as a JSON array of 21 numbers.
std::string upperTriangle(const Matrix6& matrix);
Matrix6 symmetricFrom(const std::string& upperTriangle);

std::string toJson(const sensors::ClassTable& classes);
sensors::ClassTable classTableFrom(const std::string& json);
std::string toJson(const std::vector<PredictedArea>& areas);
std::string toJson(const std::vector<Eigen::Vector2d>& outline);
std::vector<Eigen::Vector2d> outlineFrom(const std::string& text);
std::vector<PredictedArea> predictedAreasFrom(const std::string& text);

/// Null where the sub-map has no such layer or the type is unknown to this version. Throws base::FileError where its
/// bytes are damaged (checksum) or of a newer version.
std::unique_ptr<MapLayer> readLayer(const Database& database, base::SubMapId submap, std::string_view typeId);

/// All nodes and edges that the file holds.
TopologicalGraph readGraph(const Database& database);

}  // namespace prodomos::map

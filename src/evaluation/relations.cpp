// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/relations.hpp"

#include "prodomos/base/error.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

namespace prodomos::evaluation {

namespace {

std::optional<double> parseFinite(const std::string& field) {
  double number = 0.0;
  const char* end = field.data() + field.size();
  const auto [stop, fault] = std::from_chars(field.data() + (field.starts_with('+') ? 1 : 0), end, number);
  if (fault != std::errc{} || stop != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

std::optional<Relation> parseRelation(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> fields;
  for (std::string field; stream >> field;) fields.push_back(field);
  if (fields.size() != 8) return std::nullopt;
  const auto first = base::parseSeconds(fields[0]);
  const auto second = base::parseSeconds(fields[1]);
  std::array<double, 6> v{};
  for (std::size_t i = 0; i < v.size(); ++i) {
    const auto number = parseFinite(fields[i + 2]);
    if (!number) return std::nullopt;
    v[i] = *number;
  }
  if (!first || !second) return std::nullopt;
  return Relation{*first, *second, geometry::fromYawPitchRoll({v[0], v[1], v[2]}, v[5], v[4], v[3])};
}

template <typename Field>
std::vector<RelationError> worstBy(std::vector<RelationError> errors, std::size_t count, Field field) {
  std::ranges::stable_sort(errors, std::ranges::greater{}, field);
  if (errors.size() > count) errors.resize(count);
  return errors;
}

}  // namespace

std::vector<Relation> readRelations(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path)) {
    throw base::FileError(base::expectedFound(path.string(), "a file of relations", "none that can be read"));
  }
  std::vector<Relation> relations;
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    const auto begin = line.find_first_not_of(" \t\r");
    if (begin == std::string::npos || line[begin] == '#') continue;
    const auto relation = parseRelation(line);
    if (!relation) {
      throw base::FileError(base::expectedFound(path.string() + ":" + std::to_string(number),
                                                "`t1 t2 x y z roll pitch yaw`, finite numbers",
                                                "`" + line.substr(0, 200) + "`"));
    }
    relations.push_back(*relation);
  }
  if (relations.empty()) {
    throw base::FileError(base::expectedFound(path.string(), "lines `t1 t2 x y z roll pitch yaw`", "none"));
  }
  return relations;
}

std::vector<RelationError> relationErrors(const std::vector<TimedPose>& poses, const std::vector<Relation>& relations) {
  std::vector<RelationError> errors;
  for (const auto& relation : relations) {
    const auto* first = findNearest(poses, relation.first, kStampTolerance);
    const auto* second = findNearest(poses, relation.second, kStampTolerance);
    if (first == nullptr || second == nullptr) continue;
    // Kümmerle et al. eq. (3) and (4): (x_j ⊖ x_i) ⊖ δ*_ij
    const geometry::Pose3 T_first_second = first->pose.inverse() * second->pose;
    const geometry::Pose3 error = relation.T_first_second.inverse() * T_first_second;
    errors.push_back({relation.first, relation.second, error.translation().norm(), geometry::rotationAngle(error)});
  }
  return errors;
}

RelationScore scoreOf(const std::vector<RelationError>& errors, std::size_t worst) {
  std::vector<double> translations;
  std::vector<double> rotations;
  for (const auto& error : errors) {
    translations.push_back(error.translation);
    rotations.push_back(error.rotation * 180.0 / std::numbers::pi);
  }
  return {statisticsOf(std::move(translations)), statisticsOf(std::move(rotations)),
          worstBy(errors, worst, &RelationError::translation), worstBy(errors, worst, &RelationError::rotation)};
}

}  // namespace prodomos::evaluation

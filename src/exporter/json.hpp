// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/id.hpp"
#include "prodomos/geometry/pose.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace prodomos::exporter {

using Json = nlohmann::ordered_json;

/// To a billionth, so that the last bits of a computation do not clutter files; null where not finite.
Json number(double value);
Json array(const Eigen::Ref<const Eigen::VectorXd>& values);
/// {"position": [x, y, z], "quaternion": [x, y, z, w], "yaw": radians}.
Json poseJson(const geometry::Pose3& pose);
template <typename T>
Json optionalJson(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}
template <char Letter>
Json optionalJson(const std::optional<base::Id<Letter>>& id) {
  return id ? Json(toString(*id)) : Json(nullptr);
}

/// toJson(thing) of each.
template <typename Things, typename ToJson>
Json listOf(const Things& things, ToJson toJson) {
  Json list = Json::array();
  for (const auto& thing : things) list.push_back(toJson(thing));
  return list;
}

/// One line an element of the outer arrays, so that files can be read, searched and compared line by line.
std::string dumpByLines(const Json& object);

}  // namespace prodomos::exporter

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/query/query.hpp"

#include <nlohmann/json_fwd.hpp>

/// What `prodomos query … --json` writes: docs/query.md names every field.
namespace prodomos::apps {

nlohmann::json toJson(const query::PlaceAnswer& answer);
nlohmann::json toJson(const std::optional<query::Route>& route);
nlohmann::json toJson(const query::FreeFloor& floor);
nlohmann::json toJson(const query::PredictedRoom& room);
nlohmann::json toJson(const map::MapChanges& changes);
nlohmann::json toJson(const query::Seen<map::Door>& door);
nlohmann::json toJson(const query::Seen<map::Staircase>& stairs);
nlohmann::json toJson(const query::Seen<map::Human>& person);

/// "free", "occupied", "unknown".
std::string_view toString(map::CellState state);

}  // namespace prodomos::apps

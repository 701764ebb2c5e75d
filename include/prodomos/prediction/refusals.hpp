// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/map_store.hpp"
#include "prodomos/prediction/world.hpp"

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace prodomos::prediction {

/// Entities that M(S) does not take at their word, each once for each reason. All of a session stand in the map as
/// events "prediction_refused", so that one that goes on with a map counts as one that never stopped.
class Refusals {
 public:
  explicit Refusals(const map::MapView& before);

  void add(base::EntityId entity, const std::string& reason, const World& world);
  /// Of the last session.
  std::map<std::string, std::int64_t> byReason() const;
  /// What has changed since the last call.
  void addTo(map::MapChange& change);

 private:
  std::set<std::pair<std::string, std::string>> known_;  // reasons, and printed ids of entities
  std::vector<map::Event> events_;
};

}  // namespace prodomos::prediction

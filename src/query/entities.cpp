// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/query/query.hpp"

namespace prodomos::query {

namespace {

template <typename Attributes>
std::vector<Seen<Attributes>> entitiesWith(const map::MapView& view) {
  std::vector<Seen<Attributes>> found;
  for (const auto& entity : view.entities()) {
    const auto* const attributes = std::get_if<Attributes>(&entity.attributes);
    if (attributes == nullptr || entity.confidence <= 0.0) continue;
    const auto& submap = view.graph().getNode(entity.submap);
    found.push_back({entity.id, entity.submap, submap.floor, submap.T_map_submap * entity.T_submap_entity,
                     entity.confidence, entity.lastSeen, *attributes});
  }
  return found;
}

}  // namespace

std::vector<Seen<map::Door>> doors(const map::MapView& view) {
  return entitiesWith<map::Door>(view);
}
std::vector<Seen<map::Staircase>> stairs(const map::MapView& view) {
  return entitiesWith<map::Staircase>(view);
}
std::vector<Seen<map::Human>> people(const map::MapView& view) {
  return entitiesWith<map::Human>(view);
}

}  // namespace prodomos::query

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/bytes.hpp"
#include "prodomos/base/config.hpp"
#include "prodomos/base/id.hpp"
#include "prodomos/map/map_store.hpp"
#include "prodomos/perception/rgbd_view.hpp"
#include "prodomos/perception/sightings.hpp"
#include "prodomos/perception/surfaces.hpp"

#include <functional>
#include <memory>
#include <span>

namespace prodomos::perception {

struct EntityMemoryConfig {};

void describe(base::ConfigVisitor& visitor, EntityMemoryConfig& config);

/// Makes lasting doors and staircases of sightings: the same one seen in many readings and from several sub-maps is one
/// entity, whose confidence grows, whose pose is refined with its covariance, and whose state changes over time.
class EntityMemory {
 public:
  /// T_map_submap as refined now, to compare what was seen from different sub-maps.
  using SubMapPoses = std::function<geometry::Pose3(base::SubMapId)>;

  /// Ids of new entities count from `firstId`.
  EntityMemory(const EntityMemoryConfig& config, base::SessionId session, std::int64_t firstId);
  ~EntityMemory();
  EntityMemory(EntityMemory&&) noexcept;
  EntityMemory& operator=(EntityMemory&&) noexcept;

  /// Sightings of one reading, in the frame of `submap`.
  void add(base::SubMapId submap, std::span<const DoorSighting> doors, const SubMapPoses& poses);
  void add(base::SubMapId submap, std::span<const StaircaseSighting> stairs, const SubMapPoses& poses);
  /// A look at the places where doors and stairs are believed: where it shows something else, that speaks against them
  /// (plain wall, free floor) or tells their state (one sees through).
  void look(base::SubMapId submap, const RgbdView& view, const Surfaces& surfaces, const SubMapPoses& poses);

  /// Those sure enough, by id, as known now; each in the frame of the sub-map in which it was seen best.
  std::vector<map::Entity> entities() const;
  /// Entities that changed since the last call, and events: "detected" (once for each reading in which one was seen;
  /// subject its id), "door_state" with its new state in the payload.
  void addTo(map::MapChange& change);

  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace prodomos::perception

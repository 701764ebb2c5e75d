// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/bytes.hpp"
#include "prodomos/base/id.hpp"
#include "prodomos/map/map_store.hpp"
#include "prodomos/map/occupancy_grid.hpp"
#include "prodomos/perception/people_config.hpp"
#include "prodomos/perception/person_sighting.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace prodomos::perception {

/// Follows persons: identity, smoothed position, heading, velocity, dominant side (002 §II-E).
class PersonTracker {
 public:
  /// Each person's entity gets its id from `nextEntity`. Ids of tracks count from `firstTrack`.
  PersonTracker(const PeopleConfig& config, base::SessionId session, std::int64_t firstTrack,
                std::function<base::EntityId()> nextEntity);
  ~PersonTracker();
  PersonTracker(PersonTracker&&) noexcept;
  PersonTracker& operator=(PersonTracker&&) noexcept;

  /// Whether a reading of that time is worth looking at: readings come faster than PeopleConfig::rate.
  bool wants(base::Time time) const;
  /// The sightings of one reading, none included, in time. `grid`: of the sub-map, for the dominant side; may be null.
  void add(base::SubMapId submap, base::Time time, const std::vector<PersonSighting>& sightings,
           const map::OccupancyGrid* grid);
  /// The robot goes on into another sub-map: those followed come along.
  void enter(const geometry::Pose3& T_submap_before);

  /// Those followed long enough, as map::Human entities where they were last seen, by id.
  std::vector<map::Entity> entities() const;
  /// Tracks with the states since the last call, and entities that changed. States are kept until then: nothing else
  /// grows with time.
  void addTo(map::MapChange& change);

  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace prodomos::perception

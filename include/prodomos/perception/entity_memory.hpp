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

struct EntityMemoryConfig {
  double certainty = 2.2;           ///< log-odds from which on a thing is in the map: more than one image alone can add
  double doubt = 1.2;               ///< log-odds below which it is given up again
  double prior = -1.0;              ///< log-odds before anything was seen
  double correlation = 0.5;         ///< of the errors of two readings taken from one place, 0 … 1
  double lookSpacing = 0.3;         ///< metres that the robot moves until a reading counts as a new look
  double positionFloor = 0.05;      ///< metres; no sighting is believed to be better placed
  double headingFloor = 0.03;       ///< radians, likewise
  double submapPosition = 0.1;      ///< metres, of one sub-map against another
  double submapHeading = 0.02;      ///< radians, likewise
  double doorMiss = 0.7;            ///< log-odds lost where a door should be well seen and is not found
  double stairsMiss = 0.7;          ///< the same of stairs
  double doorwayMiss = 0.15;        ///< the same of doorways, where a sub-map's grid shows that there is none
  double openingAgainstLeaf = 0.2;  ///< log-odds against a leaf, of an opening in which none is seen
  double stateTrust = 0.75;         ///< that one reading tells the state of a door rightly
  double stateMemory = 30.0;        ///< seconds in which the state of a door that nobody sees is forgotten
  double forgetting = 120.0;        ///< seconds after which what was never sure is forgotten
  double leastDoorWidth = 0.5;      ///< metres
  double greatestDoorWidth = 3.2;   ///< metres
  double greatestOpening = 4.2;     ///< metres, of doorways without a leaf
};

void describe(base::ConfigVisitor& visitor, EntityMemoryConfig& config);

/// Makes lasting doors and staircases of sightings: the same one seen in many readings and from several sub-maps is one
/// entity, whose confidence grows, whose pose is refined with its covariance, and whose state changes over time
/// (docs/entities.md). Of each reading: first add(), of all its sightings, then look().
class EntityMemory {
 public:
  /// T_map_submap as refined now, to compare what was seen from different sub-maps.
  using SubMapPoses = std::function<geometry::Pose3(base::SubMapId)>;

  /// Whether a grid shows that there is no doorway of that width: showsNoDoorway().
  using ShowsNoDoorway = std::function<bool(const geometry::Pose3& T_submap_doorway, double width)>;

  /// An id that no entity has had yet; asked for when a thing has become sure enough for the map.
  using NewId = std::function<base::EntityId()>;

  EntityMemory(const EntityMemoryConfig& config, base::SessionId session, NewId newId);
  ~EntityMemory();
  EntityMemory(EntityMemory&&) noexcept;
  EntityMemory& operator=(EntityMemory&&) noexcept;

  /// Sightings of one image, in the frame of `submap`. Those that cannot be (5 m wide, NaN, no covariance) are passed
  /// over. Where the sensor stood tells how much one sighting adds to the last.
  void add(base::SubMapId submap, const geometry::Pose3& T_submap_sensor, std::span<const DoorSighting> doors,
           const SubMapPoses& poses);
  void add(base::SubMapId submap, const geometry::Pose3& T_submap_sensor, std::span<const StaircaseSighting> stairs,
           const SubMapPoses& poses);
  /// All doorways that the grid of `submap` shows now: its last word, whatever it showed before. Where one is not among
  /// them and `showsNone`, that counts against it.
  void addFromGrid(base::SubMapId submap, std::span<const DoorSighting> doorways, const ShowsNoDoorway& showsNone,
                   const SubMapPoses& poses);
  /// A look at the places where doors and stairs are believed: where it shows something else, that speaks against them
  /// (no wall, free floor, nothing found from near by) or tells their state (one sees through).
  void look(base::SubMapId submap, const RgbdView& view, const Surfaces& surfaces, const SubMapPoses& poses);
  /// The same with a level scan, which tells of doors whether they are closed.
  void look(base::SubMapId submap, const geometry::Pose3& T_submap_sensor, const sensors::LaserScan& scan,
            base::Time time, const SubMapPoses& poses);

  /// Those sure enough, by id, as known now; each in the frame of the sub-map in which it was seen best.
  std::vector<map::Entity> entities() const;
  /// Since the last call: entities that changed, those that were given up, and events: "detected" (once for each
  /// reading in which one was seen; subject its id), "door_state" with its new state in the payload, "entity_removed".
  void addTo(map::MapChange& change);

  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace prodomos::perception

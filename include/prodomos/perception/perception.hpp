// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/bytes.hpp"
#include "prodomos/base/stopwatch.hpp"
#include "prodomos/map/occupancy_grid.hpp"
#include "prodomos/map/submap.hpp"
#include "prodomos/perception/config.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace prodomos::perception {

/// Turns the readings of a session into doors, staircases and people: all detectors, and what they remember.
class Perception {
 public:
  /// What is new here gets ids from these on.
  struct Ids {
    base::EntityId entity{0};
    base::TrackId track{0};
  };

  /// `debug` may be null, else must outlive this. Throws base::FileError where a folder of networks is named and lacks
  /// one, or one does not load.
  Perception(const PerceptionConfig& config, base::SessionId session, sensors::ClassTable classes, Ids first,
             DebugImages* debug = nullptr);
  ~Perception();
  Perception(const Perception&) = delete;
  Perception& operator=(const Perception&) = delete;

  /// A reading, where it was taken, and into what.
  struct Place {
    const map::PlacedReading& placed;
    const map::SubMap& submap;  ///< with the reading in its layers
    double floor_z = 0.0;       ///< of the floor below the robot, in the sub-map
  };
  /// What could not be looked at is counted in `notLookedAt`, by reason: "an image without depth".
  void perceive(const Place& place, const EntityMemory::SubMapPoses& poses, base::StageTimes& times,
                std::map<std::string, std::int64_t>& notLookedAt);
  /// Joints of the image perceived last, from a side file: in place of what networks would say. False: there are none
  /// of use in it. `submap`: the running one.
  bool takeSideFile(const sensors::Reading& reading, const map::SubMap& submap);
  /// What is known around a sub-map.
  struct Surroundings {
    base::SubMapId submap;
    map::OccupancyGrid grid;  ///< its own, with those of its neighbours merged into it
    base::Time begin{};       ///< of the readings in it
    base::Time end{};
  };
  /// Looks for doorways. May be asked for again, once more is known: the last look at a sub-map counts.
  void lookAround(const Surroundings& around, const EntityMemory::SubMapPoses& poses);
  /// The robot has left the sub-map, whose layers are final ...
  void finish(const map::SubMap& submap);
  /// ... and goes on in another one.
  void enter(const geometry::Pose3& T_submap_before);

  /// What is believed now, people included, by id.
  std::vector<map::Entity> entities() const;
  /// What has changed since the last call.
  void addTo(map::MapChange& change);

  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace prodomos::perception

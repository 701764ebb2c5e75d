// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/bytes.hpp"
#include "prodomos/base/stopwatch.hpp"
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
  void perceive(const Place& place, const EntityMemory::SubMapPoses& poses, base::StageTimes& times);
  /// Joints of the image perceived last, from a side file: in place of what networks would say. False: there are none
  /// of use in it. `submap`: the running one.
  bool takeSideFile(const sensors::Reading& reading, const map::SubMap& submap);
  /// The robot has left the sub-map, whose layers are final.
  void finish(const map::SubMap& submap, const EntityMemory::SubMapPoses& poses, base::StageTimes& times);
  /// ... and goes on in another one.
  void enter(const geometry::Pose3& T_submap_before);

  /// What is believed now, people included, by id.
  std::vector<map::Entity> entities() const;
  /// What has changed since the last call.
  void addTo(map::MapChange& change);
  /// What detectors could not look at, by reason: {"doors and people: an image without colour", 12}.
  const std::map<std::string, std::int64_t>& skipped() const;

  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace prodomos::perception

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/perception/entity_memory.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <vector>

/// What detectors would say of doors and stairs that are known, with noise.
namespace prodomos::test {

inline base::Time at(double seconds) {
  return base::Time{} + base::fromSeconds(seconds);
}

struct WorldDoor {
  geometry::Pose2 pose;  ///< middle of the leaf; x is the normal
  double width = 0.9;
  bool hasLeaf = true;
  map::HingeSide hinge = map::HingeSide::kLeft;  ///< seen along x
  map::DoorState state = map::DoorState::kClosed;
};

struct DoorNoise {
  double position = 0.03;   ///< metres
  double heading = 0.02;    ///< radians
  double width = 0.03;      ///< metres
  double hingeWrong = 0.1;  ///< share of the sightings
};

class SightingMaker {
 public:
  explicit SightingMaker(std::uint64_t seed) : random_(seed, "sightings") {}

  /// As seen from there, all in the world.
  perception::DoorSighting see(const WorldDoor& door, const Eigen::Vector3d& sensor, double time,
                               const DoorNoise& noise = {}) {
    const Eigen::Vector2d between = Eigen::Vector2d(door.pose.x, door.pose.y) - sensor.head<2>();
    const bool fromBehind = between.dot(Eigen::Vector2d(std::cos(door.pose.theta), std::sin(door.pose.theta))) < 0.0;
    auto pose = door.pose;
    pose.x += random_.normal(0.0, noise.position);
    pose.y += random_.normal(0.0, noise.position);
    pose.theta += random_.normal(0.0, noise.heading) + (fromBehind ? std::numbers::pi : 0.0);
    perception::DoorSighting sighting;
    sighting.time = at(time);
    sighting.T_submap_door = geometry::toPose3(pose);
    const double variance = noise.position * noise.position;
    sighting.covariance = Eigen::Vector4d(variance, variance, 0.01, noise.heading * noise.heading).asDiagonal();
    sighting.door = {.width = door.width + random_.normal(0.0, noise.width),
                     .height = door.hasLeaf ? 2.0 : 0.0,
                     .hasLeaf = door.hasLeaf,
                     .state = door.hasLeaf ? door.state : map::DoorState::kUnknown};
    sighting.widthSigma = noise.width;
    if (door.hasLeaf && door.hinge != map::HingeSide::kUnknown) {
      const bool isLeft = (door.hinge == map::HingeSide::kLeft) != fromBehind;
      const bool isWrong = random_.uniform() < noise.hingeWrong;
      sighting.hingeEvidence = isLeft != isWrong ? 1.5 : -1.5;
    }
    sighting.evidence = 1.5;
    sighting.range = between.norm();
    return sighting;
  }

  base::Random& random() { return random_; }

 private:
  base::Random random_;
};

/// Of a sighting in the world, as it lies in a sub-map.
inline perception::DoorSighting inSubmap(perception::DoorSighting sighting, const geometry::Pose3& T_world_submap) {
  const geometry::Pose3 T_submap_world = T_world_submap.inverse();
  sighting.T_submap_door = T_submap_world * sighting.T_submap_door;
  Eigen::Matrix4d rotation = Eigen::Matrix4d::Identity();
  rotation.topLeftCorner<3, 3>() = T_submap_world.linear();
  sighting.covariance = rotation * sighting.covariance * rotation.transpose();
  return sighting;
}

/// A memory, the sub-maps it is told of, and the map that takes what it tells.
struct MemoryBench {
  explicit MemoryBench(const perception::EntityMemoryConfig& config = {})
      : memory(config, {1}, [this] { return base::EntityId{++lastId}; }) {}
  MemoryBench(const MemoryBench&) = delete;
  MemoryBench& operator=(const MemoryBench&) = delete;

  perception::EntityMemory::SubMapPoses poses() const {
    return [this](base::SubMapId id) { return submaps.at(id.value); };
  }
  /// A sighting in the world, told in the frame of the sub-map.
  void add(std::int64_t submap, const Eigen::Vector3d& sensor, std::vector<perception::DoorSighting> doors) {
    const auto& T_world_submap = submaps.at(submap);
    for (auto& door : doors) door = inSubmap(door, T_world_submap);
    memory.add({submap}, sensorPose(submap, sensor), doors, poses());
  }
  /// What a sub-map's grid shows; where it does not show a doorway, it tells nothing, or that there is none.
  void addFromGrid(std::int64_t submap, const std::vector<perception::DoorSighting>& doorways, bool showsNone = false) {
    const auto tell = [showsNone](const geometry::Pose3&, double) { return showsNone; };
    memory.addFromGrid({submap}, doorways, tell, poses());
  }
  geometry::Pose3 sensorPose(std::int64_t submap, const Eigen::Vector3d& sensor) const {
    return submaps.at(submap).inverse() * geometry::Pose3(Eigen::Translation3d(sensor));
  }
  std::vector<map::Entity> entities() const { return memory.entities(); }
  geometry::Pose2 inWorld(const map::Entity& entity) const {
    return geometry::toPose2(submaps.at(entity.submap.value) * entity.T_submap_entity);
  }
  map::MapChange change() {
    map::MapChange change;
    memory.addTo(change);
    return change;
  }

  std::map<std::int64_t, geometry::Pose3> submaps{{0, geometry::Pose3::Identity()}};
  std::int64_t lastId = 0;
  perception::EntityMemory memory;
};

inline const map::Door& doorOf(const map::Entity& entity) {
  return std::get<map::Door>(entity.attributes);
}

}  // namespace prodomos::test

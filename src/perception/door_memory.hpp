// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/entity_memory.hpp"

#include "perception/door_appearance.hpp"
#include "perception/door_association.hpp"
#include "perception/door_landmark.hpp"

#include <optional>
#include <span>
#include <vector>

namespace prodomos::perception {

/// Doors and doorways.
class DoorMemory {
 public:
  explicit DoorMemory(const EntityMemoryConfig& config) : config_(config) {}

  void add(const Frames& frames, const Eigen::Vector3d& sensor_in_submap, std::span<const DoorSighting> doors);
  void addFromGrid(const Frames& frames, std::span<const DoorSighting> doorways,
                   const EntityMemory::ShowsNoDoorway& showsNone);
  void look(const Frames& frames, const RgbdView& view, const Surfaces& surfaces);
  void look(const Frames& frames, const geometry::Pose3& T_submap_sensor, const std::vector<ScanBeam>& beams,
            base::Time time);

  std::vector<DoorLandmark>& landmarks() { return landmarks_; }
  const std::vector<DoorLandmark>& landmarks() const { return landmarks_; }
  /// Entities that turned out to be others, since the last call.
  std::vector<base::EntityId> takeMerged() { return std::exchange(merged_, {}); }

  static void fields(auto& archive, auto& self) { archive(self.landmarks_, self.lastSubmap_); }

 private:
  /// By sighting the index of its landmark, a new one where none is known; none: nothing new is learned of it.
  std::vector<std::optional<std::size_t>> associate(const Frames& frames, std::span<const DoorSighting> doors);
  /// What a grid in which it is not found says of it: that it is none, or nothing. False: as before.
  bool miss(DoorLandmark& door, const Frames& frames, const EntityMemory::ShowsNoDoorway& showsNone) const;
  void update(const Frames& frames, const std::vector<std::size_t>& touched);
  /// Makes one of two; the place of the other stays, empty, until prune().
  bool mergeIfSame(std::size_t i, std::size_t j, const Frames& frames);
  void mergeAll(const Frames& frames);
  /// A closed door that turns out to be the leaf of another one, which stands open.
  bool takeLeaf(std::size_t door, std::size_t leaf, const Frames& frames);
  void settleRivals(std::size_t door, const Frames& frames);
  void prune();
  void takeBackLeaf(DoorLandmark& door, const Frames& frames, const RgbdView& view) const;
  void see(DoorLandmark& door, const Frames& frames, const RgbdView& view, const Surfaces& surfaces) const;

  EntityMemoryConfig config_;
  std::vector<DoorLandmark> landmarks_;
  std::optional<base::SubMapId> lastSubmap_;
  std::vector<base::EntityId> merged_;
};

}  // namespace prodomos::perception

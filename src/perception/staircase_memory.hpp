// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/entity_memory.hpp"

#include "perception/staircase_landmark.hpp"

#include <optional>
#include <span>
#include <vector>

namespace prodomos::perception {

/// Flights of stairs, up and down.
class StaircaseMemory {
 public:
  explicit StaircaseMemory(const EntityMemoryConfig& config) : config_(config) {}

  void add(const Frames& frames, const Eigen::Vector3d& sensor_in_submap, std::span<const StaircaseSighting> stairs);
  void look(const Frames& frames, const RgbdView& view, const Surfaces& surfaces);

  std::vector<StaircaseLandmark>& landmarks() { return landmarks_; }
  const std::vector<StaircaseLandmark>& landmarks() const { return landmarks_; }
  /// Entities that turned out to be others, since the last call.
  std::vector<base::EntityId> takeMerged() { return std::exchange(merged_, {}); }

  static void fields(auto& archive, auto& self) { archive(self.landmarks_, self.lastSubmap_, self.heightsAreLost_); }

 private:
  StaircaseLandmark* seenFromElsewhere(const Frames& frames, const StaircaseSighting& sighting);
  std::vector<std::size_t> associate(const Frames& frames, std::span<const StaircaseSighting> stairs);
  void mergeIfSame(std::size_t i, std::size_t j, const Frames& frames);
  void see(StaircaseLandmark& stairs, const Frames& frames, const RgbdView& view, const Surfaces& surfaces) const;

  EntityMemoryConfig config_;
  std::vector<StaircaseLandmark> landmarks_;
  std::optional<base::SubMapId> lastSubmap_;
  bool heightsAreLost_ = false;  ///< the robot has climbed, and its poses do not tell
  std::vector<base::EntityId> merged_;
};

}  // namespace prodomos::perception

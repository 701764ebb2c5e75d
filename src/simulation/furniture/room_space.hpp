// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include "simulation/scenes/scene_geometry.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace prodomos::simulation {

/// One room, what stands in it, and what must stay free: says whether one more thing fits. Ways are judged on a raster
/// of 0.1 m: every door and every end of stairs that one could reach from another in the empty room stays within reach,
/// and little of the floor is cut off.
class RoomSpace {
 public:
  /// What the building has in that room already stands in it.
  RoomSpace(const Building& building, int room);

  const Room& room() const { return room_; }
  double floorLevel() const { return storey_.floor_z; }
  double ceilingHeight() const { return storey_.ceilingHeight; }
  const std::vector<WallStretch>& walls() const { return walls_; }
  /// Of the free floor, in reach of the doors with room to walk.
  std::size_t freeCells() const { return free_.size(); }
  Eigen::Vector2d freeCell(std::size_t index) const { return centreOf(free_[index]); }

  /// Adds the thing where it fits between walls, things, doors and stairs, and leaves the ways as wide as they must be.
  bool tryAdd(const Thing& thing);
  std::vector<Thing> takeAdded() { return std::move(added_); }
  std::size_t addedCount() const { return added_.size(); }

 private:
  /// What is taken up in plan and height.
  struct Volume {
    Footprint footprint;
    double bottom = 0.0;
    double top = 0.0;
  };

  static Volume volumeOf(const Thing& thing);
  static Volume viewOf(const Thing& thing);
  void keepDoorsClear(const Building& building);
  void keepStairsClear(const Building& building);
  void keepWaysClear(const Building& building);
  void rasterize();
  void findReach();

  bool fits(const Thing& thing) const;
  bool standsBefore(const Thing& thing) const;
  void take(const Thing& thing);
  bool leavesWays(const Footprint& footprint);
  std::vector<std::size_t> cellsNear(const Footprint& footprint) const;
  std::size_t flood();
  std::optional<std::size_t> nearestOpen(const Eigen::Vector2d& point) const;
  Eigen::Vector2d centreOf(std::size_t cell) const;

  const Room& room_;
  Storey storey_;
  double clearance_;  ///< half the width of a way, metres
  std::vector<WallStretch> walls_;
  std::vector<Footprint> hidden_;  ///< doors, their frames, steps: nothing hangs there
  std::vector<Footprint> clear_;   ///< nothing stands there
  std::vector<Footprint> flights_;
  std::vector<Eigen::Vector2d> goals_;  ///< before doors and stairs
  std::vector<Volume> taken_;
  std::vector<Volume> inView_;  ///< before what hangs
  std::vector<Thing> added_;
  // The raster: cells in which the middle of a robot may be.
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  std::size_t columns_ = 0;
  std::size_t rows_ = 0;
  std::vector<std::uint8_t> open_;
  std::vector<std::uint8_t> seen_;
  std::vector<std::size_t> queue_;
  std::vector<std::size_t> free_;     ///< cells in reach while the room was empty
  std::vector<std::size_t> starts_;   ///< one goal's cell of each part that hangs together
  std::vector<std::size_t> reached_;  ///< cells of goals that have to be reached
  std::size_t closedCells_ = 0;       ///< by things
};

}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/cells.hpp"
#include "prodomos/evaluation/half_disc.hpp"

#include <functional>
#include <vector>

namespace prodomos::evaluation {

/// A box behind a door, aligned with it: from kWallHalf to `depth` ahead, from `right` of its middle to `left` of it.
struct DoorBox {
  double left = 0.0;  ///< metres, all three positive
  double right = 0.0;
  double depth = 0.0;

  bool operator==(const DoorBox&) const = default;
};

/// The true room behind a door and what is known there, in cells of the door's own frame: x ahead, y to the left. What
/// lies farther than 15 m from the door counts to the room's area alone.
class DoorView {
 public:
  /// `isKnown` is asked for points of the world.
  DoorView(const geometry::Pose2& T_world_door, const Polygon& room_in_world,
           const std::function<bool(const Eigen::Vector2d&)>& isKnown, double resolution = kCell);
  /// Of a room that is told as cells of kCell: those that are not 0.
  DoorView(const geometry::Pose2& T_world_door, const CellMap<std::uint8_t>& room_in_world,
           const std::function<bool(const Eigen::Vector2d&)>& isKnown);

  double roomArea() const { return roomArea_; }  ///< m²

  /// Intersection over union with the room, 0 … 1.
  double iou(const Polygon& shape_in_world) const;
  double iou(const DoorBox& box) const;
  /// Of the part of the box that is not known and hangs together with the door.
  double iouClipped(const DoorBox& box) const;
  /// Of half-discs, by radius.
  ByRadius iousOfHalfDiscs() const;
  /// The box of the greatest IoU, to a cell.
  DoorBox bestBox() const;

 private:
  DoorView(const geometry::Pose2& T_world_door, double resolution);

  void survey(const geometry::Pose2& T_world_door, const std::function<bool(const Eigen::Vector2d&)>& isKnown);
  double iouOf(double cellsInBoth, double cellsInShape) const;
  geometry::CellBox cellsOf(const DoorBox& box) const;
  double roomCells(const geometry::CellBox& box) const;

  geometry::Pose2 T_door_world_;
  double resolution_;
  double roomArea_ = 0.0;
  CellMap<std::uint8_t> room_;
  CellMap<std::uint8_t> known_;
  std::vector<std::int32_t> roomBelow_;  ///< cells of the room at and below, right and behind: an integral image
};

}  // namespace prodomos::evaluation

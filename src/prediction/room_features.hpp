// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/prediction/surroundings.hpp"

#include "prediction/outline.hpp"

#include <array>
#include <vector>

namespace prodomos::prediction {

inline constexpr double kLeastWidth = 0.5;  ///< metres, of a room

/// m² that one may reach behind a door: within 2 m ahead and 1.5 m to each side; 5 m and 4 m; as far as one looks.
struct ReachableArea {
  float close = 0.0F;
  float nearby = 0.0F;
  float all = 0.0F;
};
ReachableArea areaOf(const CellSet& reachable);

/// What the trees are asked about: numbers that tell of a door's surroundings, as seen by one who stands in the door
/// and looks ahead, or (mirrored) sees all of it in a mirror. Metres; kFar where there is no such thing.
class RoomFeatures {
 public:
  static constexpr float kFar = 15.0F;

  RoomFeatures(const Surroundings& around, double doorWidth, bool mirrored);

  /// Of the door alone.
  const std::vector<float>& ofDoor() const { return door_; }
  /// Of the wall that the room may have `across` metres to the left, if it ends `other` metres to the right; kFar where
  /// that is not told. Valid until the next call.
  const std::vector<float>& ofSide(double across, double other = kFar);
  /// Of the wall that it may have `ahead` metres ahead, if it is `width` wide.
  const std::vector<float>& ofEnd(double ahead, double width);
  /// Of the question whether there is unseen floor behind at all.
  const std::vector<float>& ofSpace(const ReachableArea& area);

 private:
  /// Where something begins that is known, and what.
  struct Hit {
    float distance = kFar;
    bool isFree = false;
  };
  struct Neighbour {
    double across = 0.0;  ///< to the left
    bool leadsToKnown = false;
  };
  /// A room that was seen, on the far side of the own wall: where it begins, how wide it is, where it ends ahead.
  struct SeenRoom {
    float across = kFar;
    float width = kFar;
    float depth = kFar;
  };

  map::CellState at(geometry::CellIndex cell) const;
  map::CellState at(double ahead, double across) const;
  bool isKnown(geometry::CellIndex cell) const { return at(cell) != map::CellState::kUnknown; }
  Hit firstKnown(double ahead, double across, geometry::CellIndex step) const;
  float endOfFree(double ahead, double across, geometry::CellIndex step) const;
  SeenRoom seenRoom(int side) const;
  float competition(double ahead, double across) const;

  void sortOpenings(bool mirrored);
  void tellDoors();
  void tellCorridor();
  void tellSpace();
  void tellSeenRooms();

  const Surroundings& around_;
  bool mirrored_;
  double doorWidth_;
  std::vector<Neighbour> left_;  ///< doors of the own wall, the nearest first
  std::vector<Neighbour> right_;
  std::vector<double> opposite_;            ///< of the corridor's other wall, to the left
  std::vector<Eigen::Vector2d> entrances_;  ///< a step behind other openings, where nothing is known
  float oppositeAhead_ = kFar;              ///< the nearest opening of a wall ahead that looks this way
  float oppositeAcross_ = kFar;
  float corridorLeft_ = kFar;    ///< how far it goes to the left
  float spacing_ = kFar;         ///< of the own wall's doors, median
  std::array<Hit, 7> rowsLeft_;  ///< what is known first to the left, in rows kRows ahead
  std::array<Hit, 7> rowsRight_;
  std::array<Hit, 7> columns_;  ///< what is known first ahead, in columns kColumns to the left
  std::vector<float> toLeft_;   ///< where it is, by cells ahead
  std::vector<float> toRight_;
  std::vector<float> toEnd_;  ///< what is known first ahead, by cells to the left
  SeenRoom seenLeft_;
  SeenRoom seenRight_;
  std::vector<float> door_;
  std::vector<float> question_;
};

}  // namespace prodomos::prediction

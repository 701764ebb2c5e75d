// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/baselines.hpp"
#include "prodomos/evaluation/door_view.hpp"
#include "prodomos/evaluation/scene.hpp"

#include <optional>
#include <vector>

/// Predicted rooms against the true ones behind closed doors, beside what trivial predictors reach there.
/// docs/evaluation.md defines every measure.
namespace prodomos::evaluation {

inline constexpr double kLargestRoom = 60.0;  ///< m², of the rooms that trivial predictors are compared on

/// One predicted room: intersection over union with the true one.
struct RoomShape {
  bool isOrdinary = false;     ///< no corridor, no stairwell, at most kLargestRoom
  double predictedArea = 0.0;  ///< m²
  double iou = 0.0;
  double halfDisc = 0.0;  ///< of the radius that was trained
  double fixedBox = 0.0;
  double clippedBox = 0.0;
  double oracleBox = 0.0;
  ByRadius halfDiscs{};  ///< of all radii
};

/// The likely room that a prediction tells; where it tells none, its floor at the least threshold.
Polygon likelyRoom(const ClaimedSpace& space);
/// `isRoom`: neither corridor nor stairwell, as far as one can tell.
RoomShape judgeShape(const Polygon& likelyRoom, const DoorView& view, bool isRoom,
                     const Baselines& baselines = trainedBaselines());

struct RoomShapes {
  std::vector<RoomShape> shapes;

  std::size_t ordinaryCount() const;
  /// Mean IoUs; none where there is no such room. All but the first are of ordinary rooms.
  std::optional<double> all() const;
  std::optional<double> ordinary() const;
  std::optional<double> fixedBox() const;
  std::optional<double> clippedBox() const;
  std::optional<double> oracleBox() const;
  std::optional<double> halfDiscBest() const;
  std::optional<double> halfDiscEqualArea() const;  ///< all of one radius, so great that they cover as much together
};

struct RoomScore : RoomShapes {
  FoundCount doors;  ///< visible closed doors with an unseen room behind, in the end; those with a predicted room

  RoomScore& operator+=(const RoomScore& other);
};

RoomScore scoreRooms(const Scene& scene, const Baselines& baselines = trainedBaselines());

}  // namespace prodomos::evaluation

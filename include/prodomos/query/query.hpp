// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/map_view.hpp"
#include "prodomos/map/occupancy_grid.hpp"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

/// Questions of planners. All read-only, on a MapView of a file or of a running mapper.
namespace prodomos::query {

/// A spot in the map frame.
struct Position {
  double x = 0.0;  ///< metres
  double y = 0.0;
  std::optional<int> floor;
};

/// A room that nobody has seen, behind a door or up the stairs.
struct PredictedRoom {
  base::SubMapId node;
  base::PredictionId prediction;
  base::EntityId cause;
  std::optional<int> floor;
  double probability = 0.0;
  double expectedArea = 0.0;         ///< m²
  geometry::Pose2 viewpoint_in_map;  ///< where to stand to enter it: in front of the door or the stairs, facing them
  std::optional<map::Route> route;   ///< from `from`, where one was given
};

/// Ordered by probability, the greatest first. Empty for maps without predictions.
std::vector<PredictedRoom> predictedRooms(const map::MapView& view, double leastProbability = 0.0,
                                          std::optional<Position> from = std::nullopt);

/// What the map knows of one spot.
struct PlaceAnswer {
  std::optional<int> place;
  std::optional<base::SubMapId> submap;  ///< the one that knows the spot best; none where no sub-map knows it
  std::optional<int> floor;
  map::CellState state = map::CellState::kUnknown;
  double probability = 0.5;  ///< of being occupied
};
PlaceAnswer placeAt(const map::MapView& view, const Position& position);

/// The shortest way over the graph between the sub-maps that know the two spots; none where one of them is unknown or
/// they are not connected.
std::optional<map::Route> routeBetween(const map::MapView& view, const Position& from, const Position& to);

}  // namespace prodomos::query

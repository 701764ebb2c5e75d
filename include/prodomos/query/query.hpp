// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/polygon.hpp"
#include "prodomos/map/map_view.hpp"
#include "prodomos/map/occupancy_grid.hpp"
#include "prodomos/map/place_map.hpp"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

/// Questions of planners. All read-only, on a MapView of a file or of a running mapper. docs/query.md tells the same
/// of the program's answers.
namespace prodomos::query {

/// A spot in the map frame.
struct Position {
  double x = 0.0;  ///< metres
  double y = 0.0;
  std::optional<int> floor;
};

/// What the map knows of one spot.
struct PlaceAnswer {
  std::optional<int> place;  ///< of the sub-map, or of the cell where `places` are given; none where it is not free
  std::optional<base::SubMapId> submap;  ///< the one that knows the spot best; none where no sub-map knows it
  std::optional<int> floor;
  map::CellState state = map::CellState::kUnknown;
  double probability = 0.5;  ///< of being occupied
};
/// A sub-map may see into several places: which one a cell belongs to is told by `places`, made of the same view.
PlaceAnswer placeAt(const map::MapView& view, const Position& position, const map::PlaceMap* places = nullptr);

/// A way over the graph from one spot to another.
struct Route {
  std::vector<base::SubMapId> submaps;  ///< from that which knows the start to that which knows the goal
  std::vector<base::EdgeId> edges;      ///< one fewer
  double length = 0.0;                  ///< metres, by way of the origins of the sub-maps between
  double probability = 1.0;             ///< that one can go it: of all predicted sub-maps on it together
};
/// The shortest one; none where nobody knows or predicts one of the spots, or they are not connected.
std::optional<Route> routeBetween(const map::MapView& view, const Position& from, const Position& to);

/// Floor that is predicted to be free, at one relative threshold.
struct FreeFloor {
  double threshold = 0.5;
  double area = 0.0;                 ///< m²
  geometry::Polygon outline_in_map;  ///< without holes
};

/// A room that nobody has seen, behind a door or beyond stairs.
struct PredictedRoom {
  base::SubMapId node;
  base::PredictionId prediction;
  base::EntityId cause;                     ///< the door or staircase
  std::optional<map::DoorState> doorState;  ///< none for stairs
  std::optional<int> floor;
  double probability = 0.0;           ///< that an unseen space of at least 2 m² lies there
  double expectedArea = 0.0;          ///< m²
  std::vector<FreeFloor> freeFloor;   ///< by ascending threshold
  geometry::Pose2 viewpoint_in_map;   ///< where to stand to enter it, facing the way
  bool isViewpointFree = false;       ///< that floor was seen free; false: nobody has seen the floor there
  std::optional<base::Time> blocked;  ///< when a planner last found that the way there cannot be gone
  std::optional<Route> route;         ///< to the viewpoint, from `from` where one was given
  /// m²/m: expected area times probability, by the length of the route (at least 1 m); none without a route.
  std::optional<double> gainPerMetre;
};

/// Those that can be reached first, the greatest gain per metre before others; then by probability; blocked ones last.
std::vector<PredictedRoom> predictedRooms(const map::MapView& view, double leastProbability = 0.0,
                                          std::optional<Position> from = std::nullopt);

/// What is predicted to be free beyond the sub-map's door or stairs, or, of an observed one, on the ways of people
/// there, at that threshold: one of those that predictions are told at. Throws base::UsageError, which names them, at
/// another; empty where nothing is predicted.
std::vector<FreeFloor> freeFloor(const map::MapView& view, base::SubMapId node, double threshold);

/// A door, a staircase or a person of the map.
template <typename Attributes>
struct Seen {
  base::EntityId id;
  base::SubMapId submap;
  std::optional<int> floor;
  geometry::Pose3 T_map_entity = geometry::Pose3::Identity();
  double confidence = 0.0;
  base::Time lastSeen{};
  Attributes attributes;
};

/// By id; without those that were given up.
std::vector<Seen<map::Door>> doors(const map::MapView& view);
std::vector<Seen<map::Staircase>> stairs(const map::MapView& view);
std::vector<Seen<map::Human>> people(const map::MapView& view);

}  // namespace prodomos::query

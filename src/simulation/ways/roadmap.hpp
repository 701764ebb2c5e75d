// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/navigation.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace prodomos::simulation {

/// Spots of all rooms and both sides of all doors of a storey, joined where a body can go from one to the next: for
/// choosing where to go, FloorGrid::path() says how.
class Roadmap {
 public:
  struct Node {
    Eigen::Vector2d position;
    int room;
    std::optional<std::size_t> door;  ///< that this is a side of; else a spot in the room
  };
  /// From one point to all nodes.
  struct Routes {
    std::vector<double> lengths;                       ///< metres, infinite where there is no way
    std::vector<std::optional<std::size_t>> previous;  ///< node on the way; none: directly
  };

  Roadmap(const Building& building, const FloorGrid& grid);

  const std::vector<Node>& nodes() const { return nodes_; }
  /// The spots of a room, the roomiest first.
  const std::vector<std::size_t>& spotsOf(int room) const { return spots_[static_cast<std::size_t>(room)]; }
  /// Spots are at least so far from each other, metres; by the room's size.
  double spacingOf(int room) const { return spacings_[static_cast<std::size_t>(room)]; }

  Routes routesFrom(const Eigen::Vector2d& point, const DoorFilter& mayPass = anyDoor) const;
  /// To a node of finite length, or on to a point that it is nearest to; by the doors that the routes take.
  std::optional<Polyline> path(const Eigen::Vector2d& from, const Routes& routes, std::size_t node) const;
  std::optional<Polyline> path(const Eigen::Vector2d& from, const Routes& routes, std::size_t node,
                               const Eigen::Vector2d& to) const;
  std::optional<std::size_t> nearestNode(const Eigen::Vector2d& point) const;

 private:
  struct Edge {
    std::size_t to;
    double length;
    std::optional<std::size_t> door;
  };

  void addSpots(const Building& building);
  void addDoors(const Building& building);
  void joinRooms();
  void joinParts(const std::vector<std::size_t>& nodes);
  void join(std::size_t a, std::size_t b, double length, std::optional<std::size_t> door = {});
  std::vector<std::pair<std::size_t, double>> nodesAround(const Eigen::Vector2d& point) const;

  const FloorGrid& grid_;
  std::vector<Node> nodes_;
  std::vector<std::vector<Edge>> edges_;         ///< by node
  std::vector<std::vector<std::size_t>> spots_;  ///< by room
  std::vector<double> spacings_;                 ///< by room
};

/// Metres.
double lengthOf(const Polyline& way);

}  // namespace prodomos::simulation

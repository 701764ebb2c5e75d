// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/ways/roadmap.hpp"

#include "simulation/ways/passing.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <utility>

namespace prodomos::simulation {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// How far before a door one stands to go through it, from the wall's face, metres.
constexpr double kBeforeDoor = 0.5;

/// Nodes of one room farther apart than this are joined by way of others, metres.
constexpr double kReach = 9.0;

bool noDoor(std::size_t /*door*/) {
  return false;
}

}  // namespace

double lengthOf(const Polyline& way) {
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) length += (way[i] - way[i - 1]).norm();
  return length;
}

Roadmap::Roadmap(const Building& building, const FloorGrid& grid)
    : grid_(grid), spots_(building.rooms.size()), spacings_(building.rooms.size(), 0.0) {
  addSpots(building);
  addDoors(building);
  joinRooms();
}

Roadmap::Routes Roadmap::routesFrom(const Eigen::Vector2d& point, const DoorFilter& mayPass) const {
  Routes routes{std::vector(nodes_.size(), kInfinite), std::vector<std::optional<std::size_t>>(nodes_.size())};
  using Waiting = std::pair<double, std::size_t>;
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> queue;
  for (const auto& [node, length] : nodesAround(point)) {
    routes.lengths[node] = length;
    queue.emplace(length, node);
  }
  while (!queue.empty()) {
    const auto [length, node] = queue.top();
    queue.pop();
    if (length > routes.lengths[node]) continue;
    for (const auto& edge : edges_[node]) {
      if (edge.door && !mayPass(*edge.door)) continue;
      if (length + edge.length >= routes.lengths[edge.to]) continue;
      routes.lengths[edge.to] = length + edge.length;
      routes.previous[edge.to] = node;
      queue.emplace(length + edge.length, edge.to);
    }
  }
  return routes;
}

std::optional<Polyline> Roadmap::path(const Eigen::Vector2d& from, const Routes& routes, std::size_t node) const {
  return path(from, routes, node, nodes_[node].position);
}

std::optional<Polyline> Roadmap::path(const Eigen::Vector2d& from, const Routes& routes, std::size_t node,
                                      const Eigen::Vector2d& to) const {
  std::vector<std::size_t> doors;
  for (const auto& end : {from, to}) {
    if (const auto door = grid_.doorAt(end)) doors.push_back(*door);
  }
  for (std::size_t on = node; routes.previous[on]; on = *routes.previous[on]) {
    const auto door = nodes_[on].door;
    if (door && door == nodes_[*routes.previous[on]].door) doors.push_back(*door);
  }
  const auto isOnTheWay = [&](std::size_t door) { return std::ranges::find(doors, door) != doors.end(); };
  return grid_.path(from, to, isOnTheWay);
}

std::optional<std::size_t> Roadmap::nearestNode(const Eigen::Vector2d& point) const {
  const auto around = nodesAround(point);
  if (around.empty()) return std::nullopt;
  return std::ranges::min_element(around, {}, &std::pair<std::size_t, double>::second)->first;
}

void Roadmap::addSpots(const Building& building) {
  for (std::size_t i = 0; i < building.rooms.size(); ++i) {
    const auto& room = building.rooms[i];
    if (room.storey != grid_.storey()) continue;
    spacings_[i] = std::clamp(std::sqrt(std::abs(signedArea(room.outline))) / 3.0, 2.5, 8.0);
    const int index = static_cast<int>(i);
    for (const auto& position : grid_.spots(index, spacings_[i])) {
      spots_[i].push_back(nodes_.size());
      nodes_.push_back({position, index, std::nullopt});
    }
  }
  edges_.resize(nodes_.size());
}

void Roadmap::addDoors(const Building& building) {
  for (std::size_t i = 0; i < building.doors.size(); ++i) {
    const auto& door = building.doors[i];
    if (door.storey != grid_.storey() || !canBePassed(building, door)) continue;
    const Eigen::Vector2d middle(door.pose.x, door.pose.y);
    const Eigen::Vector2d normal(std::cos(door.pose.theta), std::sin(door.pose.theta));
    const Eigen::Vector2d step = (door.wallThickness / 2.0 + kBeforeDoor) * normal;
    const auto first = grid_.nearestFree(middle - step, kBeforeDoor);
    const auto second = grid_.nearestFree(middle + step, kBeforeDoor);
    if (!first || !second || grid_.roomAt(*first) != door.rooms[0] || grid_.roomAt(*second) != door.rooms[1]) continue;
    const auto through = grid_.path(*first, *second, [&](std::size_t other) { return other == i; });
    if (!through) continue;
    nodes_.push_back({*first, door.rooms[0], i});
    nodes_.push_back({*second, door.rooms[1], i});
    edges_.resize(nodes_.size());
    join(nodes_.size() - 2, nodes_.size() - 1, lengthOf(*through), i);
  }
}

void Roadmap::joinRooms() {
  std::map<int, std::vector<std::size_t>> nodesOf;
  for (std::size_t i = 0; i < nodes_.size(); ++i) nodesOf[nodes_[i].room].push_back(i);
  for (const auto& [room, nodes] : nodesOf) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      for (std::size_t j = i + 1; j < nodes.size(); ++j) {
        const auto& a = nodes_[nodes[i]].position;
        const auto& b = nodes_[nodes[j]].position;
        if ((b - a).norm() < kReach && grid_.isFreeLine(a, b, noDoor)) join(nodes[i], nodes[j], (b - a).norm());
      }
    }
    joinParts(nodes);
  }
}

/// Nodes that do not see each other, round the corner or between furniture. The first is the room's roomiest spot; what
/// cannot be reached from it stays apart.
void Roadmap::joinParts(const std::vector<std::size_t>& nodes) {
  std::vector<std::size_t> part{nodes.front()};
  std::vector<std::size_t> rest(nodes.begin() + 1, nodes.end());
  const auto takeSeen = [&] {
    for (std::size_t i = 0; i < part.size(); ++i) {
      const std::size_t node = part[i];
      for (const auto& edge : edges_[node]) {
        if (std::erase(rest, edge.to) > 0) part.push_back(edge.to);
      }
    }
  };
  for (takeSeen(); !rest.empty(); takeSeen()) {
    const std::size_t node = rest.front();
    const auto distance = [&](std::size_t other) { return (nodes_[other].position - nodes_[node].position).norm(); };
    const std::size_t nearest = *std::ranges::min_element(part, {}, distance);
    const auto way = grid_.path(nodes_[node].position, nodes_[nearest].position, noDoor);
    if (way) {
      join(node, nearest, lengthOf(*way));
    } else {
      rest.erase(rest.begin());
    }
  }
}

void Roadmap::join(std::size_t a, std::size_t b, double length, std::optional<std::size_t> door) {
  edges_[a].push_back({b, length, door});
  edges_[b].push_back({a, length, door});
}

std::vector<std::pair<std::size_t, double>> Roadmap::nodesAround(const Eigen::Vector2d& point) const {
  const int room = grid_.roomAt(point);
  const auto door = grid_.doorAt(point);
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const bool isNear = door ? nodes_[i].door == door : nodes_[i].room == room;
    if (isNear) near.emplace_back((nodes_[i].position - point).norm(), i);
  }
  std::ranges::sort(near);
  const auto mayStay = [&](std::size_t other) { return door && other == *door; };
  std::vector<std::pair<std::size_t, double>> found;
  for (const auto& [distance, node] : near) {
    if (distance > kReach && !found.empty()) break;
    if (grid_.isFreeLine(point, nodes_[node].position, mayStay)) found.emplace_back(node, distance);
  }
  for (std::size_t i = 0; i < near.size() && found.empty(); ++i) {
    const std::size_t node = near[i].second;
    if (const auto way = grid_.path(point, nodes_[node].position, mayStay)) found.emplace_back(node, lengthOf(*way));
  }
  return found;
}

}  // namespace prodomos::simulation

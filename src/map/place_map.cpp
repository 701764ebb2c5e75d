// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/place_map.hpp"

#include "prodomos/geometry/pieces.hpp"
#include "prodomos/map/fused_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prodomos::map {

namespace {

constexpr std::int32_t kNowhere = -1;
constexpr double kLeastPlace = 2.0;  // m² of floor; what is smaller and where nobody began is no place
constexpr double kJamb = 0.15;       // metres that a door is drawn beyond its width, into the wall

bool isOnFloor(const Node& node, std::optional<int> floor) {
  return node.kind == SubMapKind::kObserved && (!floor || !node.floor || node.floor == floor);
}

geometry::CellSet freeCells(const OccupancyGrid& grid) {
  geometry::CellSet cells(grid.knownBox(), 0);
  const auto& box = cells.box();
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) {
      if (grid.state({x, y}) == CellState::kFree) *cells.find({x, y}) = 1;
    }
  }
  return cells;
}

/// So densely that nothing passes from edge to edge.
void drawDoor(geometry::CellSet& cells, const geometry::Pose2& T_map_door, double width, double resolution) {
  const double half = width / 2.0 + kJamb;
  const int steps = static_cast<int>(std::ceil(4.0 * half / resolution));
  for (int i = -steps; i <= steps; ++i) {
    const Eigen::Vector2d point = T_map_door * Eigen::Vector2d(0.0, half * i / steps);
    if (auto* cell = cells.find(geometry::cellAt(point.x(), point.y(), resolution))) *cell = 0;
  }
}

std::vector<std::optional<int>> floorsOf(const MapView& view) {
  std::vector<std::optional<int>> floors;
  for (const auto& floor : view.floors()) floors.emplace_back(floor.number);
  if (floors.empty()) floors.emplace_back(std::nullopt);
  return floors;
}

}  // namespace

PlaceMap::PlaceMap(const MapView& view) {
  for (const auto& place : view.graph().places()) {
    SeenPlace seen{.number = place.number, .floor = view.graph().getNode(place.submaps.front()).floor};
    for (const auto id : place.submaps) {
      if (view.graph().getNode(id).kind == SubMapKind::kObserved) seen.submaps.push_back(id);
    }
    places_.push_back(std::move(seen));
  }
  for (const auto floor : floorsOf(view)) addFloor(view, floor);
  std::erase_if(places_, [](const SeenPlace& place) { return place.submaps.empty() && place.area == 0.0; });
}

void PlaceMap::addFloor(const MapView& view, std::optional<int> floor) {
  const auto grid = fuseGrids(view, floor);
  resolution_ = grid.resolution();
  auto cells = freeCells(grid);
  for (const auto& entity : view.entities()) {
    const auto* const door = std::get_if<Door>(&entity.attributes);
    const auto& submap = view.graph().getNode(entity.submap);
    if (door == nullptr || entity.confidence <= 0.0 || !isOnFloor(submap, floor)) continue;
    drawDoor(cells, geometry::toPose2(submap.T_map_submap * entity.T_submap_entity), door->width, resolution_);
  }

  const double cellArea = resolution_ * resolution_;
  Numbers numbers(cells.box(), kNowhere);
  const auto claim = [&](const geometry::Piece& piece, int number) {
    for (const auto cell : piece) *numbers.find(cell) = number;
    places_[static_cast<std::size_t>(number)].area += static_cast<double>(piece.size()) * cellArea;
  };
  for (std::size_t number = 0; number < places_.size(); ++number) {
    for (const auto id : places_[number].submaps) {
      const auto& node = view.graph().getNode(id);
      if (!isOnFloor(node, floor)) continue;
      const auto& origin = node.T_map_submap.translation();
      const auto start = geometry::cellAt(origin.x(), origin.y(), resolution_);
      claim(geometry::takePiece(cells, start), static_cast<int>(number));
    }
  }
  for (const auto& piece : geometry::piecesOf(cells)) {
    if (static_cast<double>(piece.size()) * cellArea < kLeastPlace) break;  // they come by size
    places_.push_back({.number = static_cast<int>(places_.size()), .floor = floor, .submaps = {}});
    claim(piece, places_.back().number);
  }
  floors_.emplace(floor, std::move(numbers));
}

std::optional<int> PlaceMap::placeAt(const Eigen::Vector2d& point_in_map, std::optional<int> floor) const {
  if (!point_in_map.allFinite() || point_in_map.cwiseAbs().maxCoeff() > 1e6) return std::nullopt;
  const auto cell = geometry::cellAt(point_in_map.x(), point_in_map.y(), resolution_);
  for (const auto& [number, cells] : floors_) {
    if (floor && number && number != floor) continue;
    if (const auto place = cells.at(cell); place != kNowhere) return place;
  }
  return std::nullopt;
}

}  // namespace prodomos::map

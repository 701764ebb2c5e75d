// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/observed_places.hpp"

#include "prodomos/evaluation/statistics.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace prodomos::evaluation {

namespace {

using geometry::CellBox;
using geometry::CellIndex;

// What a cell is that belongs to no place.
constexpr std::int32_t kUnseen = -1;
constexpr std::int32_t kWall = -2;  // or an opening
constexpr std::int32_t kFree = -3;

constexpr int kClearance = 3;          // cells on either side: walls of a grid have holes that nobody walks through
constexpr double kOpeningDepth = 0.1;  // metres to either side of a leaf that are drawn as wall
constexpr double kStepInside = 0.7;    // metres from a leaf: who stands there is inside

std::array<CellIndex, 4> neighbours(CellIndex cell) {
  return {{{cell.x + 1, cell.y}, {cell.x - 1, cell.y}, {cell.x, cell.y + 1}, {cell.x, cell.y - 1}}};
}

CellBox grown(const CellBox& box, int by) {
  return {{box.first.x - by, box.first.y - by}, {box.last.x + by, box.last.y + by}};
}

}  // namespace

ObservedPlaces::ObservedPlaces(const KnownSpace& known, const std::vector<ClaimedDoor>& openings) {
  for (const int storey : known.storeys()) {
    auto& labels = labelsOfStorey_[storey] = drawn(known, storey, openings);
    label(storey, labels);
  }
}

/// What was seen, with the openings as walls.
ObservedPlaces::Labels ObservedPlaces::drawn(const KnownSpace& known, int storey,
                                             const std::vector<ClaimedDoor>& openings) {
  Labels labels(known.box(storey), kUnseen);
  visitCells(labels.box(), [&](CellIndex cell) {
    const auto state = known.state(storey, cell);
    if (state != map::CellState::kUnknown) *labels.find(cell) = state == map::CellState::kFree ? kFree : kWall;
  });
  for (const auto& opening : openings) {
    if (opening.storey != storey) continue;
    const double half = opening.door.width / 2.0;
    labels.fill(boxBehind(opening.T_world_door, half, -half, -kOpeningDepth, kOpeningDepth), kWall);
  }
  return labels;
}

/// What has room around it hangs together; then each place takes the free cells along its walls.
void ObservedPlaces::label(int storey, Labels& labels) {
  geometry::CellSet wide(labels.box(), 0);
  visitCells(labels.box(), [&](CellIndex cell) { *wide.find(cell) = labels.at(cell) == kFree ? 1 : 0; });
  visitCells(labels.box(), [&](CellIndex cell) {
    if (labels.at(cell) != kWall) return;
    visitCells(grown({cell, cell}, kClearance), [&](CellIndex near) {
      if (auto* const found = wide.find(near)) *found = 0;
    });
  });
  std::vector<CellIndex> border;
  visitCells(wide.box(), [&](CellIndex start) {
    if (wide.at(start) == 0) return;
    const auto number = static_cast<std::int32_t>(places_.size());
    places_.push_back({.storey = storey});
    for (const auto cell : geometry::takePiece(wide, start)) {
      *labels.find(cell) = number;
      border.push_back(cell);
    }
  });
  for (int step = 0; step < 2 * kClearance; ++step) {  // into corners, too
    for (const auto cell : std::exchange(border, {})) {
      for (const auto next : neighbours(cell)) {
        auto* const found = labels.find(next);
        if (found == nullptr || *found != kFree) continue;
        *found = labels.at(cell);
        border.push_back(next);
      }
    }
  }
  visitCells(labels.box(), [&](CellIndex cell) {
    if (labels.at(cell) < 0) return;
    auto& place = places_[static_cast<std::size_t>(labels.at(cell))];
    place.box.add(cell);
    ++place.cells;
  });
}

std::optional<std::size_t> ObservedPlaces::at(int storey, const Eigen::Vector2d& spot_in_world) const {
  const auto labels = labelsOfStorey_.find(storey);
  if (labels == labelsOfStorey_.end()) return std::nullopt;
  const auto label = labels->second.at(geometry::cellAt(spot_in_world.x(), spot_in_world.y(), kCell));
  if (label < 0) return std::nullopt;
  return static_cast<std::size_t>(label);
}

/// That of most cells where one steps in.
std::optional<std::size_t> ObservedPlaces::beside(const ClaimedDoor& opening, double side) const {
  const double half = opening.door.width / 2.0;
  const auto step = boxBehind(opening.T_world_door, half, -half, side * kOpeningDepth, side * kStepInside);
  std::map<std::size_t, std::size_t> cells;
  for (const auto cell : cellsIn(step)) {
    if (const auto place = at(opening.storey, centreOf(cell))) ++cells[*place];
  }
  const auto most = std::ranges::max_element(cells, {}, [](const auto& entry) { return entry.second; });
  if (most == cells.end()) return std::nullopt;
  return most->first;
}

double ObservedPlaces::area(std::size_t place) const {
  return static_cast<double>(places_.at(place).cells) * kCell * kCell;
}

ObservedPlaces::Room ObservedPlaces::room(std::size_t place) const {
  const auto& labels = labelsOfStorey_.at(places_.at(place).storey);
  Room room{.cells = {grown(places_[place].box, 1), 0}};
  auto& cells = room.cells;
  const auto isOf = [&](CellIndex cell) { return labels.at(cell) == static_cast<std::int32_t>(place); };
  visitCells(cells.box(), [&](CellIndex cell) { *cells.find(cell) = isOf(cell) ? 0 : 1; });
  geometry::takePiece(cells, cells.box().first);  // all around the room is outside; what is left stands within
  visitCells(cells.box(), [&](CellIndex cell) {
    if (labels.at(cell) >= 0) *cells.find(cell) = isOf(cell) ? 1 : 0;
  });
  std::size_t walls = 0;
  std::size_t open = 0;
  visitCells(cells.box(), [&](CellIndex cell) {
    if (cells.at(cell) == 0) return;
    for (const auto next : neighbours(cell)) {
      if (cells.at(next) != 0) continue;
      if (labels.at(next) == kWall) ++walls;
      if (labels.at(next) == kUnseen) ++open;
    }
  });
  room.enclosed = shareOf(walls, walls + open).value_or(0.0);
  return room;
}

}  // namespace prodomos::evaluation

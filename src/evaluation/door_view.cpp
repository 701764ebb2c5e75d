// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/door_view.hpp"

#include <algorithm>
#include <cmath>

namespace prodomos::evaluation {

namespace {

constexpr double kReach = kRadiusSteps * kRadiusStep;
constexpr double kDoorHalf = 0.45;  // metres, of a door's width: where one may step in
constexpr double kThreshold = 0.5;  // metres ahead of the door: what begins no farther hangs together with it
constexpr double kCoarse = 0.25;    // metres, of the first search for the best box

geometry::CellBox boxAhead(double resolution) {
  const int reach = static_cast<int>(kReach / resolution);
  return {{0, -reach}, {reach - 1, reach - 1}};
}

}  // namespace

DoorView::DoorView(const geometry::Pose2& T_world_door, double resolution)
    : T_door_world_(geometry::inverse(T_world_door)),
      resolution_(resolution),
      room_(boxAhead(resolution), 0),
      known_(boxAhead(resolution), 0) {}

DoorView::DoorView(const geometry::Pose2& T_world_door, const Polygon& room_in_world,
                   const std::function<bool(const Eigen::Vector2d&)>& isKnown, double resolution)
    : DoorView(T_world_door, resolution) {
  const auto roomCells = cellsIn(transformed(T_door_world_, room_in_world), resolution);
  roomArea_ = static_cast<double>(roomCells.size()) * resolution * resolution;
  for (const auto cell : roomCells) {
    if (auto* inRoom = room_.find(cell)) *inRoom = 1;
  }
  survey(T_world_door, isKnown);
}

DoorView::DoorView(const geometry::Pose2& T_world_door, const CellMap<std::uint8_t>& room_in_world,
                   const std::function<bool(const Eigen::Vector2d&)>& isKnown)
    : DoorView(T_world_door, kCell) {
  visitCells(room_in_world.box(), [&](geometry::CellIndex cell) {
    if (room_in_world.at(cell) != 0) roomArea_ += kCell * kCell;
  });
  visitCells(room_.box(), [&](geometry::CellIndex cell) {
    const Eigen::Vector2d centre_in_world = T_world_door * centreOf(cell);
    const auto cell_in_world = geometry::cellAt(centre_in_world.x(), centre_in_world.y(), kCell);
    *room_.find(cell) = room_in_world.at(cell_in_world) != 0 ? 1 : 0;
  });
  survey(T_world_door, isKnown);
}

/// What is known, and the integral image of the room.
void DoorView::survey(const geometry::Pose2& T_world_door, const std::function<bool(const Eigen::Vector2d&)>& isKnown) {
  const auto& box = room_.box();
  const auto width = static_cast<std::size_t>(box.width()) + 1;
  roomBelow_.assign(width * (static_cast<std::size_t>(box.height()) + 1), 0);
  std::size_t place = width;
  for (int y = box.first.y; y <= box.last.y; ++y) {
    std::int32_t inRow = 0;
    ++place;
    for (int x = box.first.x; x <= box.last.x; ++x, ++place) {
      inRow += room_.at({x, y});
      roomBelow_[place] = roomBelow_[place - width] + inRow;
      *known_.find({x, y}) = isKnown(T_world_door * centreOf({x, y}, resolution_)) ? 1 : 0;
    }
  }
}

double DoorView::iouOf(double cellsInBoth, double cellsInShape) const {
  const double inEither = cellsInShape + roomArea_ / (resolution_ * resolution_) - cellsInBoth;
  return inEither > 0.0 ? cellsInBoth / inEither : 0.0;
}

geometry::CellBox DoorView::cellsOf(const DoorBox& box) const {
  const auto edge = [this](double metres) { return static_cast<int>(std::lround(metres / resolution_)); };
  return {{edge(kWallHalf), -edge(box.right)}, {edge(box.depth) - 1, edge(box.left) - 1}};
}

double DoorView::roomCells(const geometry::CellBox& box) const {
  if (box.empty()) return 0.0;
  const auto& all = room_.box();
  const auto below = [&](int x, int y) {
    const auto column = static_cast<std::size_t>(std::clamp(x - all.first.x, 0, all.width()));
    const auto row = static_cast<std::size_t>(std::clamp(y - all.first.y, 0, all.height()));
    return roomBelow_[row * (static_cast<std::size_t>(all.width()) + 1) + column];
  };
  return below(box.last.x + 1, box.last.y + 1) - below(box.first.x, box.last.y + 1) -
         below(box.last.x + 1, box.first.y) + below(box.first.x, box.first.y);
}

double DoorView::iou(const Polygon& shape_in_world) const {
  const auto cells = cellsIn(transformed(T_door_world_, shape_in_world), resolution_);
  const auto shared = std::ranges::count_if(cells, [this](auto cell) { return room_.at(cell) != 0; });
  return iouOf(static_cast<double>(shared), static_cast<double>(cells.size()));
}

double DoorView::iou(const DoorBox& box) const {
  const auto cells = cellsOf(box);
  if (cells.empty()) return 0.0;
  return iouOf(roomCells(cells), static_cast<double>(cells.width()) * cells.height());
}

double DoorView::iouClipped(const DoorBox& box) const {
  const auto cells = cellsOf(box);
  if (cells.empty()) return 0.0;
  CellMap<std::uint8_t> isOpen(cells, 0);   // not known, and not reached yet
  std::vector<geometry::CellIndex> border;  // reached, but not their neighbours
  const auto reach = [&](geometry::CellIndex cell) {
    auto* open = isOpen.find(cell);
    if (open == nullptr || *open == 0) return;
    *open = 0;
    border.push_back(cell);
  };
  for (int y = cells.first.y; y <= cells.last.y; ++y) {
    for (int x = cells.first.x; x <= cells.last.x; ++x) *isOpen.find({x, y}) = known_.at({x, y}) == 0 ? 1 : 0;
  }
  const auto start = cellsOf({kDoorHalf, kDoorHalf, kThreshold});
  for (int y = start.first.y; y <= start.last.y; ++y) {
    for (int x = start.first.x; x <= start.last.x; ++x) reach({x, y});
  }
  double shared = 0.0;
  double kept = 0.0;
  while (!border.empty()) {
    const auto cell = border.back();
    border.pop_back();
    kept += 1.0;
    shared += room_.at(cell);
    reach({cell.x + 1, cell.y});
    reach({cell.x - 1, cell.y});
    reach({cell.x, cell.y + 1});
    reach({cell.x, cell.y - 1});
  }
  return iouOf(shared, kept);
}

ByRadius DoorView::iousOfHalfDiscs() const {
  ByRadius shared{};
  ByRadius inShape{};
  const auto& box = room_.box();
  for (int x = cellsOf({0.0, 0.0, kReach}).first.x; x <= box.last.x; ++x) {
    for (int y = box.first.y; y <= box.last.y; ++y) {
      const auto radius = radiusIndex(centreOf({x, y}, resolution_).norm());
      if (radius >= kRadiusSteps) continue;
      shared[radius] += room_.at({x, y});
      inShape[radius] += 1.0;
    }
  }
  accumulate(shared);
  accumulate(inShape);
  ByRadius ious{};
  for (std::size_t i = 0; i < kRadiusSteps; ++i) ious[i] = iouOf(shared[i], inShape[i]);
  return ious;
}

DoorBox DoorView::bestBox() const {
  DoorBox best{kCoarse, kCoarse, 2 * kCoarse};
  double greatest = iou(best);
  const auto consider = [&](const DoorBox& box) {
    const double value = iou(box);
    if (value <= greatest) return false;
    greatest = value;
    best = box;
    return true;
  };
  for (double left = 0.0; left < kReach; left += kCoarse) {
    for (double right = 0.0; right < kReach; right += kCoarse) {
      for (double depth = 2 * kCoarse; depth < kReach; depth += kCoarse) consider({left, right, depth});
    }
  }
  for (bool better = true; better;) {
    better = false;
    for (const double step : {resolution_, -resolution_}) {
      better |= consider({best.left + step, best.right, best.depth});
      better |= consider({best.left, best.right + step, best.depth});
      better |= consider({best.left, best.right, best.depth + step});
    }
  }
  return best;
}

}  // namespace prodomos::evaluation

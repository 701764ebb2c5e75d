// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/navigation.hpp"

#include "simulation/shell/openings.hpp"
#include "simulation/shell/shell_parts.hpp"
#include "simulation/ways/distance_field.hpp"
#include "simulation/ways/passing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <numbers>
#include <queue>
#include <tuple>
#include <utility>

namespace prodomos::simulation {

namespace {

using geometry::CellIndex;

/// A robot or a person passes below what hangs higher than this, metres.
constexpr double kHeadroom = 1.8;
/// What is lower is driven over: carpets, thresholds.
constexpr double kThreshold = 0.03;

/// Nearer than this beyond its clearance, being near a wall has a price.
constexpr double kComfort = 0.6;
constexpr float kPriceAtWall = 4.0;
constexpr float kPriceOfSwing = 4.0;

constexpr std::array<CellIndex, 8> kSteps{{{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

constexpr float kDiagonal = std::numbers::sqrt2_v<float>;
constexpr std::array kStepLengths{1.0F, kDiagonal, 1.0F, kDiagonal, 1.0F, kDiagonal, 1.0F, kDiagonal};
constexpr float kInfinite = std::numeric_limits<float>::infinity();

/// The least number of cells between two, straight and diagonal steps.
float octile(CellIndex a, CellIndex b) {
  const auto [least, most] = std::minmax({std::abs(a.x - b.x), std::abs(a.y - b.y)});
  return static_cast<float>(most) + (kDiagonal - 1.0F) * static_cast<float>(least);
}

/// What a search knows of the cells it has come to; tiles, so that a short way in a large building costs little.
class Reached {
 public:
  struct Entry {
    float price = kInfinite;
    std::uint8_t step = 0;  ///< of kSteps, that led here
    bool settled = false;
  };

  Reached(int width, int height) : columns_(tileOf(width) + 1), tiles_(columns_ * (tileOf(height) + 1)) {}

  Entry& operator[](CellIndex cell) {
    auto& tile = tiles_[tileOf(cell.y) * columns_ + tileOf(cell.x)];
    if (!tile) tile = std::make_unique<Tile>();
    return (*tile)[inTile(cell.y) * kSide + inTile(cell.x)];
  }

 private:
  static constexpr std::size_t kSide = 64;
  using Tile = std::array<Entry, kSide * kSide>;

  static std::size_t tileOf(int index) { return static_cast<std::size_t>(index) / kSide; }
  static std::size_t inTile(int index) { return static_cast<std::size_t>(index) % kSide; }

  std::size_t columns_;
  std::vector<std::unique_ptr<Tile>> tiles_;
};

Polygon rectangle(const Eigen::Vector2d& middle, double direction, double length, double width) {
  const Eigen::Vector2d along = length / 2.0 * Eigen::Vector2d(std::cos(direction), std::sin(direction));
  const Eigen::Vector2d across = width / 2.0 * Eigen::Vector2d(-std::sin(direction), std::cos(direction));
  return {middle - along - across, middle + along - across, middle + along + across, middle - along + across};
}

Eigen::AlignedBox2d boxOf(const Polygon& polygon) {
  Eigen::AlignedBox2d box;
  for (const auto& corner : polygon) box.extend(corner);
  return box;
}

/// At most `stride` from each other, the first and the last as they are.
Polyline resampled(const Polyline& way, double stride) {
  Polyline points{way.front()};
  for (std::size_t i = 1; i < way.size(); ++i) {
    const int pieces = std::max(1, static_cast<int>(std::ceil((way[i] - way[i - 1]).norm() / stride)));
    for (int k = 1; k <= pieces; ++k) points.push_back(way[i - 1] + (way[i] - way[i - 1]) * k / pieces);
  }
  return points;
}

}  // namespace

bool anyDoor(std::size_t /*door*/) {
  return true;
}

FloorGrid::FloorGrid(const Building& building, int storey, double clearance, double resolution)
    : storey_(storey),
      clearance_(clearance),
      resolution_(resolution),
      firstDoor_(static_cast<std::int32_t>(building.rooms.size())) {
  Eigen::AlignedBox2d box;
  for (const auto& room : building.rooms) {
    boxes_.push_back(boxOf(room.outline));
    if (room.storey == storey) box.extend(boxes_.back());
  }
  if (box.isEmpty()) return;
  // A rim of wall, so that whatever is measured from a free cell ends within the grid.
  const Eigen::Vector2d rim = Eigen::Vector2d::Constant(2.0 * resolution);
  origin_ = box.min() - rim;
  const Eigen::Vector2d cells = (box.sizes() + 2.0 * rim) / resolution;
  width_ = static_cast<int>(std::ceil(cells.x()));
  height_ = static_cast<int>(std::ceil(cells.y()));
  areas_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), kWall);
  prices_.assign(areas_.size(), 1.0F);
  drawRooms(building);
  drawDoors(building);
  drawThings(building);
  drawStairs(building);
  drawLeaves(building);
  distances_ = distancesTo(width_, height_, [&](std::size_t cell) { return areas_[cell] == kWall; });
  setPrices();
}

bool FloorGrid::isFree(const Eigen::Vector2d& point) const {
  return isFree(cellAt(point), anyDoor);
}

double FloorGrid::distanceToWalls(const Eigen::Vector2d& point) const {
  const Cell cell = cellAt(point);
  return inside(cell) ? distanceAt(cell) : 0.0;
}

int FloorGrid::roomAt(const Eigen::Vector2d& point) const {
  const Cell cell = cellAt(point);
  if (!inside(cell)) return kOutside;
  const auto area = areas_[index(cell)];
  return area == kWall || area >= firstDoor_ ? kOutside : area;
}

std::optional<std::size_t> FloorGrid::doorAt(const Eigen::Vector2d& point) const {
  const Cell cell = cellAt(point);
  if (!inside(cell) || areas_[index(cell)] < firstDoor_) return std::nullopt;
  return static_cast<std::size_t>(areas_[index(cell)] - firstDoor_);
}

std::optional<Eigen::Vector2d> FloorGrid::nearestFree(const Eigen::Vector2d& point, double within) const {
  if (isFree(point)) return point;
  const Cell middle = cellAt(point);
  const int reach = static_cast<int>(std::ceil(within / resolution_));
  std::optional<Eigen::Vector2d> nearest;
  double least = within;
  for (int y = middle.y - reach; y <= middle.y + reach; ++y) {
    for (int x = middle.x - reach; x <= middle.x + reach; ++x) {
      if (!isFree(Cell{x, y}, anyDoor)) continue;
      const double distance = (centre({x, y}) - point).norm();
      if (distance >= least) continue;
      least = distance;
      nearest = centre({x, y});
    }
  }
  return nearest;
}

bool FloorGrid::isFreeLine(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const DoorFilter& mayPass) const {
  return priceOfLine(a, b, mayPass).has_value();
}

std::optional<Polyline> FloorGrid::path(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                        const DoorFilter& mayPass) const {
  if (!isFree(from) || !isFree(cellAt(to), mayPass)) return std::nullopt;
  const auto cells = cheapestCells(cellAt(from), cellAt(to), mayPass);
  if (cells.empty()) return std::nullopt;
  Polyline way;
  for (const Cell cell : cells) way.push_back(centre(cell));
  way.front() = from;
  way.back() = to;
  if (way.size() == 1) way = {from, to};
  return smoothed(resampled(pulledTight(way, mayPass), kStride), mayPass);
}

std::vector<Eigen::Vector2d> FloorGrid::spots(int room, double spacing) const {
  constexpr double kRoomy = 0.8;
  std::vector<Eigen::Vector2d> chosen;
  for (const Cell cell : roomiestFirst(room)) {
    const Eigen::Vector2d point = centre(cell);
    const auto isNear = [&](const Eigen::Vector2d& spot) { return (spot - point).norm() < spacing; };
    // What is left along the walls between two spots is seen from both.
    const auto seesAside = [&](const Eigen::Vector2d& spot) {
      return (spot - point).norm() < 2.0 * spacing && distanceToWalls(point) < kRoomy * distanceToWalls(spot) &&
             isFreeLine(spot, point);
    };
    if (std::ranges::none_of(chosen, isNear) && std::ranges::none_of(chosen, seesAside)) chosen.push_back(point);
  }
  return chosen;
}

/// Free cells of a room, those before its doors only where there are no others.
std::vector<FloorGrid::Cell> FloorGrid::roomiestFirst(int room) const {
  constexpr double kBeforeDoor = 0.8;  // metres
  const auto& box = boxes_[static_cast<std::size_t>(room)];
  const Cell first = cellAt(box.min());
  const Cell last = cellAt(box.max());
  std::vector<Eigen::Vector2d> doors;
  const auto isNear = [&](const Eigen::Vector2d& door) { return box.exteriorDistance(door) < kBeforeDoor; };
  std::ranges::copy_if(doors_, std::back_inserter(doors), isNear);
  using Candidate = std::tuple<bool, float, Cell>;
  std::vector<Candidate> candidates;
  // A few cells are enough to choose from.
  constexpr int kEvery = 3;
  for (int y = first.y; y <= last.y; y += kEvery) {
    for (int x = first.x; x <= last.x; x += kEvery) {
      const Cell cell{x, y};
      if (!isFree(cell, anyDoor) || areas_[index(cell)] != room) continue;
      const bool isBeforeDoor = std::ranges::any_of(
          doors, [&](const auto& door) { return (door - centre(cell)).squaredNorm() < kBeforeDoor * kBeforeDoor; });
      candidates.emplace_back(isBeforeDoor, -distances_[index(cell)], cell);
    }
  }
  std::ranges::sort(candidates);
  const bool isAllBeforeDoors = !candidates.empty() && std::get<bool>(candidates.front());
  std::vector<Cell> cells;
  for (const auto& [isBeforeDoor, negativeDistance, cell] : candidates) {
    if (isBeforeDoor == isAllBeforeDoors) cells.push_back(cell);
  }
  return cells;
}

void FloorGrid::drawRooms(const Building& building) {
  for (std::size_t i = 0; i < building.rooms.size(); ++i) {
    if (building.rooms[i].storey == storey_) fill(building.rooms[i].outline, static_cast<std::int32_t>(i));
  }
  for (const auto& room : building.rooms) {
    if (room.storey != storey_) continue;
    for (std::size_t i = 0; i < room.outline.size(); ++i) {
      if (isSlit(room.outline, i)) continue;
      drawWall(room.outline[i], room.outline[(i + 1) % room.outline.size()]);
    }
  }
}

void FloorGrid::drawDoors(const Building& building) {
  for (std::size_t i = 0; i < building.doors.size(); ++i) {
    const auto& door = building.doors[i];
    if (door.storey != storey_ || !canBePassed(building, door)) continue;
    doors_.emplace_back(door.pose.x, door.pose.y);
    // From face to face, and the cells of the faces, which count as wall.
    const double back = std::ranges::min(faceOf(building, door, 0)) - 1.5 * resolution_;
    const double front = std::ranges::max(faceOf(building, door, 1)) + 1.5 * resolution_;
    const Eigen::Vector2d middle = door.pose * Eigen::Vector2d((back + front) / 2.0, 0.0);
    fill(rectangle(middle, door.pose.theta, front - back, door.width), firstDoor_ + static_cast<std::int32_t>(i));
  }
}

void FloorGrid::drawThings(const Building& building) {
  const double floorHeight = building.storeys[static_cast<std::size_t>(storey_)].floor_z;
  for (const auto& thing : building.things) {
    if (thing.storey != storey_) continue;
    const Eigen::Vector3d middle = thing.T_world_thing.translation();
    const double halfHeight = (thing.T_world_thing.linear().row(2).cwiseAbs() * thing.size / 2.0).value();
    const double bottom = middle.z() - halfHeight - floorHeight;
    const double top = middle.z() + halfHeight - floorHeight;
    if (bottom > kHeadroom || top < kThreshold) continue;
    fill(rectangle(middle.head<2>(), geometry::yaw(thing.T_world_thing), thing.size.x(), thing.size.y()), kWall);
  }
}

void FloorGrid::drawStairs(const Building& building) {
  for (const auto& stairs : building.stairs) {
    if (stairs.lowerStorey != storey_ && stairs.upperStorey != storey_) continue;
    fill(footprintOf(stairs), kWall);
  }
  for (const auto& landing : building.landings) {
    if (landing.lowerStorey == storey_ || landing.lowerStorey + 1 == storey_) fill(landing.outline, kWall);
  }
}

void FloorGrid::drawLeaves(const Building& building) {
  constexpr double kAjar = 5.0 * std::numbers::pi / 180.0;
  constexpr double kWide = 60.0 * std::numbers::pi / 180.0;
  for (const auto& door : building.doors) {
    if (door.storey != storey_) continue;
    const double rests = leastAngle(door);
    const double passed = std::max(rests, passingAngle(building, door));
    for (const auto& [hinge, edge] : leafLines(building, door, passed)) {
      if (rests > kWide) {
        drawWall(hinge, edge);
      } else {
        drawSwing(hinge, edge);
      }
    }
    if (rests < kAjar || rests > kWide) continue;
    for (const auto& [hinge, edge] : leafLines(building, door, rests)) drawSwing(hinge, edge);
  }
}

void FloorGrid::fill(const Polygon& polygon, std::int32_t area) {
  const auto box = boxOf(polygon);
  const int first = std::max(0, cellAt(box.min()).y);
  const int last = std::min(height_ - 1, cellAt(box.max()).y);
  std::vector<double> crossings;
  for (int y = first; y <= last; ++y) {
    const double level = centre({0, y}).y();
    crossings.clear();
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
      const auto& a = polygon[i];
      const auto& b = polygon[j];
      if ((a.y() > level) == (b.y() > level)) continue;
      crossings.push_back(a.x() + (level - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
    std::ranges::sort(crossings);
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const auto column = [&](double x) { return static_cast<int>(std::ceil((x - origin_.x()) / resolution_ - 0.5)); };
      const int begin = std::max(0, column(crossings[i]));
      const int end = std::min(width_, column(crossings[i + 1]));
      for (int x = begin; x < end; ++x) areas_[index({x, y})] = area;
    }
  }
}

void FloorGrid::drawWall(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const int pieces = 1 + static_cast<int>(4.0 * (b - a).norm() / resolution_);
  for (int i = 0; i <= pieces; ++i) {
    const Cell cell = cellAt(a + (b - a) * i / pieces);
    if (inside(cell)) areas_[index(cell)] = kWall;
  }
}

void FloorGrid::drawSwing(const Eigen::Vector2d& hinge, const Eigen::Vector2d& edge) {
  const Eigen::Vector2d leaf = edge - hinge;
  const int reach = static_cast<int>(std::ceil((leaf.norm() + clearance_) / resolution_));
  const Cell middle = cellAt(hinge);
  for (int y = middle.y - reach; y <= middle.y + reach; ++y) {
    for (int x = middle.x - reach; x <= middle.x + reach; ++x) {
      if (!inside({x, y})) continue;
      const Eigen::Vector2d point = centre({x, y});
      const double share = std::clamp((point - hinge).dot(leaf) / leaf.squaredNorm(), 0.0, 1.0);
      if ((hinge + share * leaf - point).norm() < clearance_) prices_[index({x, y})] = 1.0F + kPriceOfSwing;
    }
  }
}

FloorGrid::Cell FloorGrid::cellAt(const Eigen::Vector2d& point) const {
  return geometry::cellAt(point.x() - origin_.x(), point.y() - origin_.y(), resolution_);
}

Eigen::Vector2d FloorGrid::centre(Cell cell) const {
  return origin_ +
         Eigen::Vector2d(geometry::cellCentre(cell.x, resolution_), geometry::cellCentre(cell.y, resolution_));
}

double FloorGrid::distanceAt(Cell cell) const {
  // Half a cell for a point's place in its cell, half a cell for the wall's in another.
  return std::max(0.0, (static_cast<double>(distances_[index(cell)]) - 1.0) * resolution_);
}

/// Of being near a wall, and infinite where the body would touch it.
void FloorGrid::setPrices() {
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const double room = distanceAt({x, y}) - clearance_;
      const auto crowding = static_cast<float>(std::max(0.0, 1.0 - room / kComfort));
      prices_[index({x, y})] += room < 0.0 ? kInfinite : kPriceAtWall * crowding * crowding;
    }
  }
}

bool FloorGrid::isFree(Cell cell, const DoorFilter& mayPass) const {
  if (!inside(cell) || prices_[index(cell)] == kInfinite) return false;
  const auto area = areas_[index(cell)];
  return area < firstDoor_ || mayPass(static_cast<std::size_t>(area - firstDoor_));
}

std::optional<double> FloorGrid::priceOfLine(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                             const DoorFilter& mayPass) const {
  const int pieces = 1 + static_cast<int>(2.0 * (b - a).norm() / resolution_);
  double sum = 0.0;
  for (int i = 0; i <= pieces; ++i) {
    const Cell cell = cellAt(a + (b - a) * i / pieces);
    if (!isFree(cell, mayPass)) return std::nullopt;
    if (i > 0) sum += static_cast<double>(prices_[index(cell)]);
  }
  return sum / pieces * (b - a).norm();
}

/// A*.
std::vector<FloorGrid::Cell> FloorGrid::cheapestCells(Cell from, Cell to, const DoorFilter& mayPass) const {
  using Waiting = std::tuple<float, Cell>;
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> queue;
  Reached reached(width_, height_);
  reached[from].price = 0.0F;
  queue.emplace(0.0F, from);
  while (!queue.empty()) {
    const Cell cell = std::get<Cell>(queue.top());
    queue.pop();
    auto& here = reached[cell];
    if (here.settled) continue;
    here.settled = true;
    if (cell == to) break;
    for (std::size_t step = 0; step < kSteps.size(); ++step) {
      const Cell next{cell.x + kSteps[step].x, cell.y + kSteps[step].y};
      if (!isFree(next, mayPass)) continue;
      auto& there = reached[next];
      const float price = here.price + kStepLengths[step] * prices_[index(next)];
      if (price >= there.price) continue;
      there = {.price = price, .step = static_cast<std::uint8_t>(step)};
      queue.emplace(price + octile(next, to), next);
    }
  }
  if (!reached[to].settled) return {};
  std::vector<Cell> cells{to};
  while (cells.back() != from) {
    const auto step = kSteps[reached[cells.back()].step];
    cells.push_back({cells.back().x - step.x, cells.back().y - step.y});
  }
  std::ranges::reverse(cells);
  return cells;
}

/// Leaves out points wherever the straight line is no dearer than the way it replaces.
Polyline FloorGrid::pulledTight(const Polyline& way, const DoorFilter& mayPass) const {
  std::vector<double> priceTo(way.size(), 0.0);
  for (std::size_t i = 1; i < way.size(); ++i) {
    priceTo[i] = priceTo[i - 1] + priceOfLine(way[i - 1], way[i], mayPass).value_or(0.0);
  }
  constexpr double kTolerance = 1e-6;
  Polyline tight{way.front()};
  for (std::size_t i = 0, next = 1; next < way.size(); i = next++) {
    for (std::size_t j = next + 1; j < way.size(); ++j) {
      const auto price = priceOfLine(way[i], way[j], mayPass);
      if (!price || *price > priceTo[j] - priceTo[i] + kTolerance) break;
      next = j;
    }
    tight.push_back(way[next]);
  }
  return tight;
}

/// Moves each point towards the middle of its neighbours, as long as that brings it no nearer to a wall than is
/// comfortable.
Polyline FloorGrid::smoothed(Polyline way, const DoorFilter& mayPass) const {
  constexpr int kRounds = 40;
  constexpr double kRoomy = 0.25;  // beyond the clearance, metres
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 1; i + 1 < way.size(); ++i) {
      const Eigen::Vector2d moved = way[i] / 2.0 + (way[i - 1] + way[i + 1]) / 4.0;
      if (distanceToWalls(moved) < std::min(distanceToWalls(way[i]), clearance_ + kRoomy)) continue;
      if (isFreeLine(way[i - 1], moved, mayPass) && isFreeLine(moved, way[i + 1], mayPass)) way[i] = moved;
    }
  }
  return way;
}

}  // namespace prodomos::simulation

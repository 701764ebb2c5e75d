// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/grid_index.hpp"
#include "prodomos/simulation/building.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace prodomos::simulation {

using Polyline = std::vector<Eigen::Vector2d>;

/// May a body pass this door? By index into Building::doors.
using DoorFilter = std::function<bool(std::size_t door)>;
bool anyDoor(std::size_t door);

/// Where on a storey the middle of a round body may be: in rooms and openings, off walls, off things that stand or hang
/// below 1.8 m, off flights of stairs, off leaves that always stand open. Frame `world`, metres.
class FloorGrid {
 public:
  /// The body keeps `clearance` from all that (its radius and some reserve); cells have sides of `resolution`.
  FloorGrid(const Building& building, int storey, double clearance, double resolution = 0.05);

  int storey() const { return storey_; }
  bool isFree(const Eigen::Vector2d& point) const;
  /// Distance to the nearest wall or thing, less what the cells leave open; 0 where nothing can stand.
  double distanceToWalls(const Eigen::Vector2d& point) const;
  /// Index of the room, or kOutside; a point in a door's opening is in no room.
  int roomAt(const Eigen::Vector2d& point) const;
  /// The door in whose opening the point lies.
  std::optional<std::size_t> doorAt(const Eigen::Vector2d& point) const;
  std::optional<Eigen::Vector2d> nearestFree(const Eigen::Vector2d& point, double within) const;

  /// Can the body go straight from a to b?
  bool isFreeLine(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const DoorFilter& mayPass = anyDoor) const;

  /// A smooth way that rather keeps its distance from walls, at most `kStride` between its points, beginning and ending
  /// with the two given; none where there is no way, or one of them is not free.
  std::optional<Polyline> path(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                               const DoorFilter& mayPass = anyDoor) const;
  static constexpr double kStride = 0.15;

  /// Free points of a room, the roomiest first, at least `spacing` from each other and rather not before doors; any
  /// other is nearer than that to one of them, or seen from one within twice as much.
  std::vector<Eigen::Vector2d> spots(int room, double spacing) const;

 private:
  using Cell = geometry::CellIndex;

  void drawRooms(const Building& building);
  void drawDoors(const Building& building);
  void drawThings(const Building& building);
  void drawStairs(const Building& building);
  void drawLeaves(const Building& building);
  void fill(const Polygon& polygon, std::int32_t area);
  void drawWall(const Eigen::Vector2d& a, const Eigen::Vector2d& b);
  void setPrices();
  void drawSwing(const Eigen::Vector2d& hinge, const Eigen::Vector2d& edge);

  bool inside(Cell cell) const { return cell.x >= 0 && cell.y >= 0 && cell.x < width_ && cell.y < height_; }
  std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(cell.x);
  }
  Cell cellAt(const Eigen::Vector2d& point) const;
  Eigen::Vector2d centre(Cell cell) const;
  double distanceAt(Cell cell) const;
  std::vector<Cell> roomiestFirst(int room) const;
  bool isFree(Cell cell, const DoorFilter& mayPass) const;
  std::optional<double> priceOfLine(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                    const DoorFilter& mayPass) const;
  std::vector<Cell> cheapestCells(Cell from, Cell to, const DoorFilter& mayPass) const;
  Polyline pulledTight(const Polyline& way, const DoorFilter& mayPass) const;
  Polyline smoothed(Polyline way, const DoorFilter& mayPass) const;

  static constexpr std::int32_t kWall = -1;  ///< else the index of a room or, from firstDoor_ on, of a door

  int storey_;
  double clearance_;
  double resolution_;
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();  ///< corner of cell (0, 0)
  int width_ = 0;
  int height_ = 0;
  std::int32_t firstDoor_ = 0;
  std::vector<Eigen::AlignedBox2d> boxes_;  ///< by room
  std::vector<Eigen::Vector2d> doors_;      ///< the middles of all openings
  std::vector<std::int32_t> areas_;         ///< by cell
  std::vector<float> distances_;            ///< of a cell's middle to the nearest wall's, in cells
  std::vector<float> prices_;               ///< of a metre there; infinite where the body cannot be
};

}  // namespace prodomos::simulation

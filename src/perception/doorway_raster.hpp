// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/occupancy_grid.hpp"

#include <Eigen/Core>

#include <vector>

namespace prodomos::perception::doorways {

/// A grid turned so that walls of one direction lie along its rows. Cells are named (u, v), u along the wall; what lies
/// outside is unknown.
class Raster {
 public:
  /// `direction` of the rows in the grid's frame, radians.
  Raster(const map::OccupancyGrid& grid, double direction);
  /// Of a square alone: its middle in the grid's frame, and metres from there to its sides.
  Raster(const map::OccupancyGrid& grid, double direction, const Eigen::Vector2d& middle, double reach);

  /// The same with rows along what were columns.
  Raster turned() const;

  double direction() const { return direction_; }
  double step() const { return step_; }  ///< metres
  int width() const { return width_; }
  int height() const { return height_; }
  map::CellState at(int u, int v) const {
    if (u < 0 || v < 0 || u >= width_ || v >= height_) return map::CellState::kUnknown;
    return states_[index(u, v)];
  }
  bool isOccupied(int u, int v) const { return at(u, v) == map::CellState::kOccupied; }
  bool isFree(int u, int v) const { return at(u, v) == map::CellState::kFree; }

  /// Whole numbers are middles of cells.
  Eigen::Vector2d inSubmap(double u, double v) const { return origin_ + step_ * (u * along_ + v * across_); }
  Eigen::Vector2d inRaster(const Eigen::Vector2d& point_in_submap) const {
    const Eigen::Vector2d offset = (point_in_submap - origin_) / step_;
    return {offset.dot(along_), offset.dot(across_)};
  }

 private:
  Raster() = default;
  Raster(double direction, double step);
  void fill(const map::OccupancyGrid& grid);
  std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u);
  }

  double direction_ = 0.0;
  double step_ = 0.0;
  Eigen::Vector2d along_ = Eigen::Vector2d::UnitX();
  Eigen::Vector2d across_ = Eigen::Vector2d::UnitY();
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();  // middle of cell (0, 0)
  int width_ = 0;
  int height_ = 0;
  std::vector<map::CellState> states_;
};

/// The grid turned into the directions of its walls: at most `most`, that of the longest walls first. Walls across a
/// direction belong to it.
std::vector<Raster> rastersAlongWalls(const map::OccupancyGrid& grid, std::size_t most);

}  // namespace prodomos::perception::doorways

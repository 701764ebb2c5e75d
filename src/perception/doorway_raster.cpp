// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/doorway_raster.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prodomos::perception::doorways {

using map::CellState;

namespace {

constexpr double kQuarter = 0.5 * std::numbers::pi;
constexpr std::size_t kLeastWallCells = 30;  // a direction that explains fewer cells is chance
constexpr std::size_t kLeastShare = 20;      // … or less than one in so many
constexpr double kLeastWallLength = 0.5;     // metres

using Points = std::vector<Eigen::Vector2d>;

Points occupiedCells(const map::OccupancyGrid& grid) {
  Points points;
  const auto box = grid.knownBox();
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) {
      if (grid.state({x, y}) != CellState::kOccupied) continue;
      points.emplace_back(geometry::cellCentre(x, grid.resolution()), geometry::cellCentre(y, grid.resolution()));
    }
  }
  return points;
}

/// Counts of points in parallel strips, summed as squares: the more, the better points lie in lines of that direction.
class Strips {
 public:
  Strips(const Points& points, double width) : points_(points), width_(width) {
    double reach = 0.0;
    for (const auto& point : points) reach = std::max(reach, point.norm());
    half_ = static_cast<int>(reach / width) + 1;
  }

  double concentration(double direction) {
    return sumOfSquares(-std::sin(direction), std::cos(direction)) +
           sumOfSquares(std::cos(direction), std::sin(direction));
  }

 private:
  double sumOfSquares(double x, double y) {
    counts_.assign(2 * static_cast<std::size_t>(half_) + 1, 0);
    for (const auto& point : points_) {
      const double offset = (point.x() * x + point.y() * y) / width_ + half_ + 0.5;
      ++counts_[static_cast<std::size_t>(offset)];
    }
    double sum = 0.0;
    for (const int count : counts_) sum += static_cast<double>(count) * count;
    return sum;
  }

  const Points& points_;
  double width_;
  int half_ = 0;
  std::vector<int> counts_;
};

double sharpest(Strips& strips, double first, double step, int count) {
  double best = first;
  double most = -1.0;
  for (int i = 0; i < count; ++i) {
    const double direction = first + step * i;
    const double concentration = strips.concentration(direction);
    if (concentration <= most) continue;
    most = concentration;
    best = direction;
  }
  return best;
}

double mainDirection(const Points& points, double resolution) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  Strips coarse(points, 2.0 * resolution);
  const double rough = sharpest(coarse, 0.0, 2.0 * kDegree, 45);
  Strips fine(points, resolution);
  const double best = sharpest(fine, rough - 2.0 * kDegree, 0.25 * kDegree, 17);
  return best - kQuarter * std::floor(best / kQuarter);
}

/// Whether a cell is one of a wall along the raster's rows (or its columns).
bool isInWall(const Raster& raster, const Eigen::Vector2d& cell, bool alongRows) {
  const int u = static_cast<int>(std::lround(cell.x()));
  const int v = static_cast<int>(std::lround(cell.y()));
  const auto isWall = [&](int i) {
    for (int side = -1; side <= 1; ++side) {
      if (alongRows ? raster.isOccupied(u + i, v + side) : raster.isOccupied(u + side, v + i)) return true;
    }
    return false;
  };
  const int needed = static_cast<int>(std::ceil(kLeastWallLength / raster.step()));
  int length = 1;
  for (int i = 1; isWall(i) && length < needed; ++i) ++length;
  for (int i = -1; isWall(i) && length < needed; --i) ++length;
  return length >= needed;
}

}  // namespace

std::vector<Raster> rastersAlongWalls(const map::OccupancyGrid& grid, std::size_t most) {
  std::vector<Raster> rasters;
  Points left = occupiedCells(grid);
  const std::size_t least = std::max(kLeastWallCells, left.size() / kLeastShare);
  while (rasters.size() < most && left.size() >= least) {
    Raster raster(grid, mainDirection(left, grid.resolution()));
    const auto before = left.size();
    std::erase_if(left, [&](const Eigen::Vector2d& point) {
      const Eigen::Vector2d cell = raster.inRaster(point);
      return isInWall(raster, cell, true) || isInWall(raster, cell, false);
    });
    if (before - left.size() < least) break;
    rasters.push_back(std::move(raster));
  }
  return rasters;
}

Raster::Raster(double direction, double step)
    : direction_(direction),
      step_(step),
      along_(std::cos(direction), std::sin(direction)),
      across_(-std::sin(direction), std::cos(direction)) {}

Raster::Raster(const map::OccupancyGrid& grid, double direction, const Eigen::Vector2d& middle, double reach)
    : Raster(direction, grid.resolution()) {
  origin_ = middle - reach * (along_ + across_);
  width_ = height_ = 2 * static_cast<int>(reach / step_) + 1;
  fill(grid);
}

Raster::Raster(const map::OccupancyGrid& grid, double direction) : Raster(direction, grid.resolution()) {
  const auto box = grid.knownBox();
  if (box.empty()) return;
  Eigen::Array2d least = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d most = -least;
  for (const int x : {box.first.x, box.last.x}) {
    for (const int y : {box.first.y, box.last.y}) {
      const Eigen::Vector2d corner(geometry::cellCentre(x, step_), geometry::cellCentre(y, step_));
      const Eigen::Array2d turned(corner.dot(along_), corner.dot(across_));
      least = least.min(turned);
      most = most.max(turned);
    }
  }
  origin_ = least.x() * along_ + least.y() * across_;
  width_ = static_cast<int>((most.x() - least.x()) / step_) + 2;
  height_ = static_cast<int>((most.y() - least.y()) / step_) + 2;
  fill(grid);
}

void Raster::fill(const map::OccupancyGrid& grid) {
  states_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  // In 1/65536 of a cell: no division for each of some hundred thousand cells.
  constexpr double kFraction = 65536.0;
  const auto fixed = [&](double cells) { return static_cast<std::int64_t>(std::floor(cells * kFraction)); };
  const std::int64_t stepX = fixed(along_.x());
  const std::int64_t stepY = fixed(along_.y());
  for (int v = 0; v < height_; ++v) {
    const Eigen::Vector2d first = inSubmap(0.0, v) / step_;
    std::int64_t x = fixed(first.x());
    std::int64_t y = fixed(first.y());
    for (int u = 0; u < width_; ++u, x += stepX, y += stepY) {
      states_[index(u, v)] = grid.state({static_cast<int>(x >> 16), static_cast<int>(y >> 16)});
    }
  }
}

Raster Raster::turned() const {
  Raster turned;
  turned.direction_ = direction_ + kQuarter;
  turned.step_ = step_;
  turned.along_ = across_;
  turned.across_ = -along_;
  turned.origin_ = inSubmap(width_ - 1, 0);
  turned.width_ = height_;
  turned.height_ = width_;
  turned.states_.resize(states_.size());
  for (int v = 0; v < height_; ++v) {
    for (int u = 0; u < width_; ++u) turned.states_[turned.index(v, width_ - 1 - u)] = states_[index(u, v)];
  }
  return turned;
}

}  // namespace prodomos::perception::doorways

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/grid_index.hpp"
#include "prodomos/geometry/ray_fan.hpp"
#include "prodomos/map/config.hpp"
#include "prodomos/map/layer.hpp"

#include <Eigen/Core>

#include <array>
#include <limits>
#include <optional>
#include <span>

namespace prodomos::map {

enum class CellState : std::uint8_t { kUnknown, kFree, kOccupied };

/// U of 002: log-odds of occupancy in square cells of the x-y-plane, with OctoMap's semantics. Each cell is updated at
/// most once a scan; a cell with an end point is hit, even where other beams pass it. Grows as needed.
class OccupancyGrid final : public MapLayer {
 public:
  static constexpr std::string_view kTypeId = "occupancy_grid";

  /// Log-odds in 1/24 nat, so that P is true to 0.005; kUnknownCell: never touched by any beam.
  using Cell = std::int8_t;
  static constexpr Cell kUnknownCell = std::numeric_limits<Cell>::min();
  static constexpr double kUnitsPerNat = 24.0;

  explicit OccupancyGrid(const OccupancyGridConfig& config = {});

  const OccupancyGridConfig& config() const { return config_; }
  double resolution() const { return config_.resolution; }
  /// The cells that storage exists for; all others are unknown.
  const geometry::CellBox& box() const { return box_; }
  geometry::CellIndex cellAt(const Eigen::Vector2d& point_in_submap) const {
    return geometry::cellAt(point_in_submap.x(), point_in_submap.y(), config_.resolution);
  }
  Cell cell(geometry::CellIndex index) const {
    return box_.contains(index) ? row(index.y)[index.x - box_.first.x] : kUnknownCell;
  }
  CellState state(geometry::CellIndex index) const { return stateOf(cell(index)); }
  /// P(occupied); 0.5 where unknown.
  double probability(geometry::CellIndex index) const;
  static CellState stateOf(Cell cell) {
    return cell == kUnknownCell ? CellState::kUnknown : cell < 0 ? CellState::kFree : CellState::kOccupied;
  }
  /// The smallest box that holds all known cells; empty where there is none.
  geometry::CellBox knownBox() const;

  /// Beams from one point to many: cells passed are missed, end cells of beams with a hit are hit. Coordinates in
  /// metres in the grid's frame; beams longer than the configured range are cut, and hit nothing.
  struct Beam {
    Eigen::Vector2d end = Eigen::Vector2d::Zero();
    bool hit = true;
  };
  void insert(const Eigen::Vector2d& origin, std::span<const Beam> beams);
  /// The sensor may stand anywhere in the grid's frame; where it is tilted, its beams are those seen from above.
  void insert(const sensors::LaserScan& scan, const geometry::Pose3& T_grid_sensor);
  /// Share of the reading's end points whose cells are known already, 0 … 1; 1 where it has none.
  double overlap(const PlacedReading& placed);

  std::string_view typeId() const override { return kTypeId; }
  int version() const override { return 1; }
  std::unique_ptr<MapLayer> clone() const override { return std::make_unique<OccupancyGrid>(*this); }
  bool integrate(const PlacedReading& placed) override;
  /// Adds the log-odds of the other's nearest cell (only yaw and x, y of the pose count).
  void merge(const MapLayer& other, const geometry::Pose3& T_this_other) override;
  /// The same of the cells within `limits` alone.
  void mergeWithin(const geometry::CellBox& limits, const OccupancyGrid& other, const geometry::Pose3& T_this_other);
  void save(base::ByteWriter& out) const override;
  void load(base::ByteReader& in, int version) override;
  Drawing draw() const override;
  std::vector<std::pair<std::string, std::string>> summary() const override;

 private:
  struct Hit {
    geometry::CellIndex cell;
    Cell before = 0;
  };

  geometry::CellBox boxOf(const OccupancyGrid& other, const geometry::Pose3& T_this_other) const;
  void grow(const geometry::CellBox& needed);
  std::optional<Eigen::Vector2d> levelBeams(const PlacedReading& placed);
  Cell* row(int y) { return cells_.data() + static_cast<std::ptrdiff_t>(y - box_.first.y) * box_.width(); }
  const Cell* row(int y) const { return cells_.data() + static_cast<std::ptrdiff_t>(y - box_.first.y) * box_.width(); }

  OccupancyGridConfig config_;
  Cell hit_;
  Cell miss_;
  Cell low_;
  Cell high_;
  std::array<Cell, 256> missed_;  // by a cell's byte: what a miss makes of it
  geometry::CellBox box_;
  std::vector<Cell> cells_;

  // Scratch of insert(), kept for its memory.
  geometry::RayFan fan_;
  std::vector<Beam> beams_;
  std::vector<Eigen::Vector2d> ends_;
  std::vector<Hit> hits_;
};

}  // namespace prodomos::map

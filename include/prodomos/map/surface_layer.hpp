// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/grid_index.hpp"
#include "prodomos/map/config.hpp"
#include "prodomos/map/layer.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace prodomos::map {

/// Where walls are, finer than the occupancy grid says: the means of all end points of beams in square cells of the
/// x-y-plane. What scans and sub-maps are matched with.
class SurfaceLayer final : public MapLayer {
 public:
  static constexpr std::string_view kTypeId = "surface";

  /// Mean of the end points in one cell.
  struct Point {
    float x = 0.0F;  ///< metres, in the sub-map
    float y = 0.0F;
    float count = 0.0F;  ///< up to kMostCount, so that a cell can still follow what has changed

    Eigen::Vector2d position_in_submap() const { return {static_cast<double>(x), static_cast<double>(y)}; }
  };
  static constexpr float kMostCount = 64.0F;

  struct Viewpoint {
    float x = 0.0F;  ///< metres, in the sub-map
    float y = 0.0F;

    Eigen::Vector2d position_in_submap() const { return {static_cast<double>(x), static_cast<double>(y)}; }
  };

  /// The surface around a place: a stretch of wall, or no more than a heap of points.
  struct Patch {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Vector2d normal = Eigen::Vector2d::Zero();  ///< of unit length, to either side
    double thickness = 0.0;                            ///< standard deviation along the normal, metres
    double extent = 0.0;                               ///< standard deviation along the wall, metres
  };

  explicit SurfaceLayer(const SurfaceLayerConfig& config = {});

  double resolution() const { return config_.resolution; }
  const std::vector<Point>& points() const { return points_; }  ///< in the order in which their cells were first hit
  /// Where sensors stood, a metre apart or more.
  const std::vector<Viewpoint>& viewpoints() const { return viewpoints_; }
  void addViewpoint(const Eigen::Vector2d& sensor_in_submap);
  /// Adds an end point; true where it is the first one in its cell.
  bool insert(const Eigen::Vector2d& point_in_submap);
  /// The surface as the points within kReach see it, near ones most (implicit moving least squares). None where there
  /// are none.
  std::optional<Patch> patchAt(const Eigen::Vector2d& place_in_submap) const;
  /// Is there a point within two cells?
  bool isNear(const Eigen::Vector2d& place_in_submap) const;
  static constexpr double kReach = 0.2;  ///< metres

  std::string_view typeId() const override { return kTypeId; }
  int version() const override { return 1; }
  std::unique_ptr<MapLayer> clone() const override { return std::make_unique<SurfaceLayer>(*this); }
  bool integrate(const PlacedReading& placed) override;
  void merge(const MapLayer& other, const geometry::Pose3& T_this_other) override;
  void save(base::ByteWriter& out) const override;
  void load(base::ByteReader& in, int version) override;
  Drawing draw() const override;
  std::vector<std::pair<std::string, std::string>> summary() const override;

 private:
  static constexpr std::int32_t kNone = -1;

  void add(const Eigen::Vector2d& point_in_submap, float count);
  void grow(const geometry::CellBox& needed);
  geometry::CellIndex cellOf(const Point& point) const {
    return geometry::cellAt(static_cast<double>(point.x), static_cast<double>(point.y), config_.resolution);
  }
  std::size_t offset(geometry::CellIndex cell) const {
    return static_cast<std::size_t>(cell.y - box_.first.y) * static_cast<std::size_t>(box_.width()) +
           static_cast<std::size_t>(cell.x - box_.first.x);
  }

  SurfaceLayerConfig config_;
  std::vector<Point> points_;
  std::vector<Viewpoint> viewpoints_;
  geometry::CellBox box_;
  std::vector<std::int32_t> index_;  // by cell of the box: its point, or kNone
};

}  // namespace prodomos::map

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/config.hpp"
#include "prodomos/map/layer.hpp"

#include <unordered_set>

namespace prodomos::map {

/// P of 002: the points sensed, thinned to one a voxel (the first that falls into it).
class PointLayer final : public MapLayer {
 public:
  static constexpr std::string_view kTypeId = "points";

  struct Point {
    Eigen::Vector3f position_in_submap;
    sensors::Rgb color;
  };

  explicit PointLayer(const PointLayerConfig& config = {});

  const std::vector<Point>& points() const { return points_; }  ///< in the order in which they were seen
  double voxel() const { return voxel_; }
  void insert(const Eigen::Vector3f& position_in_submap, sensors::Rgb color);

  std::string_view typeId() const override { return kTypeId; }
  int version() const override { return 1; }
  std::unique_ptr<MapLayer> clone() const override { return std::make_unique<PointLayer>(*this); }
  bool integrate(const PlacedReading& placed) override;
  void merge(const MapLayer& other, const geometry::Pose3& T_this_other) override;
  void save(base::ByteWriter& out) const override;
  void load(base::ByteReader& in, int version) override;
  Drawing draw() const override;
  std::vector<std::pair<std::string, std::string>> summary() const override;

 private:
  double voxel_;
  double maxRange_;
  std::vector<Point> points_;
  std::unordered_set<std::uint64_t> voxels_;
};

}  // namespace prodomos::map

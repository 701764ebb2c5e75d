// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/point_layer.hpp"

#include "map/depth_points.hpp"

#include <cmath>

namespace prodomos::map {

namespace {

constexpr sensors::Rgb kNoColor{120, 130, 145};

/// 21 bits a coordinate.
std::uint64_t voxelKey(const Eigen::Vector3f& point, double voxel) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto index = static_cast<std::int64_t>(std::floor(static_cast<double>(point[axis]) / voxel));
    key = (key << 21U) | (static_cast<std::uint64_t>(index) & 0x1FFFFFU);
  }
  return key;
}

}  // namespace

PointLayer::PointLayer(const PointLayerConfig& config) : voxel_(config.voxel), maxRange_(config.maxRange) {}

void PointLayer::insert(const Eigen::Vector3f& position_in_submap, sensors::Rgb color) {
  if (voxels_.insert(voxelKey(position_in_submap, voxel_)).second) points_.push_back({position_in_submap, color});
}

bool PointLayer::integrate(const PlacedReading& placed) {
  const auto take = [&](const geometry::Pose3& T_body_sensor, const Eigen::Vector3d& point_in_sensor,
                        sensors::Rgb color) {
    if (point_in_sensor.norm() > maxRange_) return;
    insert((placed.T_submap_body * (T_body_sensor * point_in_sensor)).cast<float>(), color);
  };
  if (const auto* frame = std::get_if<sensors::RgbdFrame>(&placed.reading.data); frame && !frame->depth.empty()) {
    constexpr int kStep = 4;  // pixels; at 5 m and 10 cm a voxel is still hit by several
    forEachDepthPoint(*frame, kStep, placed.movers, [&](const Eigen::Vector3d& point_in_camera, int x, int y) {
      take(frame->T_body_camera, point_in_camera, frame->color.empty() ? kNoColor : frame->color(x, y));
    });
    return true;
  }
  if (const auto* cloud = std::get_if<sensors::PointCloud>(&placed.reading.data)) {
    for (std::size_t i = 0; i < cloud->points_in_sensor.size(); ++i) {
      const auto& point = cloud->points_in_sensor[i];
      if (!point.allFinite() || isMover(placed.movers, i)) continue;
      take(cloud->T_body_sensor, point.cast<double>(), cloud->color.empty() ? kNoColor : cloud->color[i]);
    }
    return true;
  }
  if (const auto* scan = std::get_if<sensors::LaserScan>(&placed.reading.data)) {
    for (std::size_t i = 0; i < scan->ranges.size(); ++i) {
      const double range = static_cast<double>(scan->ranges[i]);
      if (!(range >= 0.0 && range <= maxRange_) || isMover(placed.movers, i)) continue;
      const double angle = scan->firstAngle + static_cast<double>(i) * scan->angleStep;
      take(scan->T_body_sensor, {range * std::cos(angle), range * std::sin(angle), 0.0}, kNoColor);
    }
    return true;
  }
  return false;
}

void PointLayer::merge(const MapLayer& other, const geometry::Pose3& T_this_other) {
  for (const auto& point : dynamic_cast<const PointLayer&>(other).points_) {
    insert((T_this_other * point.position_in_submap.cast<double>()).cast<float>(), point.color);
  }
}

void PointLayer::save(base::ByteWriter& out) const {
  out << voxel_ << maxRange_ << static_cast<std::uint64_t>(points_.size());
  for (const auto& point : points_) {
    out << point.position_in_submap.x() << point.position_in_submap.y() << point.position_in_submap.z();
    out << point.color.r << point.color.g << point.color.b;
  }
}

void PointLayer::load(base::ByteReader& in, int version) {
  if (version != 1) throw base::Error("expected version 1 of a point layer, found " + std::to_string(version));
  PointLayerConfig config;
  in >> config.voxel >> config.maxRange;
  *this = PointLayer(config);
  const auto count = in.read<std::uint64_t>();
  constexpr std::size_t kBytesPerPoint = 3 * sizeof(float) + 3;
  if (count != in.left() / kBytesPerPoint) {
    throw base::Error("expected " + std::to_string(count) + " points, found " + std::to_string(in.left()) + " bytes");
  }
  points_.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    Point point;
    in >> point.position_in_submap.x() >> point.position_in_submap.y() >> point.position_in_submap.z();
    in >> point.color.r >> point.color.g >> point.color.b;
    insert(point.position_in_submap, point.color);
  }
}

Drawing PointLayer::draw() const {
  Drawing drawing;
  drawing.points.reserve(points_.size());
  for (const auto& point : points_) {
    drawing.points.push_back({point.position_in_submap, {point.color.r, point.color.g, point.color.b, 255}});
  }
  return drawing;
}

std::vector<std::pair<std::string, std::string>> PointLayer::summary() const {
  return {{"points", std::to_string(points_.size())}};
}

}  // namespace prodomos::map

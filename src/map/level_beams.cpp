// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/level_beams.hpp"

#include "map/depth_points.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace prodomos::map {

using Beam = OccupancyGrid::Beam;

void appendLevelBeams(const sensors::LaserScan& scan, const geometry::Pose3& T_grid_sensor, double noReturn,
                      const sensors::Mask* movers, std::vector<Beam>& beams) {
  const Eigen::Vector2d origin = T_grid_sensor.translation().head<2>();
  const Eigen::Matrix2d rotation = T_grid_sensor.linear().topLeftCorner<2, 2>();
  noReturn = std::min(scan.maxRange, noReturn);
  // The direction turns by one step a beam: one multiplication of complex numbers instead of a sine and a cosine.
  Eigen::Vector2d direction(std::cos(scan.firstAngle), std::sin(scan.firstAngle));
  const Eigen::Vector2d step(std::cos(scan.angleStep), std::sin(scan.angleStep));
  beams.reserve(beams.size() + scan.ranges.size());
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const float range = scan.ranges[i];
    if (range >= 0.0F && !isMover(movers, i)) {  // neither kInvalid nor not a number
      const bool hit = range < sensors::LaserScan::kNoReturn;
      beams.push_back({origin + rotation * (direction * (hit ? static_cast<double>(range) : noReturn)), hit});
    }
    direction = {direction.x() * step.x() - direction.y() * step.y(),
                 direction.x() * step.y() + direction.y() * step.x()};
  }
}

namespace {

/// The same where the body moved while the scanner turned: each beam's end as seen from where the body was at the
/// first.
void appendSweptBeams(const sensors::LaserScan& scan, const PlacedReading& placed, double noReturn,
                      std::vector<Beam>& beams) {
  noReturn = std::min(scan.maxRange, noReturn);
  const double beamTime = scan.sweepTime / static_cast<double>(std::max<std::size_t>(scan.ranges.size(), 2) - 1);
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const float range = scan.ranges[i];
    if (!(range >= 0.0F) || isMover(placed.movers, i)) continue;
    const bool hit = range < sensors::LaserScan::kNoReturn;
    const double length = hit ? static_cast<double>(range) : noReturn;
    const double angle = scan.firstAngle + static_cast<double>(i) * scan.angleStep;
    const Eigen::Vector3d moved = placed.velocity * (beamTime * static_cast<double>(i));
    const geometry::Pose3 T_first_now = geometry::toPose3({moved.x(), moved.y(), moved.z()});
    const Eigen::Vector3d end_in_body =
        scan.T_body_sensor * Eigen::Vector3d(length * std::cos(angle), length * std::sin(angle), 0.0);
    beams.push_back({(placed.T_submap_body * (T_first_now * end_in_body)).head<2>(), hit});
  }
}

/// Points by their direction from the sensor, as seen from above.
class DirectionBins {
 public:
  DirectionBins(const Eigen::Vector3d& sensor_in_grid, const HeightBand& band) : sensor_(sensor_in_grid), band_(band) {}

  void add(const Eigen::Vector3d& point_in_grid) {
    if (point_in_grid.z() > band_.most) return;
    const Eigen::Vector2d offset = (point_in_grid - sensor_).head<2>();
    const double distance = offset.norm();
    const double turn = std::atan2(offset.y(), offset.x()) / (2.0 * std::numbers::pi) + 0.5;
    auto& bin = bins_[static_cast<std::size_t>(turn * kCount) % kCount];
    bin.farthest = std::max(bin.farthest, distance);
    if (point_in_grid.z() < band_.least) return;
    ++bin.obstacles;
    bin.nearest = std::min(bin.nearest, distance);
  }

  void appendTo(std::vector<Beam>& beams) const {
    for (std::size_t i = 0; i < kCount; ++i) {
      const auto& bin = bins_[i];
      const bool hit = bin.obstacles >= kLeastObstacles;
      const double range = hit ? bin.nearest : bin.farthest;
      if (range <= 0.0) continue;
      const double angle = ((static_cast<double>(i) + 0.5) / kCount - 0.5) * 2.0 * std::numbers::pi;
      beams.push_back({sensor_.head<2>() + range * Eigen::Vector2d(std::cos(angle), std::sin(angle)), hit});
    }
  }

 private:
  static constexpr std::size_t kCount = 1440;
  static constexpr int kLeastObstacles = 2;  // a single point is noise

  struct Bin {
    double nearest = std::numeric_limits<double>::infinity();
    double farthest = 0.0;
    int obstacles = 0;
  };

  Eigen::Vector3d sensor_;
  HeightBand band_;
  std::array<Bin, kCount> bins_{};
};

void appendBeams(const sensors::RgbdFrame& frame, const geometry::Pose3& T_grid_camera, const HeightBand& band,
                 const sensors::Mask* movers, std::vector<Beam>& beams) {
  DirectionBins bins(T_grid_camera.translation(), band);
  constexpr int kStep = 2;  // pixels; a bin is wider than two of them
  forEachDepthPoint(frame, kStep, movers, [&](const Eigen::Vector3d& point_in_camera, int, int) {
    bins.add(T_grid_camera * point_in_camera);
  });
  bins.appendTo(beams);
}

void appendBeams(const sensors::PointCloud& cloud, const geometry::Pose3& T_grid_sensor, const HeightBand& band,
                 const sensors::Mask* movers, std::vector<Beam>& beams) {
  DirectionBins bins(T_grid_sensor.translation(), band);
  for (std::size_t i = 0; i < cloud.points_in_sensor.size(); ++i) {
    if (isMover(movers, i)) continue;
    const Eigen::Vector3d point_in_grid = T_grid_sensor * cloud.points_in_sensor[i].cast<double>();
    if (point_in_grid.allFinite()) bins.add(point_in_grid);
  }
  bins.appendTo(beams);
}

}  // namespace

std::optional<Eigen::Vector2d> appendLevelBeams(const PlacedReading& placed, const HeightBand& band,
                                                std::vector<Beam>& beams, double noReturn) {
  geometry::Pose3 T_grid_sensor = placed.T_submap_body;
  if (const auto* scan = std::get_if<sensors::LaserScan>(&placed.reading.data)) {
    T_grid_sensor = T_grid_sensor * scan->T_body_sensor;
    if (scan->sweepTime > 0.0 && !placed.velocity.isZero()) {
      appendSweptBeams(*scan, placed, noReturn, beams);
    } else {
      appendLevelBeams(*scan, T_grid_sensor, noReturn, placed.movers, beams);
    }
  } else if (const auto* frame = std::get_if<sensors::RgbdFrame>(&placed.reading.data);
             frame && !frame->depth.empty()) {
    T_grid_sensor = T_grid_sensor * frame->T_body_camera;
    appendBeams(*frame, T_grid_sensor, band, placed.movers, beams);
  } else if (const auto* cloud = std::get_if<sensors::PointCloud>(&placed.reading.data)) {
    T_grid_sensor = T_grid_sensor * cloud->T_body_sensor;
    appendBeams(*cloud, T_grid_sensor, band, placed.movers, beams);
  } else {
    return std::nullopt;
  }
  return T_grid_sensor.translation().head<2>();
}

}  // namespace prodomos::map

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/surface_layer.hpp"

#include "prodomos/map/level_beams.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace prodomos::map {

namespace {

constexpr int kGrowthMargin = 64;  // cells; storage grows in strides, not point by point
constexpr Rgba kColor{192, 57, 43, 255};

}  // namespace

SurfaceLayer::SurfaceLayer(const SurfaceLayerConfig& config) : config_(config) {}

void SurfaceLayer::grow(const geometry::CellBox& needed) {
  if (box_.contains(needed.first) && box_.contains(needed.last)) return;
  box_.add({needed.first.x - kGrowthMargin, needed.first.y - kGrowthMargin});
  box_.add({needed.last.x + kGrowthMargin, needed.last.y + kGrowthMargin});
  index_.assign(static_cast<std::size_t>(box_.width()) * static_cast<std::size_t>(box_.height()), kNone);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    index_[offset(cellOf(points_[i]))] = static_cast<std::int32_t>(i);
  }
}

void SurfaceLayer::addViewpoint(const Eigen::Vector2d& sensor_in_submap) {
  const Eigen::Vector2f sensor = sensor_in_submap.cast<float>();
  constexpr float kApart = 1.0F;  // metres
  const bool isNew = std::ranges::none_of(viewpoints_, [&](const Viewpoint& other) {
    return (Eigen::Vector2f(other.x, other.y) - sensor).norm() < kApart;
  });
  if (isNew) viewpoints_.push_back({sensor.x(), sensor.y()});
}

bool SurfaceLayer::insert(const Eigen::Vector2d& point_in_submap) {
  const auto before = points_.size();
  add(point_in_submap, 1.0F);
  return points_.size() > before;
}

void SurfaceLayer::add(const Eigen::Vector2d& point_in_submap, float count) {
  const Point added{static_cast<float>(point_in_submap.x()), static_cast<float>(point_in_submap.y()), count};
  const auto cell = cellOf(added);
  grow({cell, cell});
  auto& index = index_[offset(cell)];
  if (index == kNone) {
    index = static_cast<std::int32_t>(points_.size());
    points_.push_back(added);
    return;
  }
  auto& point = points_[static_cast<std::size_t>(index)];
  Point mean = point;
  mean.count = std::min(point.count + count, kMostCount);
  mean.x += (added.x - point.x) * (count / mean.count);
  mean.y += (added.y - point.y) * (count / mean.count);
  // Rounding must not carry the mean over the border of its cell, where it would not be found again.
  if (cellOf(mean) == cell) point = mean;
}

std::optional<SurfaceLayer::Patch> SurfaceLayer::patchAt(const Eigen::Vector2d& place_in_submap) const {
  if (points_.empty()) return std::nullopt;
  const auto first = geometry::cellAt(place_in_submap.x() - kReach, place_in_submap.y() - kReach, config_.resolution);
  const auto last = geometry::cellAt(place_in_submap.x() + kReach, place_in_submap.y() + kReach, config_.resolution);
  const int x0 = std::max(first.x, box_.first.x);
  const int x1 = std::min(last.x, box_.last.x);
  const int y0 = std::max(first.y, box_.first.y);
  const int y1 = std::min(last.y, box_.last.y);
  const Eigen::Vector2f place = place_in_submap.cast<float>();

  float sum = 0.0F;
  Eigen::Vector2f moment = Eigen::Vector2f::Zero();
  float xx = 0.0F;
  float xy = 0.0F;
  float yy = 0.0F;
  for (int y = y0; y <= y1; ++y) {
    const auto* row = index_.data() + static_cast<std::ptrdiff_t>(y - box_.first.y) * box_.width() - box_.first.x;
    for (int x = x0; x <= x1; ++x) {
      if (row[x] == kNone) continue;
      const auto& point = points_[static_cast<std::size_t>(row[x])];
      const Eigen::Vector2f offset = Eigen::Vector2f(point.x, point.y) - place;
      constexpr float kReachSquared = static_cast<float>(kReach * kReach);
      const float nearness = 1.0F - offset.squaredNorm() / kReachSquared;
      if (nearness <= 0.0F) continue;
      const float weight = nearness * nearness * std::min(point.count, 8.0F);
      sum += weight;
      moment += weight * offset;
      xx += weight * offset.x() * offset.x();
      xy += weight * offset.x() * offset.y();
      yy += weight * offset.y() * offset.y();
    }
  }
  if (sum <= 0.0F) return std::nullopt;
  const Eigen::Vector2d mean = (moment / sum).cast<double>();
  const double cxx = static_cast<double>(xx / sum) - mean.x() * mean.x();
  const double cxy = static_cast<double>(xy / sum) - mean.x() * mean.y();
  const double cyy = static_cast<double>(yy / sum) - mean.y() * mean.y();
  const double middle = 0.5 * (cxx + cyy);
  const double spread = std::hypot(0.5 * (cxx - cyy), cxy);
  const double along = 0.5 * std::atan2(2.0 * cxy, cxx - cyy);  // direction of the greatest extent
  return Patch{.mean = place_in_submap + mean,
               .normal = {-std::sin(along), std::cos(along)},
               .thickness = std::sqrt(std::max(middle - spread, 0.0)),
               .extent = std::sqrt(std::max(middle + spread, 0.0))};
}

bool SurfaceLayer::isNear(const Eigen::Vector2d& place_in_submap) const {
  const auto cell = geometry::cellAt(place_in_submap.x(), place_in_submap.y(), config_.resolution);
  constexpr int kCells = 2;
  for (int y = std::max(cell.y - kCells, box_.first.y); y <= std::min(cell.y + kCells, box_.last.y); ++y) {
    for (int x = std::max(cell.x - kCells, box_.first.x); x <= std::min(cell.x + kCells, box_.last.x); ++x) {
      if (index_[offset({x, y})] != kNone) return true;
    }
  }
  return false;
}

bool SurfaceLayer::integrate(const PlacedReading& placed) {
  std::vector<OccupancyGrid::Beam> beams;
  const auto origin = appendLevelBeams(placed, config_.heightBand, beams);
  if (!origin) return false;
  addViewpoint(*origin);
  for (const auto& beam : beams) {
    if (beam.hit && (beam.end - *origin).norm() <= config_.maxRange) insert(beam.end);
  }
  return true;
}

void SurfaceLayer::merge(const MapLayer& other, const geometry::Pose3& T_this_other) {
  for (const auto& point : dynamic_cast<const SurfaceLayer&>(other).points_) {
    const Eigen::Vector2d position = point.position_in_submap();
    add((T_this_other * Eigen::Vector3d(position.x(), position.y(), 0.0)).head<2>(), point.count);
  }
}

void SurfaceLayer::save(base::ByteWriter& out) const {
  out << config_.resolution << points_ << viewpoints_;
}

void SurfaceLayer::load(base::ByteReader& in, int) {
  in >> config_.resolution >> points_ >> viewpoints_;
  if (!(config_.resolution > 0.0)) throw base::Error("expected a resolution above zero");
  box_ = {};
  index_.clear();
  for (const auto& point : points_) {
    if (!point.position_in_submap().allFinite() || !(point.count > 0.0F)) throw base::Error("expected finite points");
  }
  geometry::CellBox known;
  for (const auto& point : points_)
    known.add(cellOf(point));
  if (!known.empty()) grow(known);
}

Drawing SurfaceLayer::draw() const {
  Drawing drawing;
  drawing.points.reserve(points_.size());
  for (const auto& point : points_) {
    drawing.points.push_back({{point.x, point.y, 0.0F}, kColor});
  }
  return drawing;
}

std::vector<std::pair<std::string, std::string>> SurfaceLayer::summary() const {
  return {{"surface points", std::to_string(points_.size())}};
}

}  // namespace prodomos::map

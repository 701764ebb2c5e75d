// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/surface_layer.hpp"

#include "prodomos/map/level_beams.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace prodomos::map {

namespace {

constexpr int kGrowthMargin = 64;  // cells; storage grows in strides, not point by point
constexpr Rgba kColor{192, 57, 43, 255};

/// Throws base::Error where the value, which may be not a number, lies elsewhere.
void require(const char* what, double value, double least, double most) {
  if (value >= least && value <= most) return;
  throw base::Error("expected " + std::string(what) + " from " + std::to_string(least) + " to " + std::to_string(most) +
                    ", found " + std::to_string(value));
}

/// Weighted sums of the points around a place, as offsets from it in metres.
class Moments {
 public:
  bool empty() const { return sum_ <= 0.0F; }

  void add(const Eigen::Vector2f& offset, float count) {
    constexpr float kReachSquared = static_cast<float>(SurfaceLayer::kReach * SurfaceLayer::kReach);
    const float nearness = 1.0F - offset.squaredNorm() / kReachSquared;
    if (nearness <= 0.0F) return;
    constexpr float kTrusted = 8.0F;  // points; a mean of more is as good
    const float weight = nearness * nearness * std::min(count, kTrusted);
    sum_ += weight;
    moment_ += weight * offset;
    xx_ += weight * offset.x() * offset.x();
    xy_ += weight * offset.x() * offset.y();
    yy_ += weight * offset.y() * offset.y();
  }

  /// The line through the points, by their principal axes.
  SurfaceLayer::Patch patchAround(const Eigen::Vector2d& place) const {
    const Eigen::Vector2d mean = (moment_ / sum_).cast<double>();
    const double xx = static_cast<double>(xx_ / sum_) - mean.x() * mean.x();
    const double xy = static_cast<double>(xy_ / sum_) - mean.x() * mean.y();
    const double yy = static_cast<double>(yy_ / sum_) - mean.y() * mean.y();
    const double middle = 0.5 * (xx + yy);
    const double spread = std::hypot(0.5 * (xx - yy), xy);
    const double along = 0.5 * std::atan2(2.0 * xy, xx - yy);  // direction of the greatest extent
    return {.mean = place + mean,
            .normal = {-std::sin(along), std::cos(along)},
            .thickness = std::sqrt(std::max(middle - spread, 0.0)),
            .extent = std::sqrt(std::max(middle + spread, 0.0))};
  }

 private:
  float sum_ = 0.0F;
  Eigen::Vector2f moment_ = Eigen::Vector2f::Zero();
  float xx_ = 0.0F;
  float xy_ = 0.0F;
  float yy_ = 0.0F;
};

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
  const float share = count / (point.count + count);
  const Point mean{point.x + share * (added.x - point.x), point.y + share * (added.y - point.y),
                   std::min(point.count + count, kMostCount)};
  // Rounding must not carry the mean over the border of its cell, where it would not be found again.
  if (cellOf(mean) == cell) point = mean;
}

std::optional<SurfaceLayer::Patch> SurfaceLayer::patchAt(const Eigen::Vector2d& place_in_submap) const {
  const auto first = geometry::cellAt(place_in_submap.x() - kReach, place_in_submap.y() - kReach, config_.resolution);
  const auto last = geometry::cellAt(place_in_submap.x() + kReach, place_in_submap.y() + kReach, config_.resolution);
  const int x0 = std::max(first.x, box_.first.x);
  const int x1 = std::min(last.x, box_.last.x);
  const int y0 = std::max(first.y, box_.first.y);
  const int y1 = std::min(last.y, box_.last.y);
  const Eigen::Vector2f place = place_in_submap.cast<float>();
  Moments moments;
  for (int y = y0; y <= y1; ++y) {
    const auto* row = index_.data() + offset({box_.first.x, y});
    for (int x = x0; x <= x1; ++x) {
      const auto index = row[x - box_.first.x];
      if (index == kNone) continue;
      const auto& point = points_[static_cast<std::size_t>(index)];
      moments.add(Eigen::Vector2f(point.x, point.y) - place, point.count);
    }
  }
  return moments.empty() ? std::nullopt : std::optional(moments.patchAround(place_in_submap));
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
  const auto moved = [&](const Eigen::Vector2d& position) -> Eigen::Vector2d {
    return (T_this_other * Eigen::Vector3d(position.x(), position.y(), 0.0)).head<2>();
  };
  const auto& surface = dynamic_cast<const SurfaceLayer&>(other);
  for (const auto& point : surface.points_) add(moved(point.position_in_submap()), point.count);
  for (const auto& viewpoint : surface.viewpoints_) addViewpoint(moved(viewpoint.position_in_submap()));
}

void SurfaceLayer::save(base::ByteWriter& out) const {
  out << config_.resolution << points_ << viewpoints_;
}

void SurfaceLayer::load(base::ByteReader& in, int version) {
  if (version != 1) throw base::Error("expected version 1 of a surface layer, found " + std::to_string(version));
  SurfaceLayer loaded(config_);
  in >> loaded.config_.resolution >> loaded.points_ >> loaded.viewpoints_;
  require("resolution", loaded.config_.resolution, 1e-4, 1e3);
  const double farthest = 1e9 * loaded.config_.resolution;  // metres; cells are counted in 32 bits
  for (const auto& viewpoint : loaded.viewpoints_) {
    require("x of a viewpoint", static_cast<double>(viewpoint.x), -farthest, farthest);
    require("y of a viewpoint", static_cast<double>(viewpoint.y), -farthest, farthest);
  }
  geometry::CellBox known;
  for (const auto& point : loaded.points_) {
    require("x of a point", static_cast<double>(point.x), -farthest, farthest);
    require("y of a point", static_cast<double>(point.y), -farthest, farthest);
    require("count of a point", static_cast<double>(point.count), 1.0, static_cast<double>(kMostCount));
    known.add(loaded.cellOf(point));
  }
  constexpr double kMostCells = 1e8;
  if (!known.empty()) {
    require("number of cells", static_cast<double>(known.width()) * known.height(), 0.0, kMostCells);
    loaded.grow(known);
  }
  for (std::size_t i = 0; i < loaded.points_.size(); ++i) {
    if (loaded.index_[loaded.offset(loaded.cellOf(loaded.points_[i]))] != static_cast<std::int32_t>(i))
      throw base::Error("expected one surface point in each cell, found two");
  }
  *this = std::move(loaded);
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

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/occupancy_grid.hpp"

#include "prodomos/map/level_beams.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace prodomos::map {

namespace {

constexpr int kGrowthMargin = 128;  // cells; storage grows in strides, not scan by scan
constexpr int kLanes = 16;          // cells updated at a time; storage ends with as many that belong to no row

OccupancyGrid::Cell logOdds(double probability) {
  const double nats = std::log(probability / (1.0 - probability));
  const auto units = std::lround(OccupancyGrid::kUnitsPerNat * nats);
  return static_cast<OccupancyGrid::Cell>(units != 0 ? units : nats < 0.0 ? -1 : 1);
}

using MissTable = std::array<OccupancyGrid::Cell, 256>;

/// What a miss makes of each cell, by the cell's byte.
MissTable missTable(int miss, int low) {
  using Limits = std::numeric_limits<OccupancyGrid::Cell>;
  MissTable table{};
  for (int cell = Limits::min(); cell <= Limits::max(); ++cell) {
    const int before = cell == OccupancyGrid::kUnknownCell ? 0 : cell;
    table[static_cast<std::uint8_t>(cell)] = static_cast<OccupancyGrid::Cell>(std::max(before + miss, low));
  }
  return table;
}

/// Lowers cells that beams pass.
class Misser {
 public:
  using Cell = OccupancyGrid::Cell;

  Misser(const MissTable& missed, Cell miss, Cell low) : missed_(missed), miss_(miss), low_(low) {}

  void operator()(Cell* cells, int count) const {
    if (count <= 2) {
      // One or two, as chance has it; so without a branch on it.
      Cell& last = cells[count - 1];
      const Cell first = missed_[static_cast<std::uint8_t>(cells[0])];
      last = missed_[static_cast<std::uint8_t>(last)];
      cells[0] = first;
      return;
    }
    for (; count >= kLanes; count -= kLanes, cells += kLanes) missLanes(cells, kLanes);
    if (count > 0) missLanes(cells, count);
  }

 private:
  /// Sixteen cells at a time, of which those from `count` on are put back as they were. No overflow: the clamp leaves
  /// room below for the greatest miss.
  void missLanes(Cell* cells, int count) const {
    using Lanes = Cell __attribute__((vector_size(kLanes)));
    const Lanes position = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    Lanes before;
    std::memcpy(&before, cells, sizeof before);
    Lanes after = (before == OccupancyGrid::kUnknownCell ? Lanes{} : before) + miss_;
    after = after < low_ ? Lanes{} + low_ : after;
    after = position < static_cast<Cell>(count) ? after : before;
    std::memcpy(cells, &after, sizeof after);
  }

  const MissTable& missed_;
  Cell miss_;
  Cell low_;
};

/// Throws base::Error where no grid has such numbers: a byte would overflow, or cells could not be told apart.
void requireSound(const OccupancyGridConfig& config) {
  const auto require = [](const char* name, double value, double least, double most) {
    if (value >= least && value <= most) return;
    throw base::Error("expected " + std::string(name) + " from " + std::to_string(least) + " to " +
                      std::to_string(most) + ", found " + std::to_string(value));
  };
  constexpr double kFar = 1e6;  // metres
  require("resolution", config.resolution, 1e-4, 1e3);
  require("max_range", config.maxRange, 1e-3, kFar);
  require("no_return", config.noReturn, 0.0, kFar);
  require("hit", config.hit, 0.5, 0.99);
  require("miss", config.miss, 0.08, 0.5);
  require("clamp_low", config.clampLow, 0.05, 0.5);
  require("clamp_high", config.clampHigh, 0.5, 0.99);
  require("band_least", config.heightBand.least, -kFar, kFar);
  require("band_most", config.heightBand.most, -kFar, kFar);
}

/// Throws base::Error where the box does not have so many cells, or lies where nobody can get.
void requireCells(const geometry::CellBox& box, std::size_t cells) {
  constexpr int kFarthest = 1'000'000'000;
  for (const int corner : {box.first.x, box.first.y, box.last.x, box.last.y}) {
    if (corner < -kFarthest || corner > kFarthest) {
      throw base::Error("expected a corner within a billion cells, found " + std::to_string(corner));
    }
  }
  const auto expected =
      box.empty() ? 0 : (std::int64_t{box.last.x} - box.first.x + 1) * (std::int64_t{box.last.y} - box.first.y + 1);
  if (expected != static_cast<std::int64_t>(cells)) {
    throw base::Error("expected " + std::to_string(expected) + " cells, found " + std::to_string(cells) + " bytes");
  }
}

constexpr Rgba kFreeColor{250, 250, 247, 255};
constexpr Rgba kOccupiedColor{38, 50, 66, 255};
constexpr Rgba kUnknownColor{0, 0, 0, 0};

}  // namespace

OccupancyGrid::OccupancyGrid(const OccupancyGridConfig& config)
    : config_(config),
      hit_(logOdds(config.hit)),
      miss_(logOdds(config.miss)),
      low_(logOdds(config.clampLow)),
      high_(logOdds(config.clampHigh)),
      missed_(missTable(miss_, low_)) {}

double OccupancyGrid::probability(geometry::CellIndex index) const {
  const Cell value = cell(index);
  return value == kUnknownCell ? 0.5 : 1.0 / (1.0 + std::exp(-value / kUnitsPerNat));
}

geometry::CellBox OccupancyGrid::knownBox() const {
  geometry::CellBox known;
  for (int y = box_.first.y; y <= box_.last.y; ++y) {
    const auto* cells = row(y);
    const auto isKnown = [](Cell value) { return value != kUnknownCell; };
    const auto* end = cells + box_.width();
    const auto* first = std::find_if(cells, end, isKnown);
    if (first == end) continue;
    known.add({box_.first.x + static_cast<int>(first - cells), y});
    while (!isKnown(*(end - 1))) --end;
    known.add({box_.first.x + static_cast<int>(end - 1 - cells), y});
  }
  return known;
}

void OccupancyGrid::grow(const geometry::CellBox& needed) {
  if (needed.empty() || (box_.contains(needed.first) && box_.contains(needed.last))) return;
  geometry::CellBox grown = needed;
  grown.first = {grown.first.x - kGrowthMargin, grown.first.y - kGrowthMargin};
  grown.last = {grown.last.x + kGrowthMargin, grown.last.y + kGrowthMargin};
  if (!box_.empty()) {
    grown.add(box_.first);
    grown.add(box_.last);
  }
  std::vector<Cell> cells(static_cast<std::size_t>(grown.width()) * static_cast<std::size_t>(grown.height()) + kLanes,
                          kUnknownCell);
  for (int y = box_.first.y; y <= box_.last.y; ++y) {
    const auto offset = static_cast<std::ptrdiff_t>(y - grown.first.y) * grown.width() + box_.first.x - grown.first.x;
    std::copy_n(row(y), box_.width(), cells.begin() + offset);
  }
  box_ = grown;
  cells_ = std::move(cells);
}

void OccupancyGrid::insert(const Eigen::Vector2d& origin, std::span<const Beam> beams) {
  const double cellsPerMetre = 1.0 / config_.resolution;
  const Eigen::Vector2d start = origin * cellsPerMetre;
  const auto cellOf = [](const Eigen::Vector2d& cells) { return geometry::cellAt(cells.x(), cells.y(), 1.0); };

  geometry::CellBox touched;
  touched.add(cellOf(start));
  ends_.clear();
  hits_.clear();
  for (const auto& beam : beams) {
    Eigen::Vector2d end = beam.end * cellsPerMetre;
    const double lengthSquared = (beam.end - origin).squaredNorm();
    bool hit = beam.hit;
    if (lengthSquared > config_.maxRange * config_.maxRange) {
      end = start + (end - start) * (config_.maxRange / std::sqrt(lengthSquared));
      hit = false;
    }
    ends_.push_back(end);
    const auto cell = cellOf(end);
    touched.add(cell);
    if (hit) hits_.push_back({cell, 0});
  }
  if (ends_.empty()) return;
  grow(touched);

  // A cell with an end point counts as hit alone: its value is kept aside while the beams pass.
  for (auto& hit : hits_) hit.before = row(hit.cell.y)[hit.cell.x - box_.first.x];
  const Misser miss(missed_, miss_, low_);
  fan_.trace(
      start, ends_, [cells = cells_.data(), box = box_, width = box_.width(), &miss](int y, int first, int last) {
        miss(cells + static_cast<std::ptrdiff_t>(y - box.first.y) * width + (first - box.first.x), last - first + 1);
      });
  for (const auto& hit : hits_) {
    const Cell before = hit.before == kUnknownCell ? Cell{0} : hit.before;
    row(hit.cell.y)[hit.cell.x - box_.first.x] = static_cast<Cell>(std::min(before + hit_, static_cast<int>(high_)));
  }
}

void OccupancyGrid::insert(const sensors::LaserScan& scan, const geometry::Pose3& T_grid_sensor) {
  beams_.clear();
  appendLevelBeams(scan, T_grid_sensor, config_.noReturn, nullptr, beams_);
  insert(T_grid_sensor.translation().head<2>(), beams_);
}

bool OccupancyGrid::integrate(const PlacedReading& placed) {
  const auto origin = levelBeams(placed);
  if (!origin) return false;
  insert(*origin, beams_);
  return true;
}

double OccupancyGrid::overlap(const PlacedReading& placed) {
  const auto origin = levelBeams(placed);
  if (!origin) return 1.0;
  int ends = 0;
  int known = 0;
  for (const auto& beam : beams_) {
    if (!beam.hit || (beam.end - *origin).squaredNorm() > config_.maxRange * config_.maxRange) continue;
    ++ends;
    if (state(cellAt(beam.end)) != CellState::kUnknown) ++known;
  }
  return ends == 0 ? 1.0 : static_cast<double>(known) / ends;
}

/// Fills beams_ and returns where they begin; none for readings that range nothing.
std::optional<Eigen::Vector2d> OccupancyGrid::levelBeams(const PlacedReading& placed) {
  beams_.clear();
  return appendLevelBeams(placed, config_.heightBand, beams_, config_.noReturn);
}

void OccupancyGrid::merge(const MapLayer& other, const geometry::Pose3& T_this_other) {
  const auto& source = dynamic_cast<const OccupancyGrid&>(other);
  mergeWithin(boxOf(source, T_this_other), source, T_this_other);
}

/// The cells here that the other's known ones may lie in.
geometry::CellBox OccupancyGrid::boxOf(const OccupancyGrid& other, const geometry::Pose3& T_this_other) const {
  geometry::CellBox box;
  const auto known = other.knownBox();
  if (known.empty()) return box;
  const geometry::Pose2 T_this_source = geometry::toPose2(T_this_other);
  for (const int x : {known.first.x, known.last.x + 1}) {
    for (const int y : {known.first.y, known.last.y + 1})
      box.add(cellAt(T_this_source * Eigen::Vector2d(x * other.resolution(), y * other.resolution())));
  }
  return box;
}

void OccupancyGrid::mergeWithin(const geometry::CellBox& limits, const OccupancyGrid& other,
                                const geometry::Pose3& T_this_other) {
  auto target = boxOf(other, T_this_other);
  target.first = {std::max(target.first.x, limits.first.x), std::max(target.first.y, limits.first.y)};
  target.last = {std::min(target.last.x, limits.last.x), std::min(target.last.y, limits.last.y)};
  if (target.empty()) return;
  grow(target);
  const geometry::Pose2 T_other_this = inverse(geometry::toPose2(T_this_other));
  const double c = std::cos(T_other_this.theta);
  const double s = std::sin(T_other_this.theta);
  for (int y = target.first.y; y <= target.last.y; ++y) {
    auto* cells = row(y) - box_.first.x;
    const double centreY = geometry::cellCentre(y, config_.resolution);
    for (int x = target.first.x; x <= target.last.x; ++x) {
      const double centreX = geometry::cellCentre(x, config_.resolution);
      const Cell seen = other.cell(geometry::cellAt(T_other_this.x + c * centreX - s * centreY,
                                                    T_other_this.y + s * centreX + c * centreY, other.resolution()));
      if (seen == kUnknownCell) continue;
      const int before = cells[x] == kUnknownCell ? 0 : cells[x];
      cells[x] = static_cast<Cell>(std::clamp<int>(before + seen, low_, high_));
    }
  }
}

void OccupancyGrid::save(base::ByteWriter& out) const {
  const auto known = knownBox();
  out << config_.resolution << config_.maxRange << config_.noReturn << config_.hit << config_.miss << config_.clampLow
      << config_.clampHigh << config_.heightBand.least << config_.heightBand.most << known.first.x << known.first.y
      << known.last.x << known.last.y;
  for (int y = known.first.y; y <= known.last.y; ++y) {
    out.append(row(y) + (known.first.x - box_.first.x), static_cast<std::size_t>(known.width()) * sizeof(Cell));
  }
}

void OccupancyGrid::load(base::ByteReader& in, int version) {
  if (version != 1) throw base::Error("expected version 1 of an occupancy grid, found " + std::to_string(version));
  OccupancyGridConfig config;
  geometry::CellBox box;
  in >> config.resolution >> config.maxRange >> config.noReturn >> config.hit >> config.miss >> config.clampLow >>
      config.clampHigh >> config.heightBand.least >> config.heightBand.most >> box.first.x >> box.first.y >>
      box.last.x >> box.last.y;
  requireSound(config);
  const std::size_t cells = in.left() / sizeof(Cell);
  requireCells(box, cells);
  *this = OccupancyGrid(config);
  box_ = box;
  cells_.assign(cells + kLanes, kUnknownCell);
  in.take(cells_.data(), cells * sizeof(Cell));
  const auto isSound = [&](Cell cell) { return cell == kUnknownCell || (cell >= low_ && cell <= high_); };
  if (!std::ranges::all_of(cells_, isSound)) throw base::Error("expected cells within their clamps, found others");
}

Drawing OccupancyGrid::draw() const {
  Drawing drawing;
  const auto known = knownBox();
  if (known.empty()) return drawing;
  DrawnRaster raster;
  raster.corner_in_submap = Eigen::Vector2d(known.first.x, known.first.y) * config_.resolution;
  raster.resolution = config_.resolution;
  raster.pixels = sensors::Image<Rgba>(known.width(), known.height());
  for (int y = known.first.y; y <= known.last.y; ++y) {
    const auto* cells = row(y) - box_.first.x;
    auto* pixels = raster.pixels.row(y - known.first.y) - known.first.x;
    for (int x = known.first.x; x <= known.last.x; ++x) {
      const auto state = stateOf(cells[x]);
      pixels[x] = state == CellState::kUnknown ? kUnknownColor
                  : state == CellState::kFree  ? kFreeColor
                                               : kOccupiedColor;
    }
  }
  drawing.rasters.push_back(std::move(raster));
  return drawing;
}

std::vector<std::pair<std::string, std::string>> OccupancyGrid::summary() const {
  const auto count = [&](CellState state) {
    return std::count_if(cells_.begin(), cells_.end(), [&](Cell cell) { return stateOf(cell) == state; });
  };
  const auto area = [&](CellState state) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.1f m²",
                  static_cast<double>(count(state)) * config_.resolution * config_.resolution);
    return std::string(text.data());
  };
  return {{"free", area(CellState::kFree)}, {"occupied", area(CellState::kOccupied)}};
}

}  // namespace prodomos::map

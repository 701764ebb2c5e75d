// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/ray_fan.hpp"

#include <algorithm>
#include <limits>

namespace prodomos::geometry {

namespace {

constexpr int kUnitsPerCell = 256;

std::int32_t toUnits(double cells) {
  return 2 * static_cast<std::int32_t>(std::floor(cells * (kUnitsPerCell / 2))) + 1;
}

int cellOf(std::int32_t units) {
  return units >> 8;
}

int floorCell(double units) {
  return static_cast<int>(std::floor(units / kUnitsPerCell));
}
int lastCellBefore(double units) {
  return static_cast<int>(std::ceil(units / kUnitsPerCell)) - 1;
}

}  // namespace

std::span<const RayFan::Span> RayFan::trace(const Eigen::Vector2d& origin, std::span<const Eigen::Vector2d> ends) {
  originX_ = toUnits(origin.x());
  const std::int32_t originY = toUnits(origin.y());
  originRow_ = cellOf(originY);
  const double riseUp = (originRow_ + 1) * kUnitsPerCell - originY;
  const double riseDown = originY - originRow_ * kUnitsPerCell;

  spans_.clear();
  up_.clear();
  down_.clear();
  Span ownRow{originRow_, cellOf(originX_), cellOf(originX_)};
  const auto extendOwnRow = [&](Interval interval) {
    ownRow.first = std::min(ownRow.first, interval.first);
    ownRow.last = std::max(ownRow.last, interval.last);
  };

  for (const auto& end : ends) {
    const std::int32_t x = toUnits(end.x());
    const std::int32_t y = toUnits(end.y());
    const int row = cellOf(y);
    if (row == originRow_) {
      extendOwnRow({cellOf(x), cellOf(x)});
      continue;
    }
    const bool up = row > originRow_;
    Ray ray;
    ray.dx = x - originX_;
    ray.dy = up ? y - originY : originY - y;
    ray.slope = ray.dx / ray.dy;
    ray.endRow = up ? row - originRow_ : originRow_ - row;
    ray.endCell = cellOf(x);
    rise_ = up ? riseUp : riseDown;
    extendOwnRow(crossed(ray, 0));
    (up ? up_ : down_).push_back(ray);
  }
  if (!ends.empty()) spans_.push_back(ownRow);
  rise_ = riseUp;
  sweepUpwards(up_, false);
  rise_ = riseDown;
  sweepUpwards(down_, true);
  return spans_;
}

/// The cells of a row above the origin's (0: its own) that the ray passes.
RayFan::Interval RayFan::crossed(const Ray& ray, int row) const {
  const double top = rise_ + static_cast<double>(row) * kUnitsPerCell;
  // Divided last, so that a crossing of a border's corner comes out exactly.
  const double below = row == 0 ? originX_ : originX_ + ray.dx * (top - kUnitsPerCell) / ray.dy;
  if (row == ray.endRow) {
    return ray.dx > 0 ? Interval{floorCell(below), ray.endCell} : Interval{ray.endCell, lastCellBefore(below)};
  }
  const double above = originX_ + ray.dx * top / ray.dy;
  return ray.dx > 0 ? Interval{floorCell(below), lastCellBefore(above)}
                    : Interval{floorCell(above), lastCellBefore(below)};
}

/// Up to this row no cell fits between two neighbouring rays that both pass the whole row.
int RayFan::lastRowWithoutGap(const Ray& right, const Ray& left) const {
  const int lastWhole = std::min(right.endRow, left.endRow) - 1;
  const double spread = right.slope - left.slope;
  if (spread <= 0.0) return lastWhole;
  // The gap in a row is at its narrowest the distance between the right ray's leftmost and the left ray's rightmost
  // point; lean is what the rays' slant within the row takes from it.
  const double lean = std::max({0.0, left.slope, -right.slope});
  const double height = kUnitsPerCell * (1.0 + lean) / spread * (1.0 - 1e-9);  // of the row's lower border
  const double row = (height - rise_) / kUnitsPerCell + 1.0;
  return row <= lastWhole ? static_cast<int>(std::ceil(row)) - 1 : lastWhole;
}

/// Scans come sorted one way or the other, at most begun in the middle.
void RayFan::sortFromRightToLeft(std::vector<Ray>& rays) {
  const auto order = [](const Ray& a, const Ray& b) { return a.slope > b.slope; };
  for (int attempt = 0; attempt < 2; ++attempt) {
    const auto seam = std::is_sorted_until(rays.begin(), rays.end(), order);
    if (seam == rays.end()) return;
    std::rotate(rays.begin(), seam, rays.end());
    if (std::is_sorted(rays.begin(), rays.end(), order)) return;
    std::reverse(rays.begin(), rays.end());
  }
  std::sort(rays.begin(), rays.end(), order);
}

void RayFan::sweepUpwards(std::vector<Ray>& rays, bool mirrored) {
  if (rays.empty()) return;
  sortFromRightToLeft(rays);

  const int count = static_cast<int>(rays.size());
  int lastRow = 0;
  for (const auto& ray : rays) lastRow = std::max(lastRow, ray.endRow);
  expiring_.assign(static_cast<std::size_t>(lastRow) + 1, -1);
  nextExpiring_.resize(rays.size());
  for (int i = count - 2; i >= 0; --i) {
    const auto pair = static_cast<std::size_t>(i);
    const int row = std::max(0, lastRowWithoutGap(rays[pair], rays[pair + 1]));
    auto& first = expiring_[static_cast<std::size_t>(row)];
    nextExpiring_[pair] = first;
    first = i;
  }

  runs_.assign(1, {0, count - 1});
  for (int row = 1; row <= lastRow; ++row) {
    splitRuns(row);
    emitRow(rays, row, mirrored);
  }
}

/// Splits the runs between the pairs whose last row without a gap was the row before.
void RayFan::splitRuns(int row) {
  int pair = expiring_[static_cast<std::size_t>(row) - 1];
  if (pair < 0) return;
  splitRuns_.clear();
  for (auto run : runs_) {
    for (; pair >= 0 && pair < run.last; pair = nextExpiring_[static_cast<std::size_t>(pair)]) {
      splitRuns_.push_back({run.first, pair});
      run.first = pair + 1;
    }
    splitRuns_.push_back(run);
  }
  runs_.swap(splitRuns_);
}

void RayFan::emitRow(const std::vector<Ray>& rays, int row, bool mirrored) {
  intervals_.clear();
  std::size_t kept = 0;
  for (const auto& run : runs_) {
    const auto& right = rays[static_cast<std::size_t>(run.first)];
    if (run.first == run.last) {
      if (right.endRow < row) continue;
      intervals_.push_back(crossed(right, row));
    } else {
      const auto& left = rays[static_cast<std::size_t>(run.last)];
      intervals_.push_back({crossed(left, row).first, crossed(right, row).last});
    }
    runs_[kept++] = run;
    // Runs come from right to left; only rays that end within the row can break the order, and not by far.
    for (auto at = intervals_.size() - 1; at > 0 && intervals_[at].first > intervals_[at - 1].first; --at) {
      std::swap(intervals_[at], intervals_[at - 1]);
    }
  }
  runs_.resize(kept);

  const int y = mirrored ? originRow_ - row : originRow_ + row;
  for (std::size_t i = intervals_.size(); i > 0;) {
    Span span{y, intervals_[i - 1].first, intervals_[i - 1].last};
    for (--i; i > 0 && intervals_[i - 1].first <= span.last + 1; --i) {
      span.last = std::max(span.last, intervals_[i - 1].last);
    }
    spans_.push_back(span);
  }
}

}  // namespace prodomos::geometry

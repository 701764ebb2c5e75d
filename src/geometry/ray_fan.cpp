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

// Without SSE 4.1, which the oldest machines lack, std::floor is a call.
int floorCell(double units) {
  const double cells = units / kUnitsPerCell;
  const int cut = static_cast<int>(cells);
  return cells < cut ? cut - 1 : cut;
}
int lastCellBefore(double units) {
  const double cells = units / kUnitsPerCell;
  const int cut = static_cast<int>(cells);
  return cells > cut ? cut : cut - 1;
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

/// Up to this row no cell fits between two neighbouring rays that both pass the whole row; beyond it, they share none.
int RayFan::lastRowWithoutGap(const Ray& right, const Ray& left, int lastRow) const {
  const double spread = right.slope - left.slope;
  if (spread <= 0.0) return lastRow;
  // The gap in a row is at its narrowest the distance between the right ray's leftmost and the left ray's rightmost
  // point; lean is what the rays' slant within the row takes from it.
  const double lean = std::max({0.0, left.slope, -right.slope});
  const double height = kUnitsPerCell * (1.0 + lean) / spread;  // of the row's lower border
  const double row = (height - rise_) / kUnitsPerCell + 1.0;
  return row < lastRow ? std::max(0, static_cast<int>(row)) : lastRow;
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

  const int lastRow = scheduleSplits(rays);
  runs_.assign(1, {0, static_cast<int>(rays.size()) - 1});
  for (int row = 1; row <= lastRow && !runs_.empty(); ++row) {
    splitRuns(row);
    emitRow(rays, row, mirrored);
  }
  for (const auto& ray : rays) walkAlone(ray, mirrored);
}

/// Finds the row after which each two neighbours part, and from which on each ray is alone. Returns the last row of all.
int RayFan::scheduleSplits(std::vector<Ray>& rays) {
  int lastRow = 0;
  for (const auto& ray : rays) lastRow = std::max(lastRow, ray.endRow);
  expiring_.assign(static_cast<std::size_t>(lastRow) + 1, -1);
  nextExpiring_.resize(rays.size());
  for (std::size_t pair = rays.size() - 1; pair-- > 0;) {
    auto& right = rays[pair];
    auto& left = rays[pair + 1];
    // The bound is rounded, so the row itself counts to both: no run over it, and not yet alone.
    const int bound = lastRowWithoutGap(right, left, lastRow);
    right.aloneFrom = std::max(right.aloneFrom, bound + 2);
    left.aloneFrom = std::max(left.aloneFrom, bound + 2);
    const int row = std::clamp(std::min(right.endRow, left.endRow) - 1, 0, std::max(0, bound - 1));
    auto& first = expiring_[static_cast<std::size_t>(row)];
    nextExpiring_[pair] = first;
    first = static_cast<int>(pair);
  }
  for (auto& ray : rays) ray.aloneFrom = std::max(ray.aloneFrom, 1);
  return lastRow;
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
      if (right.endRow < row || right.aloneFrom <= row) continue;
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

/// The rest of a ray, from the row on from which it shares no cell with others. Crossings in whole numbers, step by step.
void RayFan::walkAlone(const Ray& ray, bool mirrored) {
  if (ray.aloneFrom > ray.endRow) return;
  const auto dx = static_cast<std::int64_t>(ray.dx);
  const auto dy = static_cast<std::int64_t>(ray.dy);
  const auto floorDivision = [dy](std::int64_t number) {
    const std::int64_t quotient = number / dy;
    return number % dy < 0 ? quotient - 1 : quotient;
  };
  // The crossing of the border below the row lies at x + rest / dy units.
  const auto below = static_cast<std::int64_t>(rise_) + (ray.aloneFrom - 1) * std::int64_t{kUnitsPerCell};
  std::int64_t x = floorDivision(dx * below);
  std::int64_t rest = dx * below - x * dy;
  x += originX_;
  const std::int64_t step = floorDivision(dx * kUnitsPerCell);
  const std::int64_t restStep = dx * kUnitsPerCell - step * dy;

  const int sign = mirrored ? -1 : 1;
  int cell = static_cast<int>(x >> 8);
  int cellBefore = (x & 0xFF) == 0 && rest == 0 ? cell - 1 : cell;  // seen from the left of a corner
  for (int row = ray.aloneFrom; row < ray.endRow; ++row) {
    const int from = cell;
    const int fromBefore = cellBefore;
    x += step;
    rest += restStep;
    const bool carry = rest >= dy;
    x += carry ? 1 : 0;
    rest -= carry ? dy : 0;
    cell = static_cast<int>(x >> 8);
    cellBefore = (x & 0xFF) == 0 && rest == 0 ? cell - 1 : cell;
    const bool right = dx > 0;
    spans_.push_back({originRow_ + sign * row, right ? from : cell, right ? cellBefore : fromBefore});
  }
  spans_.push_back({originRow_ + sign * ray.endRow, dx > 0 ? cell : ray.endCell, dx > 0 ? ray.endCell : cellBefore});
}

}  // namespace prodomos::geometry

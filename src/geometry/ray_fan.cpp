// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/ray_fan.hpp"

#include <algorithm>
#include <limits>

namespace prodomos::geometry {

namespace {

constexpr int kUnitsPerCell = 256;

std::int32_t toUnits(double cells) {
  return 2 * static_cast<std::int32_t>(std::floor(cells * (0.5 * kUnitsPerCell))) + 1;
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

/// Where the ray crosses the upper border of a row, 1/256 cells. Divided last, so that a corner comes out exactly.
inline double RayFan::crossing(const Ray& ray, int row) const {
  return originX_ + ray.dx * (rise_ + static_cast<double>(row) * kUnitsPerCell) / ray.dy;
}

inline int RayFan::firstCrossed(const Ray& ray, int row) const {
  if (ray.dx <= 0 && row == ray.endRow) return ray.endCell;
  return floorCell(ray.dx > 0 ? crossing(ray, row - 1) : crossing(ray, row));
}

inline int RayFan::lastCrossed(const Ray& ray, int row) const {
  if (ray.dx > 0 && row == ray.endRow) return ray.endCell;
  return lastCellBefore(ray.dx > 0 ? crossing(ray, row) : crossing(ray, row - 1));
}

/// Sorts the rays by direction; returns the cells of the origin's own row.
RayFan::Span RayFan::begin(const Eigen::Vector2d& origin, std::span<const Eigen::Vector2d> ends) {
  originX_ = toUnits(origin.x());
  const std::int32_t originY = toUnits(origin.y());
  originRow_ = cellOf(originY);
  riseUp_ = (originRow_ + 1) * kUnitsPerCell - originY;
  riseDown_ = originY - originRow_ * kUnitsPerCell;

  up_.clear();
  down_.clear();
  Span own{cellOf(originX_), cellOf(originX_)};
  const auto extendOwn = [&own](int cell) {
    own.first = std::min(own.first, cell);
    own.last = std::max(own.last, cell);
  };
  for (const auto& end : ends) {
    const std::int32_t x = toUnits(end.x());
    const std::int32_t y = toUnits(end.y());
    const int row = cellOf(y);
    if (row == originRow_) {
      extendOwn(cellOf(x));
      continue;
    }
    const bool up = row > originRow_;
    Ray ray;
    ray.dx = x - originX_;
    ray.dy = up ? y - originY : originY - y;
    ray.slope = ray.dx / ray.dy;
    ray.endRow = up ? row - originRow_ : originRow_ - row;
    ray.endCell = cellOf(x);
    rise_ = up ? riseUp_ : riseDown_;
    const double above = crossing(ray, 0);
    extendOwn(ray.dx > 0 ? lastCellBefore(above) : floorCell(above));
    (up ? up_ : down_).push_back(ray);
  }
  sortFromRightToLeft(up_);
  sortFromRightToLeft(down_);
  return own;
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
  if (rays.size() > 2 && order(rays[rays.size() / 2], rays[rays.size() / 2 - 1]))
    std::reverse(rays.begin(), rays.end());
  const auto seam = std::is_sorted_until(rays.begin(), rays.end(), order);
  if (seam == rays.end()) return;
  std::rotate(rays.begin(), seam, rays.end());
  if (!std::is_sorted(rays.begin(), rays.end(), order)) std::sort(rays.begin(), rays.end(), order);
}

/// Finds the row after which each two neighbours part, and from which on each ray is alone.
void RayFan::scheduleSplits(int direction) {
  auto& rays = direction > 0 ? up_ : down_;
  rays_ = &rays;
  rise_ = direction > 0 ? riseUp_ : riseDown_;
  lone_.clear();
  runs_.clear();
  if (rays.empty()) return;
  runs_.push_back({0, static_cast<int>(rays.size()) - 1});

  int lastRow = 0;
  for (auto& ray : rays) {
    lastRow = std::max(lastRow, ray.endRow);
    ray.aloneFrom = 1;
  }
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
}

/// The row's cells of rays that share some. Runs split where a gap has opened in the row before; rays that share no
/// cell from here on leave them.
std::span<const RayFan::Span> RayFan::sweepRow(int row) {
  const auto& rays = *rays_;
  crossed_.clear();
  runsAbove_.clear();
  const auto sweep = [&](Run run) {
    const auto& right = rays[static_cast<std::size_t>(run.first)];
    if (run.first == run.last) {
      if (right.endRow < row) return;
      if (right.aloneFrom <= row) return leaveAlone(right, row);
    }
    crossed_.push_back({firstCrossed(rays[static_cast<std::size_t>(run.last)], row), lastCrossed(right, row)});
    runsAbove_.push_back(run);
    // Runs come from right to left; only rays that end within the row can break the order, and not by far.
    for (auto at = crossed_.size() - 1; at > 0 && crossed_[at].first > crossed_[at - 1].first; --at) {
      std::swap(crossed_[at], crossed_[at - 1]);
    }
  };
  int pair = expiring_[static_cast<std::size_t>(row) - 1];
  for (auto run : runs_) {
    for (; pair >= 0 && pair < run.last; pair = nextExpiring_[static_cast<std::size_t>(pair)]) {
      sweep({run.first, pair});
      run.first = pair + 1;
    }
    sweep(run);
  }
  runs_.swap(runsAbove_);

  spans_.clear();
  for (std::size_t i = crossed_.size(); i > 0;) {
    Span span = crossed_[i - 1];
    for (--i; i > 0 && crossed_[i - 1].first <= span.last + 1; --i)
      span.last = std::max(span.last, crossed_[i - 1].last);
    spans_.push_back(span);
  }
  return spans_;
}

/// From this row on the ray is walked step by step.
void RayFan::leaveAlone(const Ray& ray, int row) {
  const auto dx = static_cast<std::int64_t>(ray.dx);
  const auto dy = static_cast<std::int64_t>(ray.dy);
  const auto floorDivision = [dy](std::int64_t number) {
    const std::int64_t quotient = number / dy;
    return number % dy < 0 ? quotient - 1 : quotient;
  };
  const auto below = static_cast<std::int64_t>(rise_) + (row - 1) * std::int64_t{kUnitsPerCell};
  const std::int64_t x = floorDivision(dx * below);
  const std::int64_t step = floorDivision(dx * kUnitsPerCell);
  const auto narrow = [](std::int64_t number) { return static_cast<std::int32_t>(number); };
  lone_.push_back({narrow(originX_ + x), narrow(dx * below - x * dy), narrow(step),
                   narrow(dx * kUnitsPerCell - step * dy), narrow(dy), row, ray.endRow, ray.endCell, dx > 0});
}

}  // namespace prodomos::geometry

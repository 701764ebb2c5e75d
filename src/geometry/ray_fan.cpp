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

void RayFan::trace(const Eigen::Vector2d& origin, std::span<const Eigen::Vector2d> ends, const Visitor& visit) {
  visit_ = &visit;
  originX_ = toUnits(origin.x());
  const std::int32_t originY = toUnits(origin.y());
  originRow_ = cellOf(originY);
  const double riseUp = (originRow_ + 1) * kUnitsPerCell - originY;
  const double riseDown = originY - originRow_ * kUnitsPerCell;

  up_.clear();
  down_.clear();
  Span ownRow{cellOf(originX_), cellOf(originX_)};
  const auto extendOwnRow = [&](Span span) {
    ownRow.first = std::min(ownRow.first, span.first);
    ownRow.last = std::max(ownRow.last, span.last);
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
    // The own row is crossed from the origin to the upper border.
    const double above = crossing(ray, 0);
    extendOwnRow(ray.dx > 0 ? Span{cellOf(originX_), lastCellBefore(above)}
                            : Span{floorCell(above), cellOf(originX_)});
    (up ? up_ : down_).push_back(ray);
  }
  if (!ends.empty()) visit(originRow_, std::span(&ownRow, 1));
  rise_ = riseUp;
  sweepUpwards(up_, false);
  rise_ = riseDown;
  sweepUpwards(down_, true);
}

/// Where the ray crosses the upper border of a row, 1/256 cells. Divided last, so that a corner comes out exactly.
double RayFan::crossing(const Ray& ray, int row) const {
  return originX_ + ray.dx * (rise_ + static_cast<double>(row) * kUnitsPerCell) / ray.dy;
}

int RayFan::firstCrossed(const Ray& ray, int row) const {
  if (ray.dx <= 0 && row == ray.endRow) return ray.endCell;
  return floorCell(ray.dx > 0 ? crossing(ray, row - 1) : crossing(ray, row));
}

int RayFan::lastCrossed(const Ray& ray, int row) const {
  if (ray.dx > 0 && row == ray.endRow) return ray.endCell;
  return lastCellBefore(ray.dx > 0 ? crossing(ray, row) : crossing(ray, row - 1));
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
  leaningRight_.clear();
  leaningLeft_.clear();
  for (int row = 1; row <= lastRow; ++row) {
    spans_.clear();
    splitRuns(row);
    addRuns(rays, row);
    addAlone(leaningRight_, true, row);
    addAlone(leaningLeft_, false, row);
    (*visit_)(mirrored ? originRow_ - row : originRow_ + row, spans_);
  }
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

/// The row's cells of rays that share some. Rays that share none from here on leave the runs.
void RayFan::addRuns(const std::vector<Ray>& rays, int row) {
  auto& crossed = crossedByRuns_;
  crossed.clear();
  std::size_t kept = 0;
  for (const auto& run : runs_) {
    const auto& right = rays[static_cast<std::size_t>(run.first)];
    if (run.first == run.last) {
      if (right.endRow < row) continue;
      if (right.aloneFrom <= row) {
        leaveAlone(right, row);
        continue;
      }
    }
    crossed.push_back({firstCrossed(rays[static_cast<std::size_t>(run.last)], row), lastCrossed(right, row)});
    runs_[kept++] = run;
    // Runs come from right to left; only rays that end within the row can break the order, and not by far.
    for (auto at = crossed.size() - 1; at > 0 && crossed[at].first > crossed[at - 1].first; --at) {
      std::swap(crossed[at], crossed[at - 1]);
    }
  }
  runs_.resize(kept);

  for (std::size_t i = crossed.size(); i > 0;) {
    Span span = crossed[i - 1];
    for (--i; i > 0 && crossed[i - 1].first <= span.last + 1; --i) span.last = std::max(span.last, crossed[i - 1].last);
    spans_.push_back(span);
  }
}

/// From this row on the ray's crossings are followed step by step.
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
  (dx > 0 ? leaningRight_ : leaningLeft_)
      .add(ray, originX_ + x, dx * below - x * dy, step, dx * kUnitsPerCell - step * dy);
}

void RayFan::addAlone(LoneRays& rays, bool leanRight, int row) {
  // A corner belongs to neither of the cells that only touch there: from the left, the cell before it was the last.
  const auto isCorner = [](std::int32_t x, std::int32_t rest) {
    return static_cast<int>((x & (kUnitsPerCell - 1)) == 0) & static_cast<int>(rest == 0);
  };
  for (std::size_t i = 0; rays.nextEnd == row && i < rays.x.size();) {
    if (rays.endRow[i] > row) {
      ++i;
      continue;
    }
    const int cell = cellOf(rays.x[i]);
    spans_.push_back(leanRight ? Span{cell, rays.endCell[i]}
                               : Span{rays.endCell[i], cell - isCorner(rays.x[i], rays.rest[i])});
    rays.remove(i);
  }
  if (rays.nextEnd == row) {
    rays.nextEnd = rays.endRow.empty() ? 0 : *std::min_element(rays.endRow.begin(), rays.endRow.end());
  }

  const auto begin = spans_.size();
  const auto count = rays.x.size();
  spans_.resize(begin + count);
  // Without branches on what chance decides, and without aliases, so that the compiler takes several rays at a time.
  Span* __restrict const spans = spans_.data() + begin;
  std::int32_t* __restrict const xs = rays.x.data();
  std::int32_t* __restrict const rests = rays.rest.data();
  const std::int32_t* __restrict const steps = rays.step.data();
  const std::int32_t* __restrict const restSteps = rays.restStep.data();
  const std::int32_t* __restrict const dys = rays.dy.data();
  const auto follow = [=](auto toSpan) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::int32_t x = xs[i];
      const std::int32_t rest = rests[i];
      const std::int32_t sum = rest + restSteps[i];
      const std::int32_t carry = -static_cast<std::int32_t>(sum >= dys[i]);  // all bits or none
      xs[i] = x + steps[i] - carry;
      rests[i] = sum - (dys[i] & carry);
      spans[i] = toSpan(x, rest, xs[i], rests[i]);
    }
  };
  if (leanRight) {
    follow([&](auto x, auto, auto nextX, auto nextRest) {
      return Span{cellOf(x), cellOf(nextX) - isCorner(nextX, nextRest)};
    });
  } else {
    follow([&](auto x, auto rest, auto nextX, auto) { return Span{cellOf(nextX), cellOf(x) - isCorner(x, rest)}; });
  }
}

void RayFan::LoneRays::clear() {
  for (auto* values : {&x, &rest, &step, &restStep, &dy}) values->clear();
  endRow.clear();
  endCell.clear();
  nextEnd = 0;
}

void RayFan::LoneRays::add(const Ray& ray, std::int64_t atX, std::int64_t atRest, std::int64_t stepX,
                           std::int64_t stepRest) {
  x.push_back(static_cast<std::int32_t>(atX));
  rest.push_back(static_cast<std::int32_t>(atRest));
  step.push_back(static_cast<std::int32_t>(stepX));
  restStep.push_back(static_cast<std::int32_t>(stepRest));
  dy.push_back(static_cast<std::int32_t>(ray.dy));
  endRow.push_back(ray.endRow);
  endCell.push_back(ray.endCell);
  nextEnd = nextEnd == 0 ? ray.endRow : std::min(nextEnd, ray.endRow);
}

void RayFan::LoneRays::remove(std::size_t i) {
  for (auto* values : {&x, &rest, &step, &restStep, &dy, &endRow, &endCell}) {
    (*values)[i] = values->back();
    values->pop_back();
  }
}

}  // namespace prodomos::geometry

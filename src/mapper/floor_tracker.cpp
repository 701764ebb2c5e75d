// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/floor_tracker.hpp"

#include <algorithm>
#include <cmath>

namespace prodomos::mapper {

namespace {
constexpr double kLevelWay = 1.0;  // metres; longer than the tread of any step
}  // namespace

bool FloorTracker::update(double height, double distance) {
  if (std::abs(height - levelHeight_) > kLevelTolerance) {
    levelHeight_ = height;
    levelFrom_ = distance;
  }
  const double rise = levelHeight_ - current().height;
  if (distance - levelFrom_ < kLevelWay || std::abs(rise) < leastHeight_) return false;

  const auto isHere = [&](const map::Floor& floor) { return std::abs(floor.height - levelHeight_) < leastHeight_ / 2; };
  auto known = std::ranges::find_if(floors_, isHere);
  if (known == floors_.end()) {
    const auto [lowest, highest] = std::ranges::minmax(floors_, {}, &map::Floor::number);
    floors_.push_back({rise > 0.0 ? highest.number + 1 : lowest.number - 1, levelHeight_});
    known = std::prev(floors_.end());
  }
  current_ = static_cast<std::size_t>(known - floors_.begin());
  return true;
}

void FloorTracker::save(base::ByteWriter& out) const {
  out << static_cast<std::uint64_t>(floors_.size()) << static_cast<std::uint64_t>(current_) << levelHeight_
      << levelFrom_;
  for (const auto& floor : floors_) out << floor.number << floor.height;
}

void FloorTracker::load(base::ByteReader& in) {
  floors_.resize(in.read<std::uint64_t>());
  current_ = static_cast<std::size_t>(in.read<std::uint64_t>());
  in >> levelHeight_ >> levelFrom_;
  for (auto& floor : floors_) in >> floor.number >> floor.height;
}

}  // namespace prodomos::mapper

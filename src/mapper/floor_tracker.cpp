// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/floor_tracker.hpp"

#include <algorithm>
#include <cmath>

namespace prodomos::mapper {

namespace {

constexpr double kThinning = 0.05;  // metres

// Stairs rise at least 20 degrees: on this way along them, more than the tolerance to both sides.
constexpr double kLevelWay = 1.5;
constexpr double kArrivedWay = 0.5;  // metres; the end of the level way, which no stair reaches into

// Metres travelled per metre climbed: 1 in a lift, 1.4 on the steepest stairs.
constexpr double kMostWayInLift = 1.2;

}  // namespace

std::optional<map::EdgeKind> FloorTracker::update(double height, double distance) {
  remember({distance, height});
  if (std::abs(height - current().height) < kLevelTolerance) left_ = {distance, height};
  const auto level = findOtherLevel();
  if (!level) return std::nullopt;
  const auto way = wayUpOrDown();
  current_ = floorAt(*level);
  left_ = {distance, height};
  return way;
}

void FloorTracker::remember(const Sample& sample) {
  const bool isNew = recent_.empty() || sample.distance - recent_.back().distance >= kThinning ||
                     std::abs(sample.height - recent_.back().height) >= kThinning;
  if (isNew) recent_.push_back(sample);
  while (recent_.size() > 1 && recent_[1].distance <= sample.distance - kLevelWay) recent_.pop_front();
}

/// The height at which the robot goes, if it goes level and a storey away from the current floor.
std::optional<double> FloorTracker::findOtherLevel() const {
  const double end = recent_.back().distance;
  if (end - recent_.front().distance < kLevelWay) return std::nullopt;
  const auto [lowest, highest] = std::ranges::minmax(recent_, {}, &Sample::height);
  if (highest.height - lowest.height > 2.0 * kLevelTolerance) return std::nullopt;
  const double floor = current().height;  // all of the way, or else a landing would do with the next steps upwards
  if (lowest.height - floor < leastHeight_ && floor - highest.height < leastHeight_) return std::nullopt;
  double sum = 0.0;
  int count = 0;
  for (const auto& sample : recent_) {
    if (sample.distance < end - kArrivedWay) continue;
    sum += sample.height;
    ++count;
  }
  return sum / count;
}

/// How it climbed since it left the current floor, now that it goes level.
map::EdgeKind FloorTracker::wayUpOrDown() const {
  const auto& arrived = recent_.front();
  const double way = arrived.distance - left_.distance;
  const double climb = std::abs(arrived.height - left_.height);
  return way < kMostWayInLift * climb ? map::EdgeKind::kLift : map::EdgeKind::kStairs;
}

/// The known floor at this height, or a new one.
std::size_t FloorTracker::floorAt(double height) {
  const auto isHere = [&](const map::Floor& floor) { return std::abs(floor.height - height) < leastHeight_ / 2; };
  auto known = std::ranges::find_if(floors_, isHere);
  if (known == floors_.end()) {
    const auto [lowest, highest] = std::ranges::minmax(floors_, {}, &map::Floor::number);
    floors_.push_back({height > current().height ? highest.number + 1 : lowest.number - 1, height});
    known = std::prev(floors_.end());
  }
  return static_cast<std::size_t>(known - floors_.begin());
}

void FloorTracker::save(base::ByteWriter& out) const {
  out << static_cast<std::uint64_t>(floors_.size()) << static_cast<std::uint64_t>(current_) << left_.distance
      << left_.height << static_cast<std::uint64_t>(recent_.size());
  for (const auto& floor : floors_) out << floor.number << floor.height;
  for (const auto& sample : recent_) out << sample.distance << sample.height;
}

void FloorTracker::load(base::ByteReader& in) {
  floors_.resize(in.read<std::uint64_t>());
  current_ = static_cast<std::size_t>(in.read<std::uint64_t>());
  in >> left_.distance >> left_.height;
  recent_.resize(in.read<std::uint64_t>());
  for (auto& floor : floors_) in >> floor.number >> floor.height;
  for (auto& sample : recent_) in >> sample.distance >> sample.height;
}

}  // namespace prodomos::mapper

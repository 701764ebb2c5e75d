// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/half_disc.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace prodomos::evaluation {

void accumulate(ByRadius& sums) {
  std::partial_sum(sums.begin(), sums.end(), sums.begin());
}

void add(ByRadius& sums, const ByRadius& others) {
  std::ranges::transform(sums, others, sums.begin(), std::plus<>());
}

std::size_t radiusIndex(double distance) {
  return std::min(static_cast<std::size_t>(distance / kRadiusStep), kRadiusSteps);
}

void HalfDiscs::addBehind(const geometry::Pose2& T_world_door,
                          const std::function<std::optional<CellFate>(geometry::CellIndex)>& fateOf) {
  constexpr double kReach = kRadiusSteps * kRadiusStep;
  HalfDiscs behind;
  for (const auto cell : cellsIn(boxBehind(T_world_door, kReach, -kReach, kWallHalf, kReach))) {
    const Eigen::Vector2d centre = centreOf(cell);
    const auto radius = radiusIndex(std::hypot(centre.x() - T_world_door.x, centre.y() - T_world_door.y));
    if (radius >= kRadiusSteps) continue;
    const auto fate = fateOf(cell);
    if (!fate) continue;
    behind.all[radius] += 1.0;
    if (*fate == CellFate::kRight) behind.right[radius] += 1.0;
    if (*fate == CellFate::kWrong) behind.wrong[radius] += 1.0;
  }
  for (auto* sums : {&behind.all, &behind.right, &behind.wrong}) accumulate(*sums);
  *this += behind;
}

std::optional<double> HalfDiscs::precisionAt(double cells) const {
  if (cells <= 0.0) return std::nullopt;
  const auto enough = std::ranges::lower_bound(all, cells);
  if (enough == all.end()) return std::nullopt;
  const auto radius = static_cast<std::size_t>(enough - all.begin());
  const double judged = right[radius] + wrong[radius];
  if (judged <= 0.0) return std::nullopt;
  return right[radius] / judged;
}

HalfDiscs& HalfDiscs::operator+=(const HalfDiscs& other) {
  add(all, other.all);
  add(right, other.right);
  add(wrong, other.wrong);
  return *this;
}

}  // namespace prodomos::evaluation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace prodomos::evaluation {

namespace {

constexpr double kSameThreshold = 0.005;

const Polygon* findArea(const ClaimedSpace& space, double threshold) {
  for (const auto& [ofArea, outline] : space.areas_in_world) {
    if (std::abs(ofArea - threshold) < kSameThreshold) return &outline;
  }
  return nullptr;
}

CellCounts countCells(const Scene& scene, const ClaimedSpace& space, const Polygon& outline) {
  const auto& plan = scene.plans[static_cast<std::size_t>(*space.storey)];
  CellCounts counts;
  for (const auto cell : cellsIn(outline)) {
    if (scene.known.isKnown(*space.storey, cell, space.made)) continue;
    if (!plan.isFloor(cell, space.made)) {
      ++counts.wrong;
      continue;
    }
    ++counts.right;
    if (plan.isFurnished(cell)) ++counts.furnished;
  }
  return counts;
}

/// Adds the unknown cells of half-discs behind the door.
void addHalfDiscs(const Scene& scene, const ClaimedSpace& space, const ClaimedDoor& door, FreeSpaceLevel& level) {
  constexpr double kReach = kRadiusSteps * kRadiusStep;
  const auto& plan = scene.plans[static_cast<std::size_t>(*space.storey)];
  ByRadius right{};
  ByRadius all{};
  for (const auto cell : cellsIn(boxBehind(door.T_world_door, kReach, -kReach, kWallHalf, kReach))) {
    const Eigen::Vector2d centre = centreOf(cell);
    const auto radius = radiusIndex(std::hypot(centre.x() - door.T_world_door.x, centre.y() - door.T_world_door.y));
    if (radius >= kRadiusSteps || scene.known.isKnown(*space.storey, cell, space.made)) continue;
    all[radius] += 1.0;
    if (plan.isFloor(cell, space.made)) right[radius] += 1.0;
  }
  accumulate(right);
  accumulate(all);
  add(level.halfDiscRight, right);
  add(level.halfDiscAll, all);
}

FreeSpaceLevel scoreLevel(const Scene& scene, double threshold) {
  FreeSpaceLevel level;
  std::set<std::pair<int, geometry::CellIndex>> gained;
  for (const auto& space : scene.claims.spaces) {
    const Polygon* outline = findArea(space, threshold);
    if (outline == nullptr || !space.storey || !space.mobility) continue;
    ++level.areas;
    level.byMobility[static_cast<std::size_t>(*space.mobility)] += countCells(scene, space, *outline);
    if (const auto* door = scene.findDoor(space.cause)) {
      ++level.doors;
      addHalfDiscs(scene, space, *door, level);
    }
    if (space.state == map::PredictionState::kRefuted) continue;
    for (const auto cell : cellsIn(*outline)) {
      if (!scene.known.isKnown(*space.storey, cell)) gained.emplace(*space.storey, cell);
    }
  }
  level.gained = gained.size();
  return level;
}

}  // namespace

CellCounts& CellCounts::operator+=(const CellCounts& other) {
  right += other.right;
  wrong += other.wrong;
  furnished += other.furnished;
  return *this;
}

CellCounts FreeSpaceLevel::overall() const {
  CellCounts sum;
  for (const auto& counts : byMobility) sum += counts;
  return sum;
}

std::optional<double> FreeSpaceLevel::areaPerDoor() const {
  if (doors == 0) return std::nullopt;
  const auto& counts = byMobility[static_cast<std::size_t>(map::Mobility::kQuasiStatic)];
  return static_cast<double>(counts.right + counts.wrong) * kCell * kCell / static_cast<double>(doors);
}

std::optional<double> FreeSpaceLevel::halfDiscPrecision() const {
  const auto& counts = byMobility[static_cast<std::size_t>(map::Mobility::kQuasiStatic)];
  const auto predicted = static_cast<double>(counts.right + counts.wrong);
  if (predicted == 0.0) return std::nullopt;
  const auto enough = std::ranges::lower_bound(halfDiscAll, predicted);
  if (enough == halfDiscAll.end()) return std::nullopt;
  return halfDiscRight[static_cast<std::size_t>(enough - halfDiscAll.begin())] / *enough;
}

FreeSpaceLevel& FreeSpaceLevel::operator+=(const FreeSpaceLevel& other) {
  for (std::size_t i = 0; i < byMobility.size(); ++i) byMobility[i] += other.byMobility[i];
  areas += other.areas;
  gained += other.gained;
  doors += other.doors;
  add(halfDiscRight, other.halfDiscRight);
  add(halfDiscAll, other.halfDiscAll);
  return *this;
}

std::optional<double> FreeSpaceScore::areaGainPercent(std::size_t level) const {
  if (observedFree <= 0.0 || levels[level].areas == 0) return std::nullopt;
  return 100.0 * static_cast<double>(levels[level].gained) * kCell * kCell / observedFree;
}

FreeSpaceScore& FreeSpaceScore::operator+=(const FreeSpaceScore& other) {
  for (std::size_t i = 0; i < levels.size(); ++i) levels[i] += other.levels[i];
  observedFree += other.observedFree;
  return *this;
}

FreeSpaceScore scoreFreeSpace(const Scene& scene) {
  FreeSpaceScore score;
  for (std::size_t i = 0; i < kThresholds.size(); ++i) score.levels[i] = scoreLevel(scene, kThresholds[i]);
  score.observedFree = scene.known.freeArea();
  return score;
}

}  // namespace prodomos::evaluation

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

/// None of a cell that was known when the prediction was made.
std::optional<CellFate> fateOf(const Scene& scene, const ClaimedSpace& space, geometry::CellIndex cell) {
  if (scene.known.isKnown(*space.storey, cell, space.made)) return std::nullopt;
  const auto& plan = scene.plans[static_cast<std::size_t>(*space.storey)];
  return plan.isFloor(cell, space.made) ? CellFate::kRight : CellFate::kWrong;
}

CellCounts countCells(const Scene& scene, const ClaimedSpace& space, const Polygon& outline) {
  const auto& plan = scene.plans[static_cast<std::size_t>(*space.storey)];
  CellCounts counts;
  for (const auto cell : cellsIn(outline)) {
    const auto fate = fateOf(scene, space, cell);
    if (fate == CellFate::kWrong) ++counts.wrong;
    if (fate != CellFate::kRight) continue;
    ++counts.right;
    if (plan.isFurnished(cell)) ++counts.furnished;
  }
  return counts;
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
      level.halfDiscs.addBehind(door->T_world_door,
                                [&](geometry::CellIndex cell) { return fateOf(scene, space, cell); });
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

const Polygon* findArea(const ClaimedSpace& space, double threshold) {
  for (const auto& [ofArea, outline] : space.areas_in_world) {
    if (std::abs(ofArea - threshold) < kSameThreshold) return &outline;
  }
  return nullptr;
}

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
  return halfDiscs.precisionAt(static_cast<double>(counts.right + counts.wrong));
}

FreeSpaceLevel& FreeSpaceLevel::operator+=(const FreeSpaceLevel& other) {
  for (std::size_t i = 0; i < byMobility.size(); ++i) byMobility[i] += other.byMobility[i];
  areas += other.areas;
  gained += other.gained;
  doors += other.doors;
  halfDiscs += other.halfDiscs;
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

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/doorway_detector.hpp"

#include "perception/doorway_lines.hpp"
#include "perception/doorway_narrows.hpp"
#include "perception/doorway_raster.hpp"

#include <algorithm>
#include <numbers>

namespace prodomos::perception {

namespace {

constexpr std::size_t kMostDirections = 4;
constexpr double kBeyond = 0.5;  // metres farther than ways around it may lead
constexpr double kApart = 0.5;   // metres; nearer ones are one doorway, seen in two directions or two faces of a wall

DoorSighting sightingOf(const doorways::Opening& opening) {
  DoorSighting sighting;
  sighting.T_submap_door = geometry::toPose3({opening.middle.x(), opening.middle.y(), opening.direction});
  sighting.covariance.diagonal() << opening.sigma * opening.sigma, opening.sigma * opening.sigma, 0.01, 0.0004;
  sighting.door.hasLeaf = false;
  sighting.door.state = map::DoorState::kOpen;
  sighting.door.width = opening.width;
  sighting.widthSigma = opening.sigma;
  sighting.evidence = opening.evidence;
  return sighting;
}

/// Most lines are none, and that is seen from near by.
void appendOpeningsAcross(const doorways::CriticalLine& line, const map::OccupancyGrid& grid,
                          const DoorwayDetectorConfig& config, std::vector<doorways::Opening>& openings) {
  const double wallsReach = line.width() + config.leastWall + config.leastSpace;
  std::vector<doorways::Opening> across;
  for (const double reach : {wallsReach, config.leastDetour + kBeyond}) {
    const doorways::Raster raster(grid, line.direction(), line.middle(), reach);
    across.clear();
    doorways::appendOpeningsAt(line.middle(), raster, config, across);
    if (across.empty()) return;
  }
  openings.insert(openings.end(), across.begin(), across.end());
}

}  // namespace

void describe(base::ConfigVisitor& visitor, DoorwayDetectorConfig& config) {
  visitor.section("doorways", "openings in the walls of a grid");
  visitor.key("enabled", config.enabled, "look for them");
  visitor.key("least_width", config.leastWidth, "m", {0.3, 2.0}, "between the jambs");
  visitor.key("most_width", config.mostWidth, "m", {0.6, 10.0}, "wider gaps are parts of one room");
  visitor.key("most_thickness", config.mostThickness, "m", {0.05, 2.0}, "of the wall; deeper ones are corridors");
  visitor.key("least_wall", config.leastWall, "m", {0.0, 5.0}, "beside the jambs; less is furniture or a person");
  visitor.key("least_space", config.leastSpace, "m", {0.0, 5.0}, "free before and behind; less is a niche");
  visitor.key("least_detour", config.leastDetour, "m", {0.0, 20.0},
              "what one can go around on a shorter way is a gap between furniture");
  visitor.endSection();
}

std::vector<DoorSighting> findDoorways(const map::OccupancyGrid& grid, const Eigen::Vector2d& observer_in_submap,
                                       const DoorwayDetectorConfig& config) {
  if (!config.enabled) return {};
  std::vector<doorways::Opening> openings;
  for (const auto& raster : doorways::rastersAlongWalls(grid, kMostDirections)) {
    doorways::appendOpenings(raster, config, openings);
    doorways::appendOpenings(raster.turned(), config, openings);
  }
  const auto isFound = [&openings](const Eigen::Vector2d& middle) {
    return std::ranges::any_of(openings, [&](const auto& other) { return (other.middle - middle).norm() < kApart; });
  };
  for (const auto& line : doorways::criticalLines(grid, config)) {
    if (!isFound(line.middle())) appendOpeningsAcross(line, grid, config, openings);
  }
  std::stable_sort(openings.begin(), openings.end(),
                   [](const auto& a, const auto& b) { return a.evidence > b.evidence; });
  std::vector<DoorSighting> found;
  for (const auto& opening : openings) {
    const bool isKnown = std::any_of(found.begin(), found.end(), [&](const DoorSighting& other) {
      return (other.T_submap_door.translation().head<2>() - opening.middle).norm() < kApart;
    });
    if (isKnown) continue;
    auto sighting = sightingOf(opening);
    if (sighting.T_submap_door.linear().col(0).head<2>().dot(opening.middle - observer_in_submap) < 0.0) {
      sighting.T_submap_door.rotate(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()));
    }
    found.push_back(std::move(sighting));
  }
  return found;
}

}  // namespace prodomos::perception

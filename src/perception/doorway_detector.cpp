// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/doorway_detector.hpp"

#include "perception/doorway_lines.hpp"
#include "perception/doorway_narrows.hpp"
#include "perception/doorway_raster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace prodomos::perception {

using map::CellState;

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

/// The states of the cells in a rectangle.
class Patch {
 public:
  void add(CellState state) { ++counts_[static_cast<std::size_t>(state)]; }
  /// 0 of an empty one.
  double shareOf(CellState state) const {
    const int all = std::accumulate(counts_.begin(), counts_.end(), 0);
    return all == 0 ? 0.0 : static_cast<double>(counts_[static_cast<std::size_t>(state)]) / all;
  }

 private:
  std::array<int, 3> counts_{};
};

struct Rectangle {
  Eigen::Vector2d least;
  Eigen::Vector2d most;
};

/// The rectangle is in the axes of `T_submap_axes`; its cells, to within half a one.
Patch cellsWithin(const map::OccupancyGrid& grid, const geometry::Pose2& T_submap_axes, const Rectangle& rectangle) {
  constexpr double kSlack = 1e-9;
  Patch patch;
  for (double x = rectangle.least.x(); x <= rectangle.most.x() + kSlack; x += grid.resolution()) {
    for (double y = rectangle.least.y(); y <= rectangle.most.y() + kSlack; y += grid.resolution())
      patch.add(grid.state(grid.cellAt(T_submap_axes * Eigen::Vector2d(x, y))));
  }
  return patch;
}

/// Whether there is something to be seen beyond: of the ways straight on and up to 50 degrees aside, some end at it.
/// Beams that go through glass into the open come back from nothing.
bool leadsSomewhere(const map::OccupancyGrid& grid, const Eigen::Vector2d& middle, double direction) {
  constexpr int kWays = 21;
  constexpr int kLeastEnds = 3;
  constexpr double kFan = 100.0 / 180.0 * std::numbers::pi;
  constexpr double kJambs = 0.5;  // metres from the middle, beyond the jambs
  constexpr double kReach = 12.0;
  int ends = 0;
  for (int i = 0; i < kWays; ++i) {
    const double angle = direction + kFan * (static_cast<double>(i) / (kWays - 1) - 0.5);
    const Eigen::Vector2d ahead(std::cos(angle), std::sin(angle));
    auto state = CellState::kFree;
    for (double way = kJambs; way < kReach && state == CellState::kFree; way += grid.resolution()) {
      state = grid.state(grid.cellAt(middle + way * ahead));
    }
    if (state == CellState::kOccupied) ++ends;
  }
  return ends >= kLeastEnds;
}

bool joinsSpaces(const map::OccupancyGrid& grid, const doorways::Opening& opening) {
  return leadsSomewhere(grid, opening.middle, opening.direction) &&
         leadsSomewhere(grid, opening.middle, opening.direction + std::numbers::pi);
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
    if (isKnown || !joinsSpaces(grid, opening)) continue;
    auto sighting = sightingOf(opening);
    if (sighting.T_submap_door.linear().col(0).head<2>().dot(opening.middle - observer_in_submap) < 0.0) {
      sighting.T_submap_door.rotate(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()));
    }
    found.push_back(std::move(sighting));
  }
  return found;
}

bool showsNoDoorway(const map::OccupancyGrid& grid, const geometry::Pose2& T_submap_doorway, double width) {
  if (grid.state(grid.cellAt({T_submap_doorway.x, T_submap_doorway.y})) != CellState::kFree) return false;
  const double half = 0.5 * width;
  // In the doorway's axes: x along its normal, y along the wall. What is within 12 cm of a jamb may be its noise.
  const auto gap = cellsWithin(grid, T_submap_doorway, {{-0.6, 0.12 - half}, {0.6, half - 0.12}});
  if (gap.shareOf(CellState::kFree) + gap.shareOf(CellState::kOccupied) < 0.9 ||
      gap.shareOf(CellState::kOccupied) > 0.05)
    return false;
  int open = 0;
  int blocked = 0;
  for (const double side : {-1.0, 1.0}) {
    const auto jamb = cellsWithin(grid, T_submap_doorway, {{-0.15, side * half - 0.12}, {0.15, side * half + 0.12}});
    if (jamb.shareOf(CellState::kOccupied) == 0.0) return true;
    for (const double x : {-0.4, 0.2}) {  // a corner: a hand beyond the wall's middle, beside the jamb
      const double first = side * (half + 0.06) - 0.04;
      const auto corner = cellsWithin(grid, T_submap_doorway, {{x, first}, {x + 0.2, first + 0.08}});
      if (corner.shareOf(CellState::kFree) > 0.5) {
        ++open;
      } else if (corner.shareOf(CellState::kOccupied) > 0.33) {
        ++blocked;
      }
    }
  }
  return blocked >= 2 || open + blocked == 4;
}

}  // namespace prodomos::perception

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/social.hpp"

#include "prodomos/map/personal_space.hpp"

#include "exporter/contents.hpp"

#include <algorithm>
#include <cmath>

namespace prodomos::exporter {
namespace {

constexpr double kSigma = 0.5;       // metres: at 1.2 m, where Hall's personal distance ends, a twentieth is left
constexpr double kSkew = 1.0;        // as prediction.person_skew
constexpr double kLeastCost = 0.05;  // less is nobody's
constexpr double kBody = 0.35;       // metres; what is nearer may be the person

/// Whether nothing known stands between.
bool isSeen(const map::OccupancyGrid& grid, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const double distance = (to - from).norm();
  for (double along = kBody; along < distance; along += grid.resolution() / 2.0) {
    const Eigen::Vector2d passed = from + (to - from) * (along / distance);
    if (grid.state(grid.cellAt(passed)) == map::CellState::kOccupied) return false;
  }
  return true;
}

void addPerson(const geometry::Pose2& T_map_person, int dominantSide, const map::OccupancyGrid& grid,
               geometry::CellMap<float>& costs) {
  const auto space = map::personalSpace(T_map_person, dominantSide, kSigma, kSkew);  // 002 eq. (5)
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(space.reach(kLeastCost));
  const auto first = grid.cellAt(space.centre() - reach);
  const auto last = grid.cellAt(space.centre() + reach);
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) {
      float* cost = costs.find({x, y});
      const Eigen::Vector2d centre = geometry::centreOf({x, y}, grid.resolution());
      const double own = space.relativeDensity(centre);
      if (cost == nullptr || own < kLeastCost || own <= static_cast<double>(*cost)) continue;
      if (isSeen(grid, space.centre(), centre)) *cost = static_cast<float>(own);
    }
  }
}

}  // namespace

geometry::CellMap<float> socialCosts(const map::MapView& view, std::optional<int> floor,
                                     const map::OccupancyGrid& grid) {
  geometry::CellMap<float> costs(grid.knownBox(), 0.0F);
  for (const auto& entity : view.entities()) {
    const auto* const human = std::get_if<map::Human>(&entity.attributes);
    if (human == nullptr || !onFloor(view.graph().getNode(entity.submap).floor, floor)) continue;
    const auto T_map_person = poseInMap(view, entity);
    if (!geometry::isFinite(T_map_person)) continue;
    addPerson(geometry::toPose2(T_map_person), human->dominantSide, grid, costs);
  }
  return costs;
}

}  // namespace prodomos::exporter

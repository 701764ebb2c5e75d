// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/submap_matcher.hpp"

#include <algorithm>
#include <cmath>

namespace prodomos::localization {

namespace {

constexpr int kLevels = 7;
constexpr double kSearchSpacing = 0.2;  // metres between the points that are searched with
// The windows in which no other pose competes: what the refinement reaches anyway.
constexpr double kSmallReach = 0.5;  // metres
constexpr double kSameReach = 1.0;   // metres, radians; poses nearer than this are one place
// Points of one wall err together: by what the sub-map itself is bent. So many of them count as one.
constexpr double kCorrelated = 20.0;
// A heap of points, as thick as it is wide, is a bush or a crowd: beams pass it, and pass it not.
constexpr double kMostThickness = 0.5;  // of the extent
// Which side a wall was seen from.
constexpr double kSideReach = 0.2;   // metres around a place, where free cells are weighed against unknown ones
constexpr double kLeastSide = 0.25;  // of a straight wall seen from one side alone it is nearly 0.6

std::vector<Eigen::Vector2d> positions(const map::SurfaceLayer& surface) {
  std::vector<Eigen::Vector2d> positions;
  positions.reserve(surface.points().size());
  for (const auto& point : surface.points()) positions.push_back(point.position_in_submap());
  return positions;
}

/// One of them per square.
std::vector<Eigen::Vector2d> thinned(const map::SurfaceLayer& surface, double spacing) {
  map::SurfaceLayer coarse({.resolution = spacing});
  for (const auto& point : surface.points()) coarse.insert(point.position_in_submap());
  return positions(coarse);
}

struct Comparison {
  int agreeing = 0;
  int conflicting = 0;
};

/// Is this point of a surface part of a wall?
bool isOfWall(const map::SurfaceLayer& surface, const Eigen::Vector2d& point) {
  const auto patch = surface.patchAt(point);
  return patch && patch->thickness <= kMostThickness * patch->extent;
}

/// From a wall to the side that it was seen from, as long as that is certain; near zero where it was seen from both.
Eigen::Vector2d seenSide(const map::OccupancyGrid& grid, const Eigen::Vector2d& place) {
  const int reach = static_cast<int>(kSideReach / grid.resolution());
  const auto middle = grid.cellAt(place);
  Eigen::Vector2d side = Eigen::Vector2d::Zero();
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      if (x == 0 && y == 0) continue;
      const auto state = grid.state({middle.x + x, middle.y + y});
      const double sign = state == map::CellState::kFree ? 1.0 : state == map::CellState::kUnknown ? -1.0 : 0.0;
      side += sign * Eigen::Vector2d(x, y).normalized();
    }
  }
  const double cells = (2.0 * reach + 1.0) * (2.0 * reach + 1.0);
  return side / cells;
}

/// A wall's two faces are no surface in common, however near they come to each other.
bool areTwoFaces(const Eigen::Vector2d& side, const Eigen::Vector2d& other) {
  return side.norm() > kLeastSide && other.norm() > kLeastSide && side.dot(other) < -0.5 * side.norm() * other.norm();
}

/// Those that are not the other face of a wall in the other sub-map.
std::vector<Eigen::Vector2d> withoutOtherFaces(const MatchedLayers& layers, const MatchedLayers& other,
                                               const geometry::Pose2& T_other_points) {
  const Eigen::Matrix2d rotation = Eigen::Rotation2Dd(T_other_points.theta).toRotationMatrix();
  auto points = positions(*layers.surface);
  std::erase_if(points, [&](const Eigen::Vector2d& point) {
    const Eigen::Vector2d place = T_other_points * point;
    if (!other.surface->isNear(place)) return false;
    return areTwoFaces(rotation * seenSide(*layers.grid, point), seenSide(*other.grid, place));
  });
  return points;
}

/// What one sub-map's surface is to the other: on its surface, on its free floor, or where it has not seen.
Comparison compare(const MatchedLayers& layers, const MatchedLayers& other, const geometry::Pose2& T_other_points) {
  const auto& points = *layers.surface;
  Comparison comparison;
  const Eigen::Matrix2d rotation = Eigen::Rotation2Dd(T_other_points.theta).toRotationMatrix();
  const Eigen::Vector2d translation(T_other_points.x, T_other_points.y);
  for (const auto& point : points.points()) {
    const Eigen::Vector2d place = rotation * point.position_in_submap() + translation;
    if (other.surface->isNear(place)) {
      const Eigen::Vector2d side = rotation * seenSide(*layers.grid, point.position_in_submap());
      if (!areTwoFaces(side, seenSide(*other.grid, place))) ++comparison.agreeing;
    } else if (other.grid->state(other.grid->cellAt(place)) == map::CellState::kFree &&
               isOfWall(points, point.position_in_submap())) {
      ++comparison.conflicting;
    }
  }
  return comparison;
}

}  // namespace

std::optional<SubMapMatch> matchSubMaps(const MatchedLayers& from, const MatchedLayers& to, const SearchWindow& window,
                                        const SubMapMatcherConfig& config) {
  const auto thin = thinned(*to.surface, kSearchSpacing);
  const LikelihoodField field(*from.surface, config.searchResolution, kLevels);
  const auto found = searchPose(thin, field, window, config.leastScore);
  if (!found) return std::nullopt;
  if (window.reach > kSmallReach) {
    const double rival = found->score - config.leastLead;
    if (searchPose(thin, field, window, rival, found->T_map_body, kSameReach)) return std::nullopt;
  }
  const auto points = withoutOtherFaces(to, from, found->T_map_body);
  const auto match = matchScan(points, *from.surface, {.T_map_body = found->T_map_body});

  const auto there = compare(to, from, match.T_map_body);
  const auto back = compare(from, to, geometry::inverse(match.T_map_body));
  const auto count = static_cast<double>(std::min(to.surface->points().size(), from.surface->points().size()));
  const double agreeing = std::min(there.agreeing, back.agreeing);
  const double conflicting = std::max(there.conflicting, back.conflicting);
  SubMapMatch result{.T_from_to = match.T_map_body, .information = match.information / kCorrelated};
  result.overlap = agreeing / std::max(count, 1.0);
  result.conflict = conflicting / std::max(agreeing + conflicting, 1.0);
  const bool isSame = result.overlap >= config.leastOverlap && result.conflict <= config.mostConflict &&
                      agreeing * to.surface->resolution() >= config.leastWall;
  return isSame ? std::optional(result) : std::nullopt;
}

}  // namespace prodomos::localization

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/open_door_swung.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prodomos::perception::open_doors {

namespace {

constexpr double kLeastWidth = 0.6;  // metres, of a leaf
constexpr double kMostWidth = 1.15;
constexpr double kLowestTop = 1.9;  // metres above the floor
constexpr double kHighestTop = 2.35;
constexpr double kOffWall = 0.25;    // metres between a leaf's edge and the wall's plane: jamb, frame, what is hidden
constexpr double kStandsOut = 0.12;  // metres, at least
constexpr double kLeastAngle = 8.0 * std::numbers::pi / 180.0;
// Where the wall does not tell the side: nobody opens a door by the supplement of these.
constexpr double kClearLeast = 20.0 * std::numbers::pi / 180.0;
constexpr double kClearMost = 75.0 * std::numbers::pi / 180.0;
constexpr double kMostAngle = 100.0 * std::numbers::pi / 180.0;

/// Metres behind a leaf's plane that is not the leaf any more: where it is ajar, the wall is not far.
constexpr double kFar = 0.1;

/// Height at which a patch ends and one sees what is far behind it; none where the image ends before.
std::optional<double> topOf(const WallProfile& leaf, double from, double to) {
  constexpr double kLevel = 0.05;
  for (double z = kLowestTop - 0.2; z <= kHighestTop; z += kLevel) {
    int inImage = 0;
    int past = 0;
    for (double x = from; x <= to; x += 2.0 * WallProfile::kStep) {
      const auto depth = leaf.depthBehind(x, z);
      if (!depth) continue;
      ++inImage;
      past += std::isnan(*depth) || *depth > kFar ? 1 : 0;
    }
    if (inImage == 0) return std::nullopt;
    if (4 * past >= 3 * inImage) return z - 0.5 * kLevel;
  }
  return std::nullopt;
}

/// Whether one sees far past an edge, at once: cupboards have a front there.
bool isFreeEdge(const WallProfile& leaf, double x, double onward) {
  int known = 0;
  int past = 0;
  for (const double step : {0.06, 0.10, 0.14}) {
    for (double z = 0.3; z < kLowestTop; z += 0.1) {
      const auto depth = leaf.depthBehind(x + onward * step, z);
      if (!depth) continue;
      ++known;
      past += std::isnan(*depth) || *depth > kFar ? 1 : 0;
    }
  }
  return known > 0 && 10 * past >= 8 * known;
}

struct Edges {
  double left = 0.0;
  double right = 0.0;
};

/// Of the longest run of the patch's strips.
Edges edgesOf(const WallProfile& leaf) {
  constexpr int kMissing = 2;
  Edges best;
  for (int column = 0; column < leaf.count(); ++column) {
    if (leaf.strip(column) != Strip::kWall) continue;
    int last = column;
    for (int next = column + 1; next < leaf.count() && next - last <= kMissing; ++next) {
      if (leaf.strip(next) == Strip::kWall) last = next;
    }
    const Edges run{leaf.xOf(column) - 0.5 * WallProfile::kStep, leaf.xOf(last) + 0.5 * WallProfile::kStep};
    if (run.right - run.left > best.right - best.left) best = run;
    column = last;
  }
  return best;
}

/// Strips of a kind beside the hinge, where a leaf's width would be.
int countBeside(const WallProfile& wall, double hinge, double side, Strip wanted) {
  int count = 0;
  for (int column = 0; column < wall.count(); ++column) {
    const double offset = side * (wall.xOf(column) - hinge);
    if (offset > 0.2 && offset < 0.8 && wall.strip(column) == wanted) ++count;
  }
  return count;
}

}  // namespace

std::optional<SwungLeaf> findSwungLeaf(const WallProfile& wall, const WallProfile& leaf) {
  const auto edges = edgesOf(leaf);
  if (edges.right - edges.left < kLeastWidth - kOffWall || edges.right - edges.left > kMostWidth) return std::nullopt;
  const geometry::Pose3 T_wall_leaf = wall.wall().T_submap_wall.inverse() * leaf.wall().T_submap_wall;
  const Eigen::Vector2d left = (T_wall_leaf * Eigen::Vector3d(edges.left, 0.0, 0.0)).head<2>();
  const Eigen::Vector2d right = (T_wall_leaf * Eigen::Vector3d(edges.right, 0.0, 0.0)).head<2>();
  const bool hangsLeft = std::abs(left.y()) < std::abs(right.y());
  const Eigen::Vector2d near = hangsLeft ? left : right;
  const Eigen::Vector2d free = hangsLeft ? right : left;
  if (std::abs(near.y()) > kOffWall || free.y() > -kStandsOut) return std::nullopt;
  const Eigen::Vector2d along = (free - near).normalized();
  const Eigen::Vector2d axis = near - along * (near.y() / along.y());

  SwungLeaf swung;
  swung.hinge.x = axis.x();
  swung.hinge.leafWidth = (free - axis).norm();
  if (swung.hinge.leafWidth < kLeastWidth || swung.hinge.leafWidth > kMostWidth) return std::nullopt;
  if (!isFreeEdge(leaf, hangsLeft ? edges.right : edges.left, hangsLeft ? 1.0 : -1.0)) return std::nullopt;
  const double middle = 0.5 * (edges.left + edges.right);  // at the hinge, the wall is near
  const auto top = hangsLeft ? topOf(leaf, middle, edges.right - 0.1) : topOf(leaf, edges.left + 0.1, middle);
  if (!top || *top < kLowestTop) return std::nullopt;
  swung.top = *top;

  const auto speaksFor = [&](double side) {
    return countBeside(wall, axis.x(), side, Strip::kOpen) + countBeside(wall, axis.x(), -side, Strip::kWall);
  };
  constexpr int kClearly = 3;  // strips
  const int more = speaksFor(1.0) - speaksFor(-1.0);
  const bool sideIsSeen = std::abs(more) >= kClearly;
  swung.hinge.closing = (sideIsSeen ? more > 0 : along.x() > 0.0) ? 1.0 : -1.0;
  swung.angle = std::acos(std::clamp(swung.hinge.closing * along.x(), -1.0, 1.0));
  if (!sideIsSeen && (swung.angle < kClearLeast || swung.angle > kClearMost)) return std::nullopt;
  if (swung.angle < kLeastAngle || swung.angle > kMostAngle) return std::nullopt;
  return swung;
}

}  // namespace prodomos::perception::open_doors

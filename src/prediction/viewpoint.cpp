// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/prediction/viewpoint.hpp"

#include "prodomos/prediction/extrapolation.hpp"

#include "prediction/outline.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace prodomos::prediction {

namespace {

using geometry::CellIndex;

constexpr double kCell = Surroundings::kCell;
constexpr double kUsualDistance = 0.8;                      // metres before the opening
constexpr double kFarthest = 2.0;                           // metres
constexpr int kThreshold = 3;                               // cells: the opening's own frame, leaf and first step
constexpr geometry::CellBox kBefore{{-60, -60}, {-1, 59}};  // cells that one may come from

/// Cells where the middle of the robot may be.
CellSet roomFor(double robotRadius, const Surroundings& near) {
  CellSet room(kBefore, 0);
  const int reach = static_cast<int>(std::ceil(robotRadius / kCell));
  const auto isBlocked = [&](CellIndex middle) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const bool touches = std::hypot(x, y) * kCell <= robotRadius;
        if (touches && near.state(CellIndex{middle.x + x, middle.y + y}) == map::CellState::kOccupied) return true;
      }
    }
    return false;
  };
  for (int y = kBefore.first.y; y <= kBefore.last.y; ++y) {
    for (int x = kBefore.first.x; x <= kBefore.last.x; ++x) {
      const bool isFree = near.state(CellIndex{x, y}) == map::CellState::kFree;
      *room.find({x, y}) = isFree && !isBlocked({x, y}) ? 1 : 0;
    }
  }
  return room;
}

/// The straight way to the opening crosses nothing.
bool facesOpening(const Surroundings& near, const Eigen::Vector2d& spot) {
  const int steps = static_cast<int>(spot.norm() / (kCell / 2.0));
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector2d point = spot * (1.0 - static_cast<double>(i) / steps);
    if (point.x() > -kThreshold * kCell) break;
    if (near.state(point) == map::CellState::kOccupied) return false;
  }
  return true;
}

}  // namespace

geometry::Pose3 T_submap_near(const map::Entity& entity) {
  geometry::Pose3 T_submap_far = T_submap_here(entity);
  const auto* stairs = std::get_if<map::Staircase>(&entity.attributes);
  if (stairs == nullptr) return T_submap_far;
  // Both ends lie as far from the entity's middle, at different heights.
  const geometry::Pose2 middle = geometry::toPose2(entity.T_submap_entity);
  const geometry::Pose2 far = geometry::toPose2(T_submap_far);
  return geometry::toPose3({2.0 * middle.x - far.x, 2.0 * middle.y - far.y, far.theta}, 0.0);
}

std::optional<geometry::Pose2> viewpointBefore(const Surroundings& near, double robotRadius) {
  const Eigen::Vector2d usual(-kUsualDistance, 0.0);
  // Pieces come by size: the first that holds a spot at all is the one with the most room.
  for (const auto& piece : piecesOf(roomFor(robotRadius, near))) {
    std::optional<geometry::Pose2> best;
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto cell : piece) {
      const Eigen::Vector2d spot = geometry::centreOf(cell, kCell);
      const double distance = (spot - usual).norm();
      if (distance >= nearest || spot.norm() > kFarthest || !facesOpening(near, spot)) continue;
      nearest = distance;
      best = geometry::Pose2{spot.x(), spot.y(), std::atan2(-spot.y(), -spot.x())};
    }
    if (best) return best;
  }
  return std::nullopt;
}

}  // namespace prodomos::prediction

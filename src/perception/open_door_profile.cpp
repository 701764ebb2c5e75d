// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/open_door_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prodomos::perception::open_doors {

namespace {

// Heights above the floor, metres, at which a strip is looked at. Who cannot see as low as a window's sill cannot tell
// a door from a window.
constexpr double kLowest = 0.2;
constexpr double kHighest = 1.9;
constexpr double kSpacing = 0.1;
constexpr double kSill = 0.75;

constexpr double kHighestLintel = 2.5;
constexpr double kRoughness = 0.04;  // metres that a wall, its frames and skirting deviate from its plane
constexpr double kSigmas = 2.5;
constexpr double kReach = 4.5;  // metres along the floor to which depth tells wall from opening

/// Shares of the spots of a strip.
constexpr double kMostly = 0.6;
constexpr double kHardly = 0.15;
constexpr double kLeastKnown = 0.2;  // of a far room, sensors see the floor at least

}  // namespace

WallProfile::WallProfile(const RgbdView& view, const Surfaces& surfaces, const Wall& wall)
    : depth_(surfaces.depth), wall_(wall), T_camera_wall_(view.T_submap_camera.inverse() * wall.T_submap_wall) {
  if (wall.distance >= kReach) return;
  const double reach = std::sqrt(kReach * kReach - wall.distance * wall.distance);
  least_x_ = std::max(wall.least_x, -reach);
  const int count = static_cast<int>((std::min(wall.most_x, reach) - least_x_) / kStep);
  for (int column = 0; column < count; ++column) strips_.push_back(stripAt(xOf(column)));
}

std::optional<double> WallProfile::depthBehind(double x, double z) const {
  const Eigen::Vector3d point = T_camera_wall_ * Eigen::Vector3d(x, 0.0, z);
  if (point.z() <= 0.0) return std::nullopt;
  const auto& camera = depth_.camera();
  const Eigen::Vector2d pixel = camera.pixel(point.head<2>() / point.z());
  if (pixel.x() < 0.0 || pixel.y() < 0.0 || pixel.x() >= camera.width() || pixel.y() >= camera.height()) {
    return std::nullopt;
  }
  const auto* cell = depth_.cellAt(point);
  if (cell == nullptr) return std::numeric_limits<double>::quiet_NaN();
  return wall_.distance * (static_cast<double>(cell->depth) / point.z() - 1.0);
}

double WallProfile::toleranceAt(double x, double z) const {
  const double depth = (T_camera_wall_ * Eigen::Vector3d(x, 0.0, z)).z();
  return kRoughness + kSigmas * sensors::depthSigma(depth) * wall_.distance / depth;
}

Strip WallProfile::stripAt(double x) const {
  int inImage = 0;
  int known = 0;
  int wall = 0;
  int behind = 0;
  int before = 0;
  bool showsSill = false;
  for (double z = kLowest; z <= kHighest; z += kSpacing) {
    const auto depth = depthBehind(x, z);
    if (!depth) continue;
    ++inImage;
    showsSill |= z < kSill;
    if (std::isnan(*depth)) continue;
    ++known;
    const double tolerance = toleranceAt(x, z);
    wall += std::abs(*depth) <= tolerance ? 1 : 0;
    behind += *depth > tolerance ? 1 : 0;
    before += *depth < -tolerance ? 1 : 0;
  }
  if (known < kLeastKnown * inImage || known == 0) return Strip::kUnknown;
  if (wall >= kMostly * known) return Strip::kWall;
  if (showsSill && behind >= kMostly * known && wall <= kHardly * known) return Strip::kOpen;
  return before >= (1.0 - kMostly) * known ? Strip::kHidden : Strip::kUnknown;
}

std::vector<Gap> WallProfile::gaps(double leastWidth, double mostWidth) const {
  constexpr int kLeastWall = 3;  // strips
  const auto isWallFrom = [&](int column, int onward) {
    for (int i = 0; i < kLeastWall; ++i) {
      if (strip(column + i * onward) != Strip::kWall) return false;
    }
    return true;
  };
  std::vector<Gap> gaps;
  for (int left = kLeastWall; left < count(); ++left) {
    if (strip(left) == Strip::kWall || !isWallFrom(left - 1, -1)) continue;
    int right = left;
    int open = 0;
    while (right < count() && !isWallFrom(right, 1)) {
      open += strip(right) == Strip::kOpen ? 1 : 0;
      ++right;
    }
    const double width = (right - left) * kStep;
    if (right < count() && width >= leastWidth && width <= mostWidth && 4 * open >= right - left) {
      gaps.push_back({left, right - 1});
    }
    left = right;
  }
  return gaps;
}

double WallProfile::shareBehind(const Gap& gap, double depth) const {
  int inImage = 0;
  int behind = 0;
  for (int column = gap.left; column <= gap.right; ++column) {
    for (double z = kLowest; z <= kHighest; z += kSpacing) {
      const auto seen = depthBehind(xOf(column), z);
      if (!seen) continue;
      ++inImage;
      behind += std::isnan(*seen) || *seen > depth ? 1 : 0;  // too far to be known
    }
  }
  return inImage > 0 ? static_cast<double>(behind) / inImage : 0.0;
}

std::optional<double> WallProfile::lintel(const Gap& gap) const {
  constexpr double kLevel = 0.05;
  for (double z = kHighest; z <= kHighestLintel; z += kLevel) {
    int known = 0;
    int wall = 0;
    for (int column = gap.left + 1; column < gap.right; ++column) {
      const auto depth = depthBehind(xOf(column), z);
      if (!depth || std::isnan(*depth)) continue;
      ++known;
      wall += std::abs(*depth) <= toleranceAt(xOf(column), z) ? 1 : 0;
    }
    if (3 * known > gap.right - gap.left && wall >= kMostly * known) return z - 0.5 * kLevel;
  }
  return std::nullopt;
}

bool WallProfile::showsTop(const Gap& gap) const {
  constexpr double kTop = 2.3;
  return depthBehind(xOf((gap.left + gap.right) / 2), kTop).has_value();
}

}  // namespace prodomos::perception::open_doors

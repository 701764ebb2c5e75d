// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/open_door_detector.hpp"

#include "perception/open_door_leaf.hpp"
#include "perception/open_door_profile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prodomos::perception {

using open_doors::Gap;
using open_doors::Hinge;
using open_doors::Leaf;
using open_doors::WallProfile;

namespace {

constexpr std::size_t kMostWalls = 6;
constexpr double kLeastWallArea = 0.3;                // m²
constexpr double kWidestLeaf = 1.2;                   // metres; wider openings have two
constexpr double kOpenFrom = std::numbers::pi / 3.0;  // docs/truth.md
constexpr double kWallHalf = 0.08;                    // metres from a wall's face to its middle, where nothing shows it

/// An opening in a wall, and the leaves at its left and right jambs.
struct Opening {
  Gap gap;
  double left = 0.0;  // metres along the wall
  double right = 0.0;
  std::optional<double> lintel;
  double behind = 0.0;  // share of what is seen through it that lies in another room
  std::optional<Leaf> leftLeaf;
  std::optional<Leaf> rightLeaf;

  double width() const { return right - left; }
  bool hasLeaf() const { return leftLeaf || rightLeaf; }
};

Opening lookAt(const WallProfile& profile, const Gap& gap, const RgbdView& view, const Surfaces& surfaces,
               const OpenDoorDetectorConfig& config) {
  Opening opening;
  opening.gap = gap;
  opening.left = profile.xOf(gap.left) - 0.5 * WallProfile::kStep;
  opening.right = profile.xOf(gap.right) + 0.5 * WallProfile::kStep;
  opening.lintel = profile.lintel(gap);
  opening.behind = profile.shareBehind(gap, config.leastDepth);
  const double width = opening.width();
  const double leafWidth = width > kWidestLeaf ? 0.5 * width : width;
  const auto spots =
      open_doors::spotsNear(view, surfaces, profile.wall(), 0.5 * (opening.left + opening.right), width + 0.5);
  opening.leftLeaf = open_doors::findLeaf(spots, {opening.left, 1.0, leafWidth});
  opening.rightLeaf = open_doors::findLeaf(spots, {opening.right, -1.0, leafWidth});
  return opening;
}

/// Log-odds; none: it is no door.
std::optional<double> evidenceOf(const Opening& opening, const OpenDoorDetectorConfig& config) {
  constexpr double kLeastBehind = 0.3;
  if (opening.lintel && *opening.lintel < config.leastHeight) return std::nullopt;
  if (opening.hasLeaf()) {
    const double covered = std::max(opening.leftLeaf ? opening.leftLeaf->covered : 0.0,
                                    opening.rightLeaf ? opening.rightLeaf->covered : 0.0);
    return 0.5 + 2.0 * (covered - 0.65) + (opening.lintel ? 1.0 : 0.0);
  }
  if (opening.behind < kLeastBehind) return std::nullopt;
  if (!opening.lintel && opening.width() > config.mostPlain) return std::nullopt;
  return opening.lintel ? 1.5 : 0.3;
}

void tellLeaf(const Opening& opening, DoorSighting& sighting) {
  const bool isLeft =
      opening.leftLeaf && (!opening.rightLeaf || opening.leftLeaf->covered >= opening.rightLeaf->covered);
  const Leaf& leaf = isLeft ? *opening.leftLeaf : *opening.rightLeaf;
  sighting.door.hasLeaf = true;
  sighting.openAngle = std::abs(leaf.angle);
  sighting.door.state = sighting.openAngle < kOpenFrom ? map::DoorState::kAjar : map::DoorState::kOpen;
  if (opening.width() > kWidestLeaf) return;  // two leaves, two sides
  sighting.door.hingeSide = isLeft ? map::HingeSide::kLeft : map::HingeSide::kRight;
  sighting.hingeEvidence = isLeft ? 2.0 : -2.0;
}

DoorSighting sightingOf(const Opening& opening, const Wall& wall, const RgbdView& view, double evidence) {
  DoorSighting sighting;
  sighting.time = view.time;
  sighting.evidence = evidence;
  sighting.door.width = opening.width();
  sighting.door.height = opening.lintel.value_or(0.0);
  sighting.door.hasLeaf = false;
  sighting.door.state = map::DoorState::kOpen;
  if (opening.hasLeaf()) tellLeaf(opening, sighting);
  const Eigen::Vector3d middle(0.5 * (opening.left + opening.right), kWallHalf, 0.0);
  sighting.T_submap_door.linear() << wall.T_submap_wall.linear().col(1), -wall.T_submap_wall.linear().col(0),
      Eigen::Vector3d::UnitZ();
  sighting.T_submap_door.translation() = wall.T_submap_wall * middle;
  sighting.range = std::hypot(middle.x(), wall.distance);
  const double depthSigma = sensors::depthSigma(sighting.range);
  // Jambs are as sharp as a cell of the depth grid, seen as obliquely as the wall.
  const double cell = sensors::DepthGrid::kBlock * sighting.range / view.frame.camera.fx;
  const double alongSigma = 0.02 + cell * sighting.range / std::max(0.1, wall.distance);
  const double acrossSigma = 0.05 + depthSigma;
  sighting.widthSigma = alongSigma;
  const double c = sighting.T_submap_door.linear()(0, 0);
  const double s = sighting.T_submap_door.linear()(1, 0);
  Eigen::Matrix2d turn;
  turn << c, -s, s, c;
  const Eigen::Vector2d variances(acrossSigma * acrossSigma, 0.5 * alongSigma * alongSigma);
  sighting.covariance.topLeftCorner<2, 2>() = turn * variances.asDiagonal() * turn.transpose();
  sighting.covariance(2, 2) = 0.03 * 0.03;
  sighting.covariance(3, 3) = 0.03 * 0.03;
  return sighting;
}

}  // namespace

void describe(base::ConfigVisitor& visitor, OpenDoorDetectorConfig& config) {
  visitor.section("open_doors", "openings in the walls of RGB-D images, and leaves that stand open");
  visitor.key("enabled", config.enabled, "look for them");
  visitor.key("least_width", config.leastWidth, "m", {0.3, 2.0}, "between the jambs");
  visitor.key("most_width", config.mostWidth, "m", {0.6, 5.0}, "between the jambs");
  visitor.key("most_plain", config.mostPlain, "m", {0.6, 5.0}, "wider ones need a lintel: else they are corridors");
  visitor.key("least_height", config.leastHeight, "m", {1.0, 3.0}, "above the floor; lower ones are hatches");
  visitor.key("least_depth", config.leastDepth, "m", {0.2, 5.0}, "of space behind the wall; less is a niche");
  visitor.endSection();
}

std::vector<DoorSighting> findOpenDoors(const RgbdView& view, const Surfaces& surfaces,
                                        const OpenDoorDetectorConfig& config, DebugImages* debug) {
  std::vector<DoorSighting> found;
  if (!config.enabled) return found;
  auto walls = findWalls(view, surfaces);
  if (walls.size() > kMostWalls) walls.resize(kMostWalls);
  for (const auto& wall : walls) {
    if (wall.area < kLeastWallArea) continue;
    const WallProfile profile(view, surfaces, wall);
    for (const auto& gap : profile.gaps(config.leastWidth, config.mostWidth)) {
      const auto opening = lookAt(profile, gap, view, surfaces, config);
      if (const auto evidence = evidenceOf(opening, config)) {
        found.push_back(sightingOf(opening, wall, view, *evidence));
      }
    }
  }
  static_cast<void>(debug);
  return found;
}

}  // namespace prodomos::perception

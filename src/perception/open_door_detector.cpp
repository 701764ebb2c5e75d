// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/open_door_detector.hpp"

#include "perception/open_door_leaf.hpp"
#include "perception/open_door_picture.hpp"
#include "perception/open_door_profile.hpp"
#include "perception/open_door_swung.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prodomos::perception {

using open_doors::Gap;
using open_doors::Hinge;
using open_doors::Leaf;
using open_doors::SwungLeaf;
using open_doors::WallProfile;

namespace {

constexpr std::size_t kMostWalls = 6;
constexpr double kLeastWallArea = 0.3;                // m²
constexpr double kWidestLeaf = 1.2;                   // metres; wider openings have two
constexpr double kOpenFrom = std::numbers::pi / 3.0;  // docs/truth.md
constexpr double kHingeEvidence = 2.0;                // log-odds
constexpr double kAcrossSigma = 0.05;                 // metres; where in the wall the leaf hangs
constexpr double kFloorSigma = 0.03;                  // metres
constexpr double kYawSigma = 0.03;                    // radians
constexpr double kDrawnReach = 5.0;                   // metres
constexpr double kWallHalf = 0.08;                    // metres from a wall's face to its middle, where nothing shows it

/// An opening in a wall, and the leaves at its left and right jambs.
struct Opening {
  Gap gap;
  double left = 0.0;  // metres along the wall
  double right = 0.0;
  std::optional<double> lintel;
  bool showsTop = false;  // there would be a lintel in the image
  double behind = 0.0;    // share of what is seen through it that lies in another room
  std::optional<Leaf> leftLeaf;
  std::optional<Leaf> rightLeaf;

  double width() const { return right - left; }
  double leafWidth() const { return width() > kWidestLeaf ? 0.5 * width() : width(); }
  bool hasLeaf() const { return leftLeaf || rightLeaf; }
};

Opening lookAt(const WallProfile& profile, const Gap& gap, const RgbdView& view, const Surfaces& surfaces,
               const OpenDoorDetectorConfig& config) {
  Opening opening;
  opening.gap = gap;
  opening.left = profile.xOf(gap.left) - 0.5 * WallProfile::kStep;
  opening.right = profile.xOf(gap.right) + 0.5 * WallProfile::kStep;
  opening.lintel = profile.lintel(gap);
  opening.showsTop = profile.showsTop(gap);
  opening.behind = profile.shareBehind(gap, config.leastDepth);
  const double middle = 0.5 * (opening.left + opening.right);
  const auto spots = open_doors::spotsNear(view, surfaces, profile.wall(), middle, opening.width() + 0.5);
  opening.leftLeaf = open_doors::findLeaf(spots, {opening.left, 1.0, opening.leafWidth()});
  opening.rightLeaf = open_doors::findLeaf(spots, {opening.right, -1.0, opening.leafWidth()});
  return opening;
}

/// Log-odds, as counted in simulated buildings; none: it is no door.
std::optional<double> evidenceOf(const Opening& opening, const OpenDoorDetectorConfig& config) {
  constexpr double kLeastBehind = 0.3;
  if (opening.lintel && *opening.lintel < config.leastHeight) return std::nullopt;
  const bool hasBoth = opening.leftLeaf && opening.rightLeaf;
  if (opening.width() > kWidestLeaf && !opening.lintel && !hasBoth) return std::nullopt;
  if (opening.hasLeaf()) {
    const double covered = std::max(opening.leftLeaf ? opening.leftLeaf->covered : 0.0,
                                    opening.rightLeaf ? opening.rightLeaf->covered : 0.0);
    return 1.5 + 2.0 * (covered - 0.65) + (opening.lintel ? 1.5 : 0.0);
  }
  if (opening.behind < kLeastBehind) return std::nullopt;
  if (opening.lintel) return 3.0;
  if (opening.showsTop || opening.width() > config.mostPlain) return std::nullopt;
  return 1.0;
}

/// A door or doorway in a wall's frame.
struct Told {
  double left = 0.0;  // of the opening, metres along the wall
  double right = 0.0;
  double height = 0.0;                                  // metres, 0: not measured
  std::optional<double> angle;                          // of a leaf, radians from closed; none: none seen
  map::HingeSide hingeSide = map::HingeSide::kUnknown;  // of it
  double evidence = 0.0;                                // log-odds
  double sigma = 0.0;                                   // metres along the wall, beyond that of jambs
};

Told toldBy(const Opening& opening, double evidence) {
  Told told{opening.left, opening.right, opening.lintel.value_or(0.0)};
  told.evidence = evidence;
  if (!opening.hasLeaf()) return told;
  const bool isLeft =
      opening.leftLeaf && (!opening.rightLeaf || opening.leftLeaf->covered >= opening.rightLeaf->covered);
  told.angle = std::abs((isLeft ? opening.leftLeaf : opening.rightLeaf)->angle);
  if (opening.width() > kWidestLeaf) return told;  // two leaves, two sides
  told.hingeSide = isLeft ? map::HingeSide::kLeft : map::HingeSide::kRight;
  return told;
}

Told toldBy(const SwungLeaf& leaf) {
  constexpr double kSigma = 0.05;
  const double end = leaf.hinge.x + leaf.hinge.closing * leaf.hinge.leafWidth;
  Told told{std::min(leaf.hinge.x, end), std::max(leaf.hinge.x, end), leaf.top, leaf.angle};
  told.hingeSide = leaf.hinge.closing > 0.0 ? map::HingeSide::kLeft : map::HingeSide::kRight;
  told.evidence = 3.0;
  told.sigma = kSigma;
  return told;
}

/// Jambs are as sharp as a cell of the depth grid, seen as obliquely as the wall.
double alongSigma(const Told& told, const Wall& wall, double range, double focalLength) {
  constexpr double kFrame = 0.02;  // metres
  const double cell = sensors::DepthGrid::kBlock * range / focalLength;
  return kFrame + told.sigma + cell * range / std::max(0.1, wall.distance);
}

DoorSighting sightingOf(const Told& told, const Wall& wall, const RgbdView& view) {
  DoorSighting sighting;
  sighting.time = view.time;
  sighting.evidence = told.evidence;
  sighting.door.width = told.right - told.left;
  sighting.door.height = told.height;
  sighting.door.hasLeaf = told.angle.has_value();
  sighting.door.hingeSide = told.hingeSide;
  sighting.openAngle = told.angle.value_or(0.0);
  const bool isAjar = told.angle && *told.angle < kOpenFrom;
  sighting.door.state = isAjar ? map::DoorState::kAjar : map::DoorState::kOpen;
  if (told.hingeSide != map::HingeSide::kUnknown) {
    sighting.hingeEvidence = told.hingeSide == map::HingeSide::kLeft ? kHingeEvidence : -kHingeEvidence;
  }
  const Eigen::Vector3d middle(0.5 * (told.left + told.right), kWallHalf, 0.0);
  sighting.T_submap_door.linear() << wall.T_submap_wall.linear().col(1), -wall.T_submap_wall.linear().col(0),
      Eigen::Vector3d::UnitZ();
  sighting.T_submap_door.translation() = wall.T_submap_wall * middle;
  sighting.range = std::hypot(middle.x(), wall.distance);

  const double along = alongSigma(told, wall, sighting.range, view.frame.camera.fx);
  const double across = kAcrossSigma + sensors::depthSigma(sighting.range);
  const Eigen::Matrix2d axes = sighting.T_submap_door.linear().topLeftCorner<2, 2>();
  const Eigen::Vector2d variances(across * across, 0.5 * along * along);
  sighting.covariance.topLeftCorner<2, 2>() = axes * variances.asDiagonal() * axes.transpose();
  sighting.covariance(2, 2) = kFloorSigma * kFloorSigma;
  sighting.covariance(3, 3) = kYawSigma * kYawSigma;
  sighting.widthSigma = along;
  return sighting;
}

}  // namespace

void describe(base::ConfigVisitor& visitor, OpenDoorDetectorConfig& config) {
  visitor.section("open_doors", "openings in the walls of RGB-D images, and leaves that stand open");
  visitor.key("enabled", config.enabled, "look for them");
  visitor.key("from_laser", config.fromLaser, "look for leaves in scans, too");
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
  std::vector<WallProfile> profiles;
  for (const auto& wall : findWalls(view, surfaces)) {
    if (wall.area > kLeastWallArea && profiles.size() < kMostWalls) profiles.emplace_back(view, surfaces, wall);
  }
  int number = 0;
  for (const auto& profile : profiles) {
    std::vector<open_doors::DrawnGap> drawn;
    for (const auto& gap : profile.gaps(config.leastWidth, config.mostWidth)) {
      const auto opening = lookAt(profile, gap, view, surfaces, config);
      const auto evidence = evidenceOf(opening, config);
      if (evidence) found.push_back(sightingOf(toldBy(opening, *evidence), profile.wall(), view));
      drawn.push_back({gap, opening.leftLeaf, opening.rightLeaf, opening.leafWidth(), evidence.has_value()});
    }
    std::vector<SwungLeaf> swung;
    for (const auto& other : profiles) {
      const auto leaf = &other == &profile ? std::nullopt : open_doors::findSwungLeaf(profile, other);
      if (!leaf) continue;
      found.push_back(sightingOf(toldBy(*leaf), profile.wall(), view));
      swung.push_back(*leaf);
    }
    if (debug != nullptr && debug->isWanted() && profile.count() > 0) {
      const auto spots = open_doors::spotsNear(view, surfaces, profile.wall(), 0.0, kDrawnReach);
      debug->add("open_doors_" + std::to_string(number++), drawProfile(profile, spots, drawn, swung));
    }
  }
  return found;
}

}  // namespace prodomos::perception

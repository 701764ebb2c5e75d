// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/staircase_landmark.hpp"

#include "perception/numeric.hpp"
#include "perception/robust_mean.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace prodomos::perception {

namespace {

constexpr double kSameRungRise = 0.06;   // metres
constexpr double kSameRungAlong = 0.15;  // metres
constexpr std::size_t kMostRungs = 60;
constexpr std::size_t kMostPoints = 500;
constexpr double kClearlyBetter = 1.5;  // as of doors: a sub-map shows it so many times better
constexpr double kSureOfFloor = 0.4;    // of a riser: a floor known so well is one of the steps' heights
constexpr double kLeastShare = 0.15;    // of the sightings of a floor: fewer are strays
constexpr double kFootKnown = 0.3;      // metres along the flight
constexpr double kPointSigma = 0.02;    // metres, of an edge in one reading

Eigen::Vector3d uphillOf(double heading) {
  return {std::cos(heading), std::sin(heading), 0.0};
}
Eigen::Vector3d acrossOf(double heading) {
  return {-std::sin(heading), std::cos(heading), 0.0};
}

void addRung(StaircaseLook& look, const Eigen::Vector3d& edge, const Eigen::Vector3d& uphill) {
  const auto isSame = [&](const Rung& rung) {
    const Eigen::Vector3d off = edge - rung.edge_in_submap;
    return std::abs(off.z()) < kSameRungRise && std::abs(uphill.dot(off)) < kSameRungAlong;
  };
  const auto rung = std::ranges::find_if(look.rungs, isSame);
  if (rung != look.rungs.end()) {
    ++rung->readings;
    rung->edge_in_submap += (edge - rung->edge_in_submap) / rung->readings;
  } else if (look.rungs.size() < kMostRungs) {
    look.rungs.push_back({edge, 1});
  }
}

/// Steps in a row, as most of one reading's have it; the number of those.
std::pair<double, int> riserOf(const std::vector<Step>& steps) {
  if (steps.size() < 2) return {0.0, 0};
  std::vector<double> rises;
  for (std::size_t i = 1; i < steps.size(); ++i) rises.push_back(steps[i].z - steps[i - 1].z);
  const double usual = median(std::move(rises));
  const double whole = steps.back().z - steps.front().z;
  const int count = usual > 0.0 ? static_cast<int>(std::lround(whole / usual)) : 0;
  return count > 0 ? std::pair(whole / count, count) : std::pair(0.0, 0);
}

void keepPoints(StaircaseLandmark& stairs, const StaircaseSighting& sighting, base::SubMapId submap) {
  if (sighting.steps.size() <= stairs.mostSteps) return;
  stairs.mostSteps = sighting.steps.size();
  stairs.pointsSubmap = submap;
  stairs.points.clear();
  const std::size_t stride = sighting.points_in_submap.size() / kMostPoints + 1;
  for (std::size_t i = 0; i < sighting.points_in_submap.size(); i += stride) {
    stairs.points.push_back(sighting.points_in_submap[i]);
  }
}

base::SubMapId bestSubmap(const StaircaseLandmark& stairs) {
  std::map<base::SubMapId, double> goodness;
  for (const auto& look : stairs.looks) {
    if (look.sightings > 0) goodness[look.submap] += static_cast<double>(look.rungs.size());
  }
  const auto best = std::ranges::max_element(goodness, {}, &std::pair<const base::SubMapId, double>::second);
  const auto current = goodness.find(stairs.submap);
  const bool stays = current != goodness.end() && best->second < kClearlyBetter * current->second;
  return stays ? stairs.submap : best->first;
}

/// A floor that a flight leads from or to, as one look has it.
struct Floor {
  double z = 0.0;
  double sigma = 0.0;
  int sightings = 0;
};

/// All looks together, in the frame where the landmark is kept.
class FlightFusion {
 public:
  FlightFusion(StaircaseLandmark& stairs, const Frames& frames, const EntityMemoryConfig& config)
      : stairs_(stairs), frames_(frames), config_(config) {}

  bool run() {
    if (!fuseHeading()) return false;
    const auto ladder = fitLadder(treads(), riser());
    if (!ladder || !(ladder->depth > 0.0)) return false;
    placeFloors(*ladder);
    placeAcross(*ladder);
    return true;
  }

 private:
  double share(const StaircaseLook& look) const {
    return Look::worth(look.sightings, config_.correlation) / look.sightings;
  }
  Eigen::Vector3d here(const StaircaseLook& look, const Eigen::Vector3d& point) const {
    return frames_.T_submap_other(look.submap) * point;
  }
  double zOffset(const StaircaseLook& look) const { return frames_.T_submap_other(look.submap).translation().z(); }

  bool fuseHeading();
  double riser() const;
  std::vector<Tread> treads() const;
  std::vector<Floor> floorsOf(Mean StaircaseLook::*floor) const;
  std::optional<int> sureStep(const std::vector<Floor>& floors, const StepLadder& ladder, bool isLowest) const;
  void placeFloors(const StepLadder& ladder);
  void placeAcross(const StepLadder& ladder);

  StaircaseLandmark& stairs_;
  const Frames& frames_;
  const EntityMemoryConfig& config_;
  double footAlong_ = 0.0;
  double foot_z_ = 0.0;
  double headingVariance_ = 0.0;
};

bool FlightFusion::fuseHeading() {
  std::vector<Measured<1>> headings;
  for (const auto& look : stairs_.looks) {
    if (look.sightings == 0) continue;
    const auto& T_here_there = frames_.T_submap_other(look.submap);
    double heading = geometry::normalizeAngle(look.heading + geometry::yaw(T_here_there));
    if (!headings.empty()) {
      heading = headings[0].value[0] + geometry::normalizeAngle(heading - headings[0].value[0]);
    }
    double variance = square(config_.headingFloor) + 1.0 / (look.headingInformation * share(look));
    if (look.submap != stairs_.submap) variance += square(config_.submapHeading);
    headings.push_back({Eigen::Matrix<double, 1, 1>(heading), Eigen::Matrix<double, 1, 1>(variance)});
  }
  if (headings.empty()) return false;
  const auto mean = robustMean(headings);
  stairs_.heading = geometry::normalizeAngle(mean.value[0]);
  headingVariance_ = mean.covariance(0, 0);
  return true;
}

double FlightFusion::riser() const {
  Mean mean;
  for (const auto& look : stairs_.looks) mean.add(look.riser.value, look.riser.weight);
  return mean.value;
}

std::vector<Tread> FlightFusion::treads() const {
  const Eigen::Vector3d uphill = uphillOf(stairs_.heading);
  std::vector<Tread> treads;
  for (const auto& look : stairs_.looks) {
    for (const auto& rung : look.rungs) {
      const Eigen::Vector3d edge = here(look, rung.edge_in_submap);
      treads.push_back({edge.z(), uphill.dot(edge), Look::worth(rung.readings, config_.correlation)});
    }
  }
  return treads;
}

std::vector<Floor> FlightFusion::floorsOf(Mean StaircaseLook::*floor) const {
  std::vector<Floor> floors;
  for (const auto& look : stairs_.looks) {
    const Mean& mean = look.*floor;
    if (!(mean.weight > 0.0)) continue;
    const double variance = 1.0 / (mean.weight * share(look)) + square(kPointSigma);
    floors.push_back({mean.value + zOffset(look), std::sqrt(variance), look.sightings});
  }
  return floors;
}

/// The tread that is the floor. To who stands on a step, this seems to be the floor: the lowest of those below is
/// meant, and the highest of those above, if it is no stray.
std::optional<int> FlightFusion::sureStep(const std::vector<Floor>& floors, const StepLadder& ladder,
                                          bool isLowest) const {
  std::map<int, int> sightings;
  int all = 0;
  for (const auto& floor : floors) {
    if (floor.sigma > kSureOfFloor * ladder.riser) continue;
    sightings[static_cast<int>(std::lround((floor.z - ladder.bottom_z) / ladder.riser))] += floor.sightings;
    all += floor.sightings;
  }
  std::erase_if(sightings, [all](const auto& entry) { return entry.second < kLeastShare * all; });
  if (sightings.empty()) return std::nullopt;
  return isLowest ? sightings.begin()->first : sightings.rbegin()->first;
}

/// Floors below and above, where they were seen, else one riser below the lowest tread; above what is guessed, at least
/// the highest tread.
void FlightFusion::placeFloors(const StepLadder& ladder) {
  int below = ladder.lowest - 1;
  if (const auto foot = sureStep(floorsOf(&StaircaseLook::foot_z), ladder, true)) below = std::min(below, *foot);
  foot_z_ = ladder.zOf(below);
  footAlong_ = ladder.alongOf(below + 1);
  double top_z = ladder.zOf(ladder.highest);
  const auto heads = floorsOf(&StaircaseLook::head_z);
  if (const auto head = sureStep(heads, ladder, false)) {
    top_z = std::max(top_z, ladder.zOf(*head));
  } else if (!heads.empty()) {
    top_z = std::max(top_z, std::ranges::min_element(heads, {}, &Floor::sigma)->z);
  }
  stairs_.rise = top_z - foot_z_;
  stairs_.riser = ladder.riser;
  stairs_.depth = ladder.depth;
}

/// The whole width, where some reading shows it, else all that was ever seen of it.
void FlightFusion::placeAcross(const StepLadder& ladder) {
  const Eigen::Vector3d across = acrossOf(stairs_.heading);
  stairs_.widthIsWhole = std::ranges::any_of(stairs_.looks, [](const auto& look) { return look.wholes > 0; });
  Mean left;
  Mean right;
  double leftmost = -std::numeric_limits<double>::infinity();
  double rightmost = -leftmost;
  for (const auto& look : stairs_.looks) {
    if (look.sightings == 0 || (stairs_.widthIsWhole && look.wholes == 0)) continue;
    const double first = across.dot(here(look, look.first_in_submap));
    left.add(first + look.left.value, look.left.weight);
    right.add(first + look.right.value, look.right.weight);
    leftmost = std::max(leftmost, first + look.left.value);
    rightmost = std::min(rightmost, first + look.right.value);
  }
  if (stairs_.widthIsWhole) {
    leftmost = left.value;
    rightmost = right.value;
  }
  stairs_.width = leftmost - rightmost;
  const Eigen::Vector3d level = footAlong_ * uphillOf(stairs_.heading) + (leftmost + rightmost) / 2.0 * across;
  stairs_.foot_in_submap = {level.x(), level.y(), foot_z_};
  const double acrossVariance =
      square(config_.positionFloor) + (stairs_.widthIsWhole ? 0.0 : square(stairs_.width / 4.0));
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  covariance.diagonal() << square(ladder.alongSigma) + square(config_.positionFloor), acrossVariance,
      square(ladder.zSigma) + square(kPointSigma), headingVariance_;
  stairs_.covariance = turned(poseOf({0.0, 0.0, 0.0, stairs_.heading}), covariance);
}

}  // namespace

void fuse(StaircaseLandmark& stairs, StaircaseLook& look, const StaircaseSighting& sighting) {
  const Vector4 origin = vectorOf(sighting.T_submap_stairs);
  const Eigen::Vector3d uphill = uphillOf(origin.w());
  const double information = 1.0 / std::max(1e-6, sighting.covariance(3, 3));
  if (look.sightings == 0) {
    look.first_in_submap = origin.head<3>();
    look.heading = origin.w();
  }
  look.headingInformation += information;
  const double turn = geometry::normalizeAngle(origin.w() - look.heading);
  look.heading = geometry::normalizeAngle(look.heading + turn * information / look.headingInformation);
  for (const auto& step : sighting.steps) {
    Eigen::Vector3d edge = origin.head<3>() + step.along * uphill;
    edge.z() = step.z;
    addRung(look, edge, uphill);
  }
  const auto [riser, count] = riserOf(sighting.steps);
  look.riser.add(riser, count);
  if (sighting.widthIsWhole && look.wholes++ == 0) look.left = look.right = Mean{};
  if (sighting.widthIsWhole || look.wholes == 0) {
    const double middle = acrossOf(look.heading).dot(origin.head<3>() - look.first_in_submap);
    look.left.add(middle + sighting.width / 2.0, 1.0);
    look.right.add(middle - sighting.width / 2.0, 1.0);
  }
  // The foot is known where its place along the flight is, be it that the lowest steps are hidden.
  const Eigen::Vector3d spread = sighting.covariance.topLeftCorner<3, 3>() * uphill;
  if (sighting.footIsSeen || uphill.dot(spread) < square(kFootKnown)) {
    look.foot_z.add(origin.z(), 1.0 / (square(kPointSigma) + sighting.covariance(2, 2)));
  }
  if (sighting.newFloorSigma > 0.0) {
    auto& floor = sighting.descends ? look.foot_z : look.head_z;
    floor.add(sighting.newFloor_z, 1.0 / square(std::max(kPointSigma, sighting.newFloorSigma)));
  }
  look.evidence += sighting.evidence;
  ++look.sightings;
  stairs.descendsNow = sighting.descends;
  keepPoints(stairs, sighting, look.submap);
}

void fuseFloorAbove(StaircaseLook& look, double floor_z) {
  look.head_z.add(floor_z, 1.0 / square(2.0 * kPointSigma));
}

bool refresh(StaircaseLandmark& stairs, const Frames& frames, const EntityMemoryConfig& config) {
  stairs.logOdds = logOddsOf(stairs.looks, config);
  stairs.submap = bestSubmap(stairs);
  const auto framesThere = frames.seenFrom(stairs.submap);
  if (stairs.pointsSubmap != stairs.submap) {
    const Eigen::Isometry3f T_here_there = framesThere.T_submap_other(stairs.pointsSubmap).cast<float>();
    for (auto& point : stairs.points) point = T_here_there * point;
    stairs.pointsSubmap = stairs.submap;
  }
  stairs.hasChanged = true;
  return FlightFusion(stairs, framesThere, config).run();
}

map::Entity entityOf(const StaircaseLandmark& stairs) {
  map::Entity entity = stairs.entity();
  const Eigen::Vector3d middle = stairs.foot_in_submap + stairs.run() / 2.0 * uphillOf(stairs.heading) +
                                 stairs.rise / 2.0 * Eigen::Vector3d::UnitZ();
  entity.T_submap_entity = poseOf({middle.x(), middle.y(), middle.z(), stairs.heading});
  entity.covariance = covariance6(stairs.covariance);
  // The floor that the sub-map lies on is the one at its origin's height.
  const bool isSeenFromAbove = std::abs(stairs.foot_in_submap.z() + stairs.rise) < std::abs(stairs.foot_in_submap.z());
  entity.attributes = map::Staircase{.height = isSeenFromAbove ? -stairs.rise : stairs.rise,
                                     .stepWidth = stairs.width,
                                     .stepHeight = stairs.riser,
                                     .stepDepth = stairs.depth,
                                     .stepCount = static_cast<int>(std::lround(stairs.rise / stairs.riser))};
  entity.points_in_submap = stairs.points;
  return entity;
}

}  // namespace prodomos::perception

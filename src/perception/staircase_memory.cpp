// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/staircase_memory.hpp"

#include "prodomos/geometry/assignment.hpp"

#include "perception/numeric.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace prodomos::perception {

namespace {

constexpr double kGreatestTurn = 0.5;  // radians
constexpr double kGate = 16.3;         // chi² of 3 degrees of freedom, 99.9 %
constexpr double kGreatestGap = 1.5;   // metres along the flight that nobody has seen
constexpr double kFarthestLook = 5.0;  // metres
constexpr double kWellSeenShare = 0.7;
constexpr double kClearlyThrough = 0.8;
constexpr double kNothing = 3.0;      // where there is nothing, that is as bad as so many misses
constexpr double kInSlope = 0.3;      // metres along the line of sight
constexpr double kLeastClimb = 0.25;  // metres, more than a step
constexpr double kHeadroom = 1.9;     // metres; flights that lie over one another leave more
constexpr double kGreatestWidth = 12.0;
constexpr double kGreatestRiser = 0.4;

/// A flight in one common sub-map, as much of it as was seen.
struct FlightPlace {
  Vector4 foot = Vector4::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();
  double slope = 0.0;
  double first = 0.0;  ///< metres uphill of the foot
  double last = 0.0;
  double width = 0.0;
  bool widthIsWhole = false;

  Eigen::Vector3d uphill() const { return {std::cos(foot.w()), std::sin(foot.w()), 0.0}; }
};

FlightPlace placeOf(const StaircaseSighting& sighting) {
  const auto& low = sighting.steps.front();
  const auto& high = sighting.steps.back();
  FlightPlace place{.foot = vectorOf(sighting.T_submap_stairs),
                    .covariance = sighting.covariance,
                    .slope = (high.z - low.z) / (high.along - low.along),
                    .last = high.along - low.along,
                    .width = sighting.width,
                    .widthIsWhole = sighting.widthIsWhole};
  place.foot.head<3>() += low.along * place.uphill();
  place.foot.z() = low.z;  // of an edge, as below
  return place;
}

FlightPlace placeOf(const StaircaseLandmark& stairs, const Frames& frames, const EntityMemoryConfig& config) {
  const auto& T_here_there = frames.T_submap_other(stairs.submap);
  Vector4 foot;
  foot << stairs.foot_in_submap, stairs.heading;
  foot.z() += stairs.riser;  // the first tread's edge
  FlightPlace place{.foot = vectorOf(T_here_there * poseOf(foot)),
                    .covariance = turned(T_here_there, stairs.covariance),
                    .slope = stairs.slope(),
                    .last = stairs.run() - stairs.depth,
                    .width = stairs.width,
                    .widthIsWhole = stairs.widthIsWhole};
  if (stairs.submap != frames.submap()) {
    place.covariance += uncertaintyBetween(config, stairs.foot_in_submap.head<2>().norm());
  }
  return place;
}

/// How one flight lies to another, seen from above; metres and radians.
struct PlanOffset {
  double along = 0.0;  ///< from foot to foot
  double gap = 0.0;    ///< along, between what was seen of them
  double aside = 0.0;
  double turn = 0.0;
};

/// Of b from a. None where they lead elsewhere, or one beside the other.
std::optional<PlanOffset> offsetInPlan(const FlightPlace& a, const FlightPlace& b) {
  const Eigen::Vector3d uphill = a.uphill();
  const Eigen::Vector3d between = (b.foot - a.foot).head<3>();
  const double along = uphill.dot(between);
  const PlanOffset offset{.along = along,
                          .gap = std::max({0.0, along - a.last, -(along + b.last)}),
                          .aside = Eigen::Vector3d::UnitZ().cross(uphill).dot(between),
                          .turn = geometry::normalizeAngle(b.foot.w() - a.foot.w())};
  if (std::abs(offset.turn) > kGreatestTurn || std::abs(offset.aside) > (a.width + b.width) / 2.0) return std::nullopt;
  return offset;
}

/// Metres that b's edges lie over a's, where both were seen, or nearly.
double heightOver(const FlightPlace& a, const FlightPlace& b, const PlanOffset& offset) {
  const double middle = (std::max(0.0, offset.along) + std::min(a.last, offset.along + b.last)) / 2.0;
  return b.foot.z() - a.foot.z() + b.slope * (middle - offset.along) - a.slope * middle;
}

/// Of two that may be parts of one flight: their edges lie in one slope, beside or above each other.
std::optional<double> distanceOfSame(const FlightPlace& a, const FlightPlace& b, const EntityMemoryConfig& config) {
  const auto offset = offsetInPlan(a, b);
  if (!offset || offset->gap > kGreatestGap) return std::nullopt;

  const Eigen::Matrix4d covariance = turned(poseOf({0.0, 0.0, 0.0, -a.foot.w()}), a.covariance + b.covariance);
  const double floor = 2.0 * square(config.positionFloor);
  const double partly = a.widthIsWhole && b.widthIsWhole ? 0.0 : (a.width + b.width) / 4.0;
  const double acrossVariance = covariance(1, 1) + floor + square(partly);
  const double turnVariance = covariance(3, 3) + 2.0 * square(config.headingFloor);
  const double riseVariance = floor + square(0.1 * offset->gap);
  const double distance = square(offset->aside) / acrossVariance + square(offset->turn) / turnVariance +
                          square(heightOver(a, b, *offset)) / riseVariance;
  if (!(distance < kGate)) return std::nullopt;
  return distance;
}

bool isPossible(const StaircaseSighting& sighting) {
  if (!geometry::isFinite(sighting.T_submap_stairs) || !isCovariance(sighting.covariance) ||
      sighting.steps.size() < 2 || !(sighting.width > 0.0 && sighting.width < kGreatestWidth) ||
      !std::isfinite(sighting.evidence) || !std::isfinite(sighting.newFloor_z) ||
      !std::isfinite(sighting.newFloorSigma)) {
    return false;
  }
  for (std::size_t i = 0; i < sighting.steps.size(); ++i) {
    const auto& step = sighting.steps[i];
    if (!std::isfinite(step.z) || !std::isfinite(step.along)) return false;
    if (i == 0) continue;
    const auto& below = sighting.steps[i - 1];
    if (!(step.z > below.z && step.along > below.along)) return false;
  }
  const double rises = static_cast<double>(sighting.steps.size() - 1);
  return (sighting.steps.back().z - sighting.steps.front().z) / rises < kGreatestRiser;
}

}  // namespace

void StaircaseMemory::add(const Frames& frames, const Eigen::Vector3d& sensor_in_submap,
                          std::span<const StaircaseSighting> stairs) {
  std::vector<StaircaseSighting> possible;
  for (const auto& sighting : stairs) {
    if (!isPossible(sighting)) continue;
    if (auto* flight = seenFromElsewhere(frames, sighting)) {
      flight->noteDetection(sighting.time);
    } else {
      possible.push_back(sighting);
    }
  }
  const auto landmarkOf = associate(frames, possible);
  for (std::size_t i = 0; i < possible.size(); ++i) {
    auto& flight = landmarks_[landmarkOf[i]];
    fuse(flight, lookFrom(flight.looks, frames.submap(), sensor_in_submap, config_.lookSpacing), possible[i]);
    flight.noteDetection(possible[i].time);
    if (!refresh(flight, frames, config_)) flight.looks.clear();
  }
  const bool isElsewhere = lastSubmap_ != frames.submap();
  lastSubmap_ = frames.submap();
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    const bool isTouched = isElsewhere || std::ranges::find(landmarkOf, i) != landmarkOf.end();
    for (std::size_t j = 0; isTouched && j < landmarks_.size(); ++j) mergeIfSame(i, j, frames);
  }
  std::erase_if(landmarks_, [](const auto& flight) { return flight.looks.empty(); });
}

/// Where poses do not tell that the robot climbs, the flight that it climbs seems to sink. Nobody fits between two
/// flights so near to each other: that one is meant. Once this has happened, heights tell flights apart no longer.
StaircaseLandmark* StaircaseMemory::seenFromElsewhere(const Frames& frames, const StaircaseSighting& sighting) {
  const auto seen = placeOf(sighting);
  StaircaseLandmark* meant = nullptr;
  for (auto& flight : landmarks_) {
    const auto place = placeOf(flight, frames, config_);
    if (distanceOfSame(place, seen, config_)) return nullptr;
    const auto offset = offsetInPlan(place, seen);
    if (flight.logOdds < config_.certainty || !offset || offset->gap > 0.0) continue;
    const double height = std::abs(heightOver(place, seen, *offset));
    if (heightsAreLost_ || (height > kLeastClimb && height < kHeadroom)) meant = &flight;
  }
  heightsAreLost_ = heightsAreLost_ || meant != nullptr;
  return meant;
}

std::vector<std::size_t> StaircaseMemory::associate(const Frames& frames, std::span<const StaircaseSighting> stairs) {
  Eigen::MatrixXd costs(stairs.size(), landmarks_.size());
  for (std::size_t j = 0; j < landmarks_.size(); ++j) {
    const auto place = placeOf(landmarks_[j], frames, config_);
    for (std::size_t i = 0; i < stairs.size(); ++i) {
      costs(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          distanceOfSame(place, placeOf(stairs[i]), config_).value_or(geometry::kForbidden);
    }
  }
  const auto assigned = geometry::assign(costs);
  std::vector<std::size_t> landmarkOf;
  for (std::size_t i = 0; i < stairs.size(); ++i) {
    landmarkOf.push_back(assigned[i] ? static_cast<std::size_t>(*assigned[i]) : landmarks_.size());
    if (assigned[i]) continue;
    auto& flight = landmarks_.emplace_back();
    flight.submap = flight.pointsSubmap = frames.submap();
  }
  return landmarkOf;
}

void StaircaseMemory::mergeIfSame(std::size_t i, std::size_t j, const Frames& frames) {
  auto* kept = &landmarks_[i];
  auto* other = &landmarks_[j];
  if (i == j || kept->looks.empty() || other->looks.empty()) return;
  if (!distanceOfSame(placeOf(*kept, frames, config_), placeOf(*other, frames, config_), config_)) return;
  if (isOlder(*other, *kept)) std::swap(kept, other);
  if (other->isTold) merged_.push_back(*other->id);
  kept->looks.insert(kept->looks.end(), other->looks.begin(), other->looks.end());
  while (kept->looks.size() > kMostLooks) {
    kept->looks.erase(std::ranges::min_element(kept->looks, {}, &Look::sightings));
  }
  kept->takeOver(*other);
  other->looks.clear();
  if (!refresh(*kept, frames, config_)) kept->looks.clear();
}

void StaircaseMemory::look(const Frames& frames, const RgbdView& view, const Surfaces& surfaces) {
  if (!geometry::isFinite(view.T_submap_camera) || surfaces.depth.known() == 0 || heightsAreLost_) return;
  for (auto& flight : landmarks_) {
    if (flight.lastDetected != view.time) {
      see(flight, frames, view, surfaces);
    } else if (flight.descendsNow) {
      const Eigen::Vector3d camera = view.T_submap_camera.translation();
      fuseFloorAbove(lookFrom(flight.looks, frames.submap(), camera, config_.lookSpacing), surfaces.floor_z);
      refresh(flight, frames, config_);
    }
  }
}

/// Treads that should be seen, and are not there or not found.
void StaircaseMemory::see(StaircaseLandmark& stairs, const Frames& frames, const RgbdView& view,
                          const Surfaces& surfaces) const {
  const auto place = placeOf(stairs, frames, config_);
  const auto T_camera_submap = view.T_submap_camera.inverse();
  const Eigen::Vector3d across = Eigen::Vector3d::UnitZ().cross(place.uphill());
  const int treads = static_cast<int>(std::lround(stairs.rise / stairs.riser));
  int spots = 0;
  int known = 0;
  int through = 0;
  for (int tread = 0; tread < treads; ++tread) {
    for (const double share : {-0.3, 0.0, 0.3}) {
      Eigen::Vector3d spot = place.foot.head<3>() + (tread + 0.5) * stairs.depth * place.uphill();
      spot += share * stairs.width * across;
      spot.z() += tread * stairs.riser;
      const Eigen::Vector3d spot_in_camera = T_camera_submap * spot;
      if (spot_in_camera.norm() > kFarthestLook) continue;
      ++spots;
      const auto* cell = surfaces.depth.cellAt(spot_in_camera);
      if (cell == nullptr) continue;
      const double beyond = static_cast<double>(cell->depth) - spot_in_camera.z();
      if (beyond < -kInSlope) continue;
      ++known;
      if (beyond > kInSlope) ++through;
    }
  }
  constexpr int kLeastSpots = 9;
  if (spots < kLeastSpots || known < kWellSeenShare * spots) return;
  const bool isRefuted = through >= kClearlyThrough * known;
  countMiss(stairs, frames.submap(), view.T_submap_camera.translation(),
            config_.stairsMiss * (isRefuted ? kNothing : 1.0), config_);
}

}  // namespace prodomos::perception

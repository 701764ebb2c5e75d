// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/door_memory.hpp"

#include "prodomos/geometry/assignment.hpp"

#include <algorithm>
#include <cmath>

namespace prodomos::perception {

namespace {

/// Where a door that is there is found in most images: near enough, not too oblique, whole and hardly hidden.
constexpr double kWellSeenRange = 4.0;      // metres
constexpr double kWellSeenObliquity = 1.0;  // radians
constexpr double kWellSeenShare = 0.9;      // of its spots
constexpr double kFarthestLook = 6.0;       // metres
constexpr double kGreatestRise = 2.0;       // metres between a door's foot and a scan of its storey
/// Shares of the spots that tell the state.
constexpr double kLeastKnown = 0.3;
constexpr double kMostlyKnown = 0.75;
constexpr double kClearlyThrough = 0.8;
constexpr double kWhollyFilled = 0.95;  // of what is known: less, and it is not closed
constexpr double kFrontal = 1.15;       // radians; beyond, jambs fill an open door as well as its leaf would
constexpr double kHardlyFilled = 0.5;   // where a closed leaf was found all the same, it was none
constexpr double kGreatestSigma = 0.2;  // metres; where a door is known no better, one may look past it
/// Where there is no wall, there is no door: as bad as so many misses.
constexpr double kNoWall = 3.0;
/// A door in the map gives way to one in its place only where that is likelier by so much.
constexpr double kClearlyLikelier = 1.0;

/// How likely a reading is where the door is truly closed, ajar, open; as counted in simulated buildings.
using Likelihoods = DoorStateFilter::Likelihoods;
constexpr Likelihoods kOpening = {0.05, 0.45, 0.5};     // found, with no leaf in it
constexpr Likelihoods kClosedLeaf = {0.5, 0.25, 0.25};  // found, also where a leaf or jamb is seen from aside
// Of what depth shows in its place:
constexpr Likelihoods kSeenThrough = {0.02, 0.18, 0.8};
constexpr Likelihoods kNotClosed = {0.02, 0.46, 0.52};
constexpr Likelihoods kFilledFromBefore = {0.8, 0.12, 0.08};
constexpr Likelihoods kFilledFromAside = {0.48, 0.24, 0.28};
// Where the leaf is, its sightings tell.
constexpr Likelihoods kNotClosedInScan = {0.02, 0.49, 0.49};

void tellState(DoorLandmark& door, base::Time time, const Likelihoods& likelihoods, const EntityMemoryConfig& config) {
  const auto before = door.state.state();
  door.state.update(time, likelihoods, config.stateMemory);
  door.lastSeen = std::max(door.lastSeen, time);
  door.hasChanged = true;
  if (door.state.state() != before) door.tidings.push_back({time, door.state.state()});
}

void tellState(DoorLandmark& door, const DoorSighting& sighting, const EntityMemoryConfig& config) {
  if (!sighting.door.hasLeaf) {
    tellState(door, sighting.time, kOpening, config);
  } else if (sighting.door.state == map::DoorState::kClosed) {
    tellState(door, sighting.time, kClosedLeaf, config);
  } else if (sighting.door.state != map::DoorState::kUnknown) {
    tellState(door, sighting.time, DoorStateFilter::told(sighting.door.state, config.stateTrust), config);
  }
}

bool isWellSeen(const DoorAppearance& appearance) {
  return appearance.isWhole && appearance.range < kWellSeenRange && appearance.obliquity < kWellSeenObliquity &&
         appearance.known() > kWellSeenShare;
}

/// None: too little is seen of it.
std::optional<Likelihoods> toldByDepth(const DoorAppearance& appearance) {
  const double known = appearance.known();
  if (known < kLeastKnown) return std::nullopt;
  if (appearance.through >= kClearlyThrough * known) return kSeenThrough;
  if (appearance.filled < kWhollyFilled * known) return kNotClosed;
  const bool isFromBefore = appearance.obliquity < kFrontal && known >= kMostlyKnown;
  return isFromBefore ? kFilledFromBefore : kFilledFromAside;
}

/// What it said before does not count.
DoorLook& newLookOfGrid(std::vector<DoorLook>& looks, base::SubMapId submap) {
  auto& look = lookOfGrid(looks, submap);
  look = DoorLook{};
  look.submap = submap;
  look.ofGrid = true;
  return look;
}

/// Of a scan: people, and who looks along the wall, tell nothing; nor does an opening where the door is not closed, for
/// how far it is open is not seen.
std::optional<Likelihoods> toldByScan(const DoorAppearance& appearance, map::DoorState state) {
  constexpr double kClearlyNotFilled = 0.7;
  const double known = appearance.known();
  if (known < kMostlyKnown || appearance.obliquity > kFrontal) return std::nullopt;
  if (appearance.filled >= kWhollyFilled * known) return kFilledFromBefore;
  const bool isNews = state == map::DoorState::kClosed;
  if (isNews && appearance.filled < kClearlyNotFilled * known) return kNotClosedInScan;
  return std::nullopt;
}

bool isPlaced(const DoorPlace& place) {
  return place.covariance.topLeftCorner<2, 2>().trace() <= kGreatestSigma * kGreatestSigma;
}

double likelihoodToStay(const DoorLandmark& door) {
  return door.logOdds + (door.id && !door.isRivalled ? kClearlyLikelier : 0.0);
}

}  // namespace

void DoorMemory::add(const Frames& frames, const Eigen::Vector3d& sensor_in_submap,
                     std::span<const DoorSighting> doors) {
  std::vector<DoorSighting> possible;
  std::ranges::copy_if(doors, std::back_inserter(possible), [this](const auto& d) { return isPossible(d, config_); });
  const auto landmarkOf = associate(frames, possible);
  std::vector<std::size_t> touched;
  for (std::size_t i = 0; i < possible.size(); ++i) {
    if (!landmarkOf[i]) continue;
    auto& door = landmarks_[*landmarkOf[i]];
    auto& look = lookFrom(door.looks, frames.submap(), sensor_in_submap, config_.lookSpacing);
    fuse(look, possible[i], geometry::yaw(frames.T_submap_other(door.submap) * poseOf(door.pose_in_submap)), config_);
    door.noteDetection(possible[i].time);
    door.closedLeafNow = possible[i].door.state == map::DoorState::kClosed ? possible[i].evidence : 0.0;
    tellState(door, possible[i], config_);
    touched.push_back(*landmarkOf[i]);
  }
  update(frames, touched);
}

void DoorMemory::addFromGrid(const Frames& frames, std::span<const DoorSighting> doorways,
                             const EntityMemory::ShowsNoDoorway& showsNone) {
  std::vector<DoorSighting> possible;
  std::ranges::copy_if(doorways, std::back_inserter(possible),
                       [this](const auto& d) { return isPossible(d, config_); });
  const auto landmarkOf = associate(frames, possible);
  std::vector<std::size_t> touched;
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    const bool isFound = std::ranges::find(landmarkOf, i) != landmarkOf.end();
    if (!isFound && miss(landmarks_[i], frames, showsNone)) touched.push_back(i);
  }
  for (std::size_t i = 0; i < possible.size(); ++i) {
    if (!landmarkOf[i]) continue;
    auto& door = landmarks_[*landmarkOf[i]];
    auto& look = newLookOfGrid(door.looks, frames.submap());
    fuse(look, possible[i], geometry::yaw(frames.T_submap_other(door.submap) * poseOf(door.pose_in_submap)), config_);
    door.noteDetection(possible[i].time);
    door.firstSeen = std::min(door.firstSeen, possible[i].since.value_or(door.firstSeen));
    touched.push_back(*landmarkOf[i]);
  }
  update(frames, touched);
  mergeAll(frames);
}

bool DoorMemory::miss(DoorLandmark& door, const Frames& frames, const EntityMemory::ShowsNoDoorway& showsNone) const {
  if (!std::ranges::any_of(door.looks, &DoorLook::ofGrid)) return false;  // a grid never showed it: a leaf, perhaps
  const bool isRefuted =
      !hasLeaf(door) && showsNone(frames.T_submap_other(door.submap) * poseOf(door.pose_in_submap), door.width);
  const bool hadItsSay = std::ranges::any_of(
      door.looks, [&frames](const DoorLook& look) { return look.ofGrid && look.submap == frames.submap(); });
  if (!isRefuted && !hadItsSay) return false;
  auto& look = newLookOfGrid(door.looks, frames.submap());
  if (isRefuted) {
    look.misses = 1;
    look.evidence = -config_.doorwayMiss;
  }
  return true;
}

std::vector<std::optional<std::size_t>> DoorMemory::associate(const Frames& frames,
                                                              std::span<const DoorSighting> doors) {
  std::vector<DoorPlace> places;
  for (const auto& door : landmarks_) places.push_back(placeOf(door, frames, config_));
  Eigen::MatrixXd costs(doors.size(), places.size());
  for (std::size_t i = 0; i < doors.size(); ++i) {
    for (std::size_t j = 0; j < places.size(); ++j) {
      costs(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          distanceOfSame(places[j], placeOf(doors[i]), config_).value_or(geometry::kForbidden);
    }
  }
  const auto assigned = geometry::assign(costs);
  std::vector<std::optional<std::size_t>> landmarkOf(doors.size());
  for (std::size_t i = 0; i < doors.size(); ++i) {
    if (assigned[i]) {
      landmarkOf[i] = static_cast<std::size_t>(*assigned[i]);
      continue;
    }
    // Two detectors may find one door: the second sighting says nothing new.
    if (costs.cols() > 0 && std::isfinite(costs.row(static_cast<Eigen::Index>(i)).minCoeff())) continue;
    landmarkOf[i] = landmarks_.size();
    auto& door = landmarks_.emplace_back();
    door.submap = frames.submap();
    door.pose_in_submap = vectorOf(doors[i].T_submap_door);
  }
  return landmarkOf;
}

void DoorMemory::update(const Frames& frames, const std::vector<std::size_t>& touched) {
  for (const auto i : touched) {
    if (std::ranges::any_of(landmarks_[i].looks, [](const auto& look) { return look.sightings > 0; })) {
      refresh(landmarks_[i], frames, config_);
    } else {
      landmarks_[i].logOdds = logOddsOf(landmarks_[i].looks, config_);
    }
  }
  for (const auto i : touched) {
    for (std::size_t j = 0; j < landmarks_.size(); ++j) {
      if (!mergeIfSame(i, j, frames) && !takeLeaf(i, j, frames)) takeLeaf(j, i, frames);
    }
  }
  for (const auto i : touched) settleRivals(i, frames);
  prune();
  if (lastSubmap_ != frames.submap()) mergeAll(frames);
  lastSubmap_ = frames.submap();
}

bool DoorMemory::mergeIfSame(std::size_t i, std::size_t j, const Frames& frames) {
  auto* kept = &landmarks_[i];
  auto* other = &landmarks_[j];
  if (i == j || kept->looks.empty() || other->looks.empty()) return false;
  if (!distanceOfSame(placeOf(*kept, frames, config_), placeOf(*other, frames, config_), config_)) return false;
  if (isOlder(*other, *kept)) std::swap(kept, other);
  if (other->isTold) merged_.push_back(*other->id);
  takeOver(*kept, *other, frames);
  other->looks.clear();
  refresh(*kept, frames, config_);
  return true;
}

bool DoorMemory::takeLeaf(std::size_t doorIndex, std::size_t leafIndex, const Frames& frames) {
  constexpr double kHingeEvidence = 2.0;  // log-odds
  auto& door = landmarks_[doorIndex];
  auto& leaf = landmarks_[leafIndex];
  if (doorIndex == leafIndex || door.looks.empty() || leaf.looks.empty()) return false;
  const auto standsOpen = [](const DoorLandmark& any) {
    return any.state.state() == map::DoorState::kOpen || any.state.state() == map::DoorState::kAjar;
  };
  if ((hasLeaf(door) && !standsOpen(door)) || door.logOdds < config_.certainty) return false;
  if (!hasLeaf(leaf) || standsOpen(leaf)) return false;
  const auto side = hingeSideOfLeaf(placeOf(leaf, frames, config_), placeOf(door, frames, config_));
  if (!side) return false;
  door.leafAside += leaf.leaf;
  door.hingeAside += *side == map::HingeSide::kLeft ? kHingeEvidence : -kHingeEvidence;
  if (leaf.isTold) merged_.push_back(*leaf.id);
  leaf.looks.clear();
  refresh(door, frames, config_);
  return true;
}

void DoorMemory::mergeAll(const Frames& frames) {
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    for (std::size_t j = i + 1; j < landmarks_.size(); ++j) {
      if (mergeIfSame(i, j, frames)) settleRivals(landmarks_[i].looks.empty() ? j : i, frames);
    }
  }
  prune();
}

void DoorMemory::settleRivals(std::size_t door, const Frames& frames) {
  if (landmarks_[door].looks.empty()) return;
  std::vector<std::size_t> together{door};
  const auto place = placeOf(landmarks_[door], frames, config_);
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    if (i == door || landmarks_[i].looks.empty()) continue;
    if (standInOnePlace(place, placeOf(landmarks_[i], frames, config_))) together.push_back(i);
  }
  const auto best =
      std::ranges::max_element(together, {}, [this](std::size_t i) { return likelihoodToStay(landmarks_[i]); });
  for (const auto i : together) landmarks_[i].isRivalled = i != *best;
}

void DoorMemory::prune() {
  std::erase_if(landmarks_, [](const DoorLandmark& door) { return door.looks.empty(); });
}

void DoorMemory::look(const Frames& frames, const RgbdView& view, const Surfaces& surfaces) {
  const Eigen::Vector3d camera = view.T_submap_camera.translation();
  if (!geometry::isFinite(view.T_submap_camera) || surfaces.depth.known() == 0) return;
  for (auto& door : landmarks_) {
    const Eigen::Vector3d middle = frames.T_submap_other(door.submap) * door.pose_in_submap.head<3>();
    if ((middle - camera).head<2>().norm() < kFarthestLook) see(door, frames, view, surfaces);
  }
}

void DoorMemory::look(const Frames& frames, const geometry::Pose3& T_submap_sensor, const std::vector<ScanBeam>& beams,
                      base::Time time) {
  const geometry::Pose3 T_sensor_submap = T_submap_sensor.inverse();
  for (auto& door : landmarks_) {
    const auto place = placeOf(door, frames, config_);
    const geometry::Pose3 T_sensor_door = T_sensor_submap * poseOf(place.pose);
    const bool isInReach = T_sensor_door.translation().head<2>().norm() < kWellSeenRange &&
                           std::abs(T_sensor_door.translation().z()) < kGreatestRise;
    if (!isInReach || !isPlaced(place)) continue;
    if (const auto told = toldByScan(appearanceOf(T_sensor_door, door.width, beams), door.state.state())) {
      tellState(door, time, *told, config_);
    }
  }
}

/// What was taken for a closed leaf in this view is none: there is no surface.
void DoorMemory::takeBackLeaf(DoorLandmark& door, const Frames& frames, const RgbdView& view) const {
  if (!(door.closedLeafNow > 0.0)) return;
  auto& look = lookFrom(door.looks, frames.submap(), view.T_submap_camera.translation(), config_.lookSpacing);
  look.leaf -= door.closedLeafNow + config_.openingAgainstLeaf;
  door.closedLeafNow = 0.0;
  refresh(door, frames, config_);
  tellState(door, view.time, kSeenThrough, config_);
}

void DoorMemory::see(DoorLandmark& door, const Frames& frames, const RgbdView& view, const Surfaces& surfaces) const {
  const auto place = placeOf(door, frames, config_);
  if (!isPlaced(place)) return;
  const auto appearance = appearanceOf(poseOf(place.pose), door.width, door.height, view, surfaces);
  const bool isDetected = door.lastDetected == view.time;
  const auto told = appearance.hasNoWall ? std::nullopt : toldByDepth(appearance);
  if (told) tellState(door, view.time, *told, config_);
  const bool isClear = appearance.known() >= kLeastKnown;
  if (isDetected && isClear && appearance.filled < kHardlyFilled * appearance.known()) takeBackLeaf(door, frames, view);
  const bool isRefuted = appearance.hasNoWall && appearance.through >= kClearlyThrough;
  if (isDetected || !(isRefuted || isWellSeen(appearance))) return;
  countMiss(door, frames.submap(), view.T_submap_camera.translation(), config_.doorMiss * (isRefuted ? kNoWall : 1.0),
            config_);
}

}  // namespace prodomos::perception

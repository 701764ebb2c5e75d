// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/door_landmark.hpp"

#include "perception/door_association.hpp"
#include "perception/numeric.hpp"
#include "perception/robust_mean.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace prodomos::perception {

namespace {

constexpr double kWidthFloor = 0.03;   // metres; no look measures a width better
constexpr double kHeightSigma = 0.05;  // metres
/// A sub-map must show it so many times better than the one where it is, or it would go to and fro.
constexpr double kClearlyBetter = 1.5;
/// Log-odds from which on a side is told, and a leaf is believed.
constexpr double kTold = 0.3;
constexpr double kLeafTold = 0.5;

void flip(DoorLook& look) {
  look.pose_in_submap.w() = geometry::normalizeAngle(look.pose_in_submap.w() + std::numbers::pi);
  look.hinge = -look.hinge;
}

/// What all of a look's sightings are worth: one of them, or some more.
Eigen::Matrix4d covarianceOf(const DoorLook& look, double correlation) {
  return look.information.inverse() * (1.0 + (look.sightings - 1) * correlation);
}

base::SubMapId bestSubmap(const DoorLandmark& door, double correlation) {
  std::map<base::SubMapId, double> goodness;
  for (const auto& look : door.looks) {
    if (look.sightings == 0) continue;
    goodness[look.submap] += 1.0 / covarianceOf(look, correlation).topLeftCorner<2, 2>().trace();
  }
  const auto best = std::ranges::max_element(goodness, {}, &std::pair<const base::SubMapId, double>::second);
  const auto current = goodness.find(door.submap);
  const bool stays = current != goodness.end() && best->second < kClearlyBetter * current->second;
  return stays ? door.submap : best->first;
}

Measured<1> scalar(double value, double variance) {
  return {Eigen::Matrix<double, 1, 1>(value), Eigen::Matrix<double, 1, 1>(variance)};
}

void refreshSize(DoorLandmark& door, double correlation) {
  std::vector<Measured<1>> widths;
  std::vector<Measured<1>> heights;
  for (const auto& look : door.looks) {
    if (look.width.weight > 0.0) {
      const double variance = (1.0 + (look.sightings - 1) * correlation) / look.width.weight;
      widths.push_back(scalar(look.width.value, variance + square(kWidthFloor)));
    }
    if (look.height.weight > 0.0) heights.push_back(scalar(look.height.value, square(kHeightSigma)));
  }
  if (!widths.empty()) {
    const auto width = robustMean(widths);
    door.width = width.value.value();
    door.widthSigma = std::sqrt(width.covariance.value());
  }
  door.height = heights.empty() ? 0.0 : robustMean(heights).value.value();
}

void refreshPose(DoorLandmark& door, const Frames& frames, const EntityMemoryConfig& config) {
  const Vector4 floor(square(config.positionFloor), square(config.positionFloor), square(config.positionFloor),
                      square(config.headingFloor));
  std::vector<Measured<4>> poses;
  for (const auto& look : door.looks) {
    if (look.sightings == 0) continue;
    const auto& T_here_there = frames.T_submap_other(look.submap);
    Measured<4> pose{vectorOf(T_here_there * poseOf(look.pose_in_submap)),
                     turned(T_here_there, covarianceOf(look, config.correlation))};
    pose.covariance.diagonal() += floor;
    if (look.submap != door.submap) {
      pose.covariance += uncertaintyBetween(config, look.pose_in_submap.head<2>().norm());
    }
    // Unwrapped: all headings are near that of the first.
    if (!poses.empty()) {
      const double first = poses.front().value.w();
      pose.value.w() = first + geometry::normalizeAngle(pose.value.w() - first);
    }
    poses.push_back(pose);
  }
  const auto mean = robustMean(poses);
  door.pose_in_submap = mean.value;
  door.pose_in_submap.w() = geometry::normalizeAngle(mean.value.w());
  door.covariance = mean.covariance;
}

map::Door attributesOf(const DoorLandmark& door) {
  map::Door attributes{.width = door.width, .height = door.height, .hasLeaf = hasLeaf(door)};
  if (!attributes.hasLeaf) {
    attributes.state = map::DoorState::kOpen;
    return attributes;
  }
  if (std::abs(door.hinge) > kTold) {
    attributes.hingeSide = door.hinge > 0.0 ? map::HingeSide::kLeft : map::HingeSide::kRight;
  }
  attributes.state = door.state.state();
  return attributes;
}

}  // namespace

void fuse(DoorLook& look, DoorSighting sighting, double yaw_in_submap, const EntityMemoryConfig& config) {
  Vector4 pose = vectorOf(sighting.T_submap_door);
  if (areOpposed(pose.w(), yaw_in_submap)) {
    pose.w() += std::numbers::pi;
    sighting.hingeEvidence = -sighting.hingeEvidence;
  }
  Eigen::Matrix4d covariance = sighting.covariance;
  covariance.diagonal() += Vector4::Constant(1e-6);  // what is said to be known exactly is not
  const Eigen::Matrix4d information = covariance.inverse();
  look.information += information;
  if (look.sightings == 0) look.pose_in_submap = pose;
  Vector4 off = pose - look.pose_in_submap;
  off.w() = geometry::normalizeAngle(off.w());
  look.pose_in_submap += look.information.ldlt().solve(information * off);
  look.pose_in_submap.w() = geometry::normalizeAngle(look.pose_in_submap.w());
  look.width.add(sighting.door.width, 1.0 / square(std::max(0.01, sighting.widthSigma)));
  if (sighting.door.height > 0.0) look.height.add(sighting.door.height, 1.0);
  look.hinge += sighting.hingeEvidence;
  look.leaf += sighting.door.hasLeaf ? sighting.evidence : -config.openingAgainstLeaf;
  look.evidence += sighting.evidence;
  ++look.sightings;
}

void refresh(DoorLandmark& door, const Frames& frames, const EntityMemoryConfig& config) {
  door.submap = bestSubmap(door, config.correlation);
  refreshPose(door, frames.seenFrom(door.submap), config);
  refreshSize(door, config.correlation);
  door.hinge = door.hingeAside;
  door.leaf = door.leafAside;
  for (const auto& look : door.looks) {
    if (look.sightings == 0) continue;
    const double share = Look::worth(look.sightings, config.correlation) / look.sightings;
    door.hinge += share * look.hinge;
    door.leaf += share * look.leaf;
  }
  door.logOdds = logOddsOf(door.looks, config);
  door.hasChanged = true;
}

void takeOver(DoorLandmark& kept, const DoorLandmark& other, const Frames& frames) {
  const auto headingHere = [&frames](const DoorLandmark& door) {
    return geometry::yaw(frames.T_submap_other(door.submap) * poseOf(door.pose_in_submap));
  };
  const bool opposed = areOpposed(headingHere(kept), headingHere(other));
  for (auto look : other.looks) {
    if (opposed) flip(look);
    auto& own = look.ofGrid ? lookOfGrid(kept.looks, look.submap) : kept.looks.emplace_back();
    if (own.sightings == 0) own = look;
  }
  kept.leafAside += other.leafAside;
  kept.hingeAside += opposed ? -other.hingeAside : other.hingeAside;
  while (countOfReadings(kept.looks) > kMostLooks) kept.looks.erase(poorestOfReadings(kept.looks));
  kept.takeOver(other);
}

bool hasLeaf(const DoorLandmark& door) {
  return door.leaf > kLeafTold;
}

map::Entity entityOf(const DoorLandmark& door) {
  map::Entity entity = door.entity();
  entity.T_submap_entity = poseOf(door.pose_in_submap);
  entity.covariance = covariance6(door.covariance);
  entity.attributes = attributesOf(door);
  // A grid tells that a door stood open, but not when: that says nothing of its state now.
  if (hasLeaf(door)) entity.lastSeen = door.state.time().value_or(door.lastSeen);
  return entity;
}

}  // namespace prodomos::perception

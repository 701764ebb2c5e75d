// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/door_association.hpp"

#include "perception/numeric.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace prodomos::perception {

namespace {

constexpr double kGreatestTurn = 0.6;   // radians, between normals of one door
constexpr double kGreatestRise = 1.0;   // metres: other storeys
constexpr double kGreatestDepth = 0.5;  // metres across the wall
constexpr double kGate = 15.1;          // chi² of 5 degrees of freedom, 99 %
constexpr double kRecess = 0.1;         // metres that a leaf stands off the middle of its opening
constexpr double kTallest = 4.0;        // metres
constexpr double kFarthest = 1e4;       // metres from the sub-map's origin

/// From a to b: along a's normal, along the wall, up, turn of the lines.
Vector4 offsetBetween(const DoorPlace& a, const DoorPlace& b) {
  const Eigen::Vector2d between = (b.pose - a.pose).head<2>();
  const Eigen::Vector2d normal(std::cos(a.pose.w()), std::sin(a.pose.w()));
  const double turn = geometry::normalizeAngle(b.pose.w() - a.pose.w());
  const double lineTurn = areOpposed(a.pose.w(), b.pose.w()) ? geometry::normalizeAngle(turn + std::numbers::pi) : turn;
  return {normal.dot(between), normal.x() * between.y() - normal.y() * between.x(), b.pose.z() - a.pose.z(), lineTurn};
}

bool isNear(const Vector4& offset) {
  return std::abs(offset[0]) < kGreatestDepth && std::abs(offset[2]) < kGreatestRise &&
         std::abs(offset[3]) < kGreatestTurn;
}

}  // namespace

bool areOpposed(double yaw, double otherYaw) {
  return std::abs(geometry::normalizeAngle(yaw - otherYaw)) > std::numbers::pi / 2.0;
}

DoorPlace placeOf(const DoorSighting& sighting) {
  return {vectorOf(sighting.T_submap_door), sighting.covariance, sighting.door.width, sighting.widthSigma,
          sighting.door.hasLeaf};
}

DoorPlace placeOf(const DoorLandmark& door, const Frames& frames, const EntityMemoryConfig& config) {
  const auto& T_here_there = frames.T_submap_other(door.submap);
  DoorPlace place{vectorOf(T_here_there * poseOf(door.pose_in_submap)), turned(T_here_there, door.covariance),
                  door.width, door.widthSigma, hasLeaf(door)};
  if (door.submap != frames.submap()) {
    place.covariance += uncertaintyBetween(config, door.pose_in_submap.head<2>().norm());
  }
  return place;
}

std::optional<double> distanceOfSame(const DoorPlace& a, const DoorPlace& b, const EntityMemoryConfig& config) {
  const Vector4 offset = offsetBetween(a, b);
  const double half = std::max(a.width, b.width) / 2.0;
  if (!isNear(offset) || std::abs(offset[1]) > half) return std::nullopt;
  // Axes of the wall: along a's normal, along the wall.
  const auto T_wall_here = poseOf({0.0, 0.0, 0.0, -a.pose.w()});
  Eigen::Matrix4d covariance = turned(T_wall_here, a.covariance + b.covariance);
  const double floor = 2.0 * square(config.positionFloor);
  covariance.diagonal() += Vector4(floor, floor, floor, 2.0 * square(config.headingFloor));
  if (a.hasLeaf != b.hasLeaf) covariance(0, 0) += square(kRecess);
  const double widthVariance = square(a.widthSigma) + square(b.widthSigma) + floor;
  const double distance = offset.dot(covariance.ldlt().solve(offset)) + square(a.width - b.width) / widthVariance;
  if (!(distance < kGate)) return std::nullopt;
  return distance;
}

std::optional<map::HingeSide> hingeSideOfLeaf(const DoorPlace& leaf, const DoorPlace& door) {
  constexpr double kLeastTurn = 0.2;   // radians
  constexpr double kAtJamb = 0.22;     // metres; jambs of two doors beside a corner lie further apart
  constexpr double kUnlike = 0.25;     // metres, of widths
  constexpr double kWidestLeaf = 1.2;  // metres; wider doors have two
  const Vector4 offset = offsetBetween(door, leaf);
  const double leafWidth = door.width > kWidestLeaf ? door.width / 2.0 : door.width;
  if (std::abs(offset[2]) > kGreatestRise || std::abs(offset[3]) < kLeastTurn) return std::nullopt;
  if (std::abs(leaf.width - leafWidth) > kUnlike) return std::nullopt;
  const auto endsOf = [](const DoorPlace& place) {
    const Eigen::Vector2d toLeft(-std::sin(place.pose.w()), std::cos(place.pose.w()));
    const Eigen::Vector2d middle = place.pose.head<2>();
    return std::array<Eigen::Vector2d, 2>{middle + 0.5 * place.width * toLeft, middle - 0.5 * place.width * toLeft};
  };
  const auto jambs = endsOf(door);
  for (const auto& end : endsOf(leaf)) {
    if ((end - jambs[0]).norm() < kAtJamb) return map::HingeSide::kLeft;
    if ((end - jambs[1]).norm() < kAtJamb) return map::HingeSide::kRight;
  }
  return std::nullopt;
}

bool standInOnePlace(const DoorPlace& a, const DoorPlace& b) {
  const Vector4 offset = offsetBetween(a, b);
  const double shared = (a.width + b.width) / 2.0 - std::abs(offset[1]);
  return isNear(offset) && shared > 0.5 * std::min(a.width, b.width);
}

bool isPossible(const DoorSighting& sighting, const EntityMemoryConfig& config) {
  const auto& door = sighting.door;
  const double greatestWidth = door.hasLeaf ? config.greatestDoorWidth : config.greatestOpening;
  return geometry::isFinite(sighting.T_submap_door) && isCovariance(sighting.covariance) &&
         sighting.T_submap_door.translation().norm() < kFarthest && door.width >= config.leastDoorWidth &&
         door.width <= greatestWidth && door.height >= 0.0 && door.height <= kTallest &&
         std::isfinite(sighting.widthSigma) && std::isfinite(sighting.evidence) &&
         std::isfinite(sighting.hingeEvidence);
}

}  // namespace prodomos::perception

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/open_door_scan.hpp"

#include "prodomos/perception/open_door_detector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace prodomos::perception::open_doors {

namespace {

using Eigen::Vector2d;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kLeastAngle = 8.0 * kDegree;  // less is a leaf that is closed in its recess
constexpr double kMostAngle = 100.0 * kDegree;
constexpr double kWidestLeaf = 1.15;  // metres
constexpr double kLeastWall = 0.2;    // metres of wall that tell its line
constexpr double kInWall = 0.06;      // metres that a wall's surface deviates from its line
// Where a leaf's axis may lie, metres behind the face of the wall.
constexpr double kLeastAxis = -0.08;
constexpr double kMostAxis = 0.35;
constexpr double kHidden = 0.35;  // of a leaf's length, by its jamb
// Log-odds, as counted in simulated buildings.
constexpr double kBothJambs = 2.0;
constexpr double kOneJamb = 0.7;

/// What a beam meets where it crosses a wall's line.
enum class Meets { kWall, kBefore, kThrough };

struct Crossing {
  double s = 0.0;  // metres along the line
  Meets meets = Meets::kThrough;
  Vector2d end_in_wall = Vector2d::Zero();  // what it meets
};

/// The line of a wall, seen from the sensor: s along it, y behind it.
class WallLine {
 public:
  WallLine(const std::vector<ScanBeam>& beams, const ScanSegment& wall) : origin_(wall.first), along_(wall.along()) {
    behind_ = Vector2d(-along_.y(), along_.x());
    if (behind_.dot(origin_) < 0.0) behind_ = -behind_;
    const double distance = behind_.dot(origin_);
    for (const auto& beam : beams) {
      const double towards = behind_.dot(beam.direction);
      if (!(towards > 0.02)) continue;
      const double y = beam.range * towards - distance;
      const Meets meets = std::abs(y) <= kInWall ? Meets::kWall : y < 0.0 ? Meets::kBefore : Meets::kThrough;
      crossings_.push_back({along_.dot(beam.direction * (distance / towards) - origin_), meets,
                            beam.isHit() ? inWall(beam.end()) : Vector2d::Zero()});
    }
    std::ranges::sort(crossings_, {}, &Crossing::s);
  }

  Vector2d inWall(const Vector2d& point) const { return {along_.dot(point - origin_), behind_.dot(point - origin_)}; }
  Vector2d inSensor(const Vector2d& point) const { return origin_ + point.x() * along_ + point.y() * behind_; }

  /// Crossings between two places of the line.
  std::span<const Crossing> between(double from, double to) const {
    const auto first = std::ranges::lower_bound(crossings_, std::min(from, to), {}, &Crossing::s);
    const auto last = std::ranges::lower_bound(crossings_, std::max(from, to), {}, &Crossing::s);
    return {first, std::max(first, last)};
  }
  /// Of the crossings between, those that meet it.
  double share(Meets wanted, double from, double to) const {
    const auto crossings = between(from, to);
    if (crossings.empty()) return 0.0;
    return static_cast<double>(std::ranges::count(crossings, wanted, &Crossing::meets)) /
           static_cast<double>(crossings.size());
  }
  /// Where wall begins on the way from one place to another. None where there is none, or wall all along.
  std::optional<double> edgeBetween(double from, double to) const;
  /// Metres between beams there.
  double spacingAt(double place) const {
    const auto next = std::ranges::lower_bound(crossings_, place, {}, &Crossing::s);
    if (next == crossings_.begin() || next == crossings_.end()) return 1.0;
    return next->s - std::prev(next)->s;
  }

 private:
  Vector2d origin_;
  Vector2d along_;
  Vector2d behind_;
  std::vector<Crossing> crossings_;  // along the line
};

std::optional<double> WallLine::edgeBetween(double from, double to) const {
  constexpr double kReveal = 0.025;  // metres behind the face: a jamb's side
  constexpr double kJamb = 0.1;      // metres of wall that make a jamb
  constexpr double kMostlyWall = 0.8;
  const double onward = to > from ? 1.0 : -1.0;
  const auto crossings = between(from, to);
  std::optional<double> before;
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    const auto& crossing = crossings[onward > 0.0 ? i : crossings.size() - 1 - i];
    if (crossing.meets != Meets::kWall) {
      before = crossing.s;
    } else if (before && share(Meets::kWall, crossing.s, crossing.s + onward * kJamb) >= kMostlyWall) {
      const auto& end = crossing.end_in_wall;
      return end.y() > kReveal ? end.x() : 0.5 * (crossing.s + *before);
    }
  }
  return std::nullopt;
}

/// A segment that may be a leaf: it ends freely at its tip.
struct LeafLine {
  Vector2d root;
  Vector2d tip;
  std::size_t segment = 0;
};

/// Whether what is beside the segment's first or last beam, but for an edge as thick as leaves are, lies clearly
/// behind.
bool endsFreely(const std::vector<ScanBeam>& beams, const ScanSegment& segment, bool atFirst) {
  constexpr double kThickness = 0.08;  // metres
  constexpr double kBehind = 0.1;      // metres
  constexpr int kBeams = 2;
  const auto count = std::ssize(beams);
  const auto onward = atFirst ? -1 : 1;
  auto at = static_cast<std::ptrdiff_t>(atFirst ? segment.begin : segment.end - 1);
  const auto& tip = beams[static_cast<std::size_t>(at)];
  const auto isEdge = [&](const ScanBeam& beam) {
    return beam.isHit() && (beam.end() - tip.end()).norm() < kThickness;
  };
  do at += onward;
  while (at >= 0 && at < count && isEdge(beams[static_cast<std::size_t>(at)]));
  for (int i = 0; i < kBeams; ++i, at += onward) {
    if (at < 0 || at >= count || beams[static_cast<std::size_t>(at)].range < tip.range + kBehind) return false;
  }
  return true;
}

class DoorSearch {
 public:
  DoorSearch(const std::vector<ScanBeam>& beams, double leastWidth)
      : beams_(beams), segments_(segmentsOf(beams)), leastWidth_(leastWidth) {}

  std::vector<ScannedDoor> doors() const;

 private:
  std::vector<LeafLine> leaves() const;
  std::optional<ScannedDoor> closedInto(const WallLine& wall, const LeafLine& leaf) const;
  std::optional<ScannedDoor> closedTo(const WallLine& wall, const LeafLine& leaf, double closing) const;

  const std::vector<ScanBeam>& beams_;
  std::vector<ScanSegment> segments_;
  double leastWidth_;
};

std::vector<LeafLine> DoorSearch::leaves() const {
  std::vector<LeafLine> leaves;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const auto& segment = segments_[i];
    const double length = segment.length();
    if (length < (1.0 - kHidden) * leastWidth_ || length > kWidestLeaf + kMostAxis) continue;
    if (endsFreely(beams_, segment, true)) leaves.push_back({segment.last, segment.first, i});
    if (endsFreely(beams_, segment, false)) leaves.push_back({segment.first, segment.last, i});
  }
  return leaves;
}

std::optional<ScannedDoor> DoorSearch::closedTo(const WallLine& wall, const LeafLine& leaf, double closing) const {
  constexpr double kOffJamb = 0.15;    // metres between what begins at a jamb and that jamb
  constexpr double kOffAxis = 0.05;    // metres between the leaf's line and its axis
  constexpr double kMostFilled = 0.1;  // of the gap
  constexpr double kLeastThrough = 0.2;
  constexpr double kMargin = 0.1;  // metres beside jambs
  const Vector2d root = wall.inWall(leaf.root);
  const Vector2d tip = wall.inWall(leaf.tip);
  const Vector2d along = (tip - root).normalized();
  const double angle = std::acos(std::clamp(closing * along.x(), -1.0, 1.0));
  if (angle < kLeastAngle || angle > kMostAngle) return std::nullopt;
  const double swing = tip.y() > root.y() ? 1.0 : -1.0;

  // Where its jamb is hidden, the leaf begins where its line meets the face of the wall.
  const double meeting = std::abs(along.y()) > 0.3 ? root.x() - along.x() * root.y() / along.y() : root.x();
  const auto seen = wall.edgeBetween(root.x() + closing * kOffJamb, root.x() - closing * kOffJamb);
  const double hinge = seen.value_or(std::clamp(meeting, root.x() - 0.1, root.x() + 0.1));
  const double length = closing * (tip.x() - hinge);  // of the leaf, along the wall
  const double reach = std::hypot(length, tip.y());
  const double least = std::max(leastWidth_, reach - kMostAxis) - kOffJamb;
  const auto jamb = wall.edgeBetween(hinge + closing * least, hinge + closing * (reach + kOffJamb));
  if (!jamb) return std::nullopt;
  const double width = closing * (*jamb - hinge);
  if (width < leastWidth_ || width > kWidestLeaf || length > width + 0.03) return std::nullopt;

  // The leaf's axis, from its length or, where that hardly tells, from its line.
  const double byLength = tip.y() - swing * std::sqrt(std::max(0.0, width * width - length * length));
  const double offLine = std::abs(along.x() * (byLength - root.y()) - along.y() * (hinge - root.x()));
  const double byLine = tip.y() - (tip.x() - hinge) * along.y() / along.x();
  const double offLength = std::abs(std::hypot(length, tip.y() - byLine) - width);
  const double axis = offLength < offLine ? byLine : byLength;
  if (std::min(offLine, offLength) > kOffAxis || axis < kLeastAxis || axis > kMostAxis) return std::nullopt;
  if ((root - Vector2d(hinge, axis)).norm() > kHidden * width) return std::nullopt;

  const double from = hinge + closing * kMargin;
  const double to = *jamb - closing * kMargin;
  const double through = wall.share(Meets::kThrough, from, to);
  if (wall.share(Meets::kWall, from, to) > kMostFilled || through < kLeastThrough) return std::nullopt;

  ScannedDoor door;
  door.hinge = wall.inSensor({hinge, 0.0});
  door.jamb = wall.inSensor({*jamb, 0.0});
  door.hingeJambIsSeen = seen.has_value();
  door.axisBehind = axis;
  door.angle = angle;
  door.sigma = 0.02 + 0.5 * std::max(wall.spacingAt(hinge), wall.spacingAt(*jamb));
  door.evidence = seen ? kBothJambs : kOneJamb;
  return door;
}

std::optional<ScannedDoor> DoorSearch::closedInto(const WallLine& wall, const LeafLine& leaf) const {
  const Vector2d root = wall.inWall(leaf.root);
  if (root.y() < kLeastAxis || root.y() > kMostAxis + 0.2) return std::nullopt;
  for (const double closing : {1.0, -1.0}) {
    if (const auto door = closedTo(wall, leaf, closing)) return door;
  }
  return std::nullopt;
}

std::vector<ScannedDoor> DoorSearch::doors() const {
  std::vector<ScannedDoor> found;
  const auto leaves = this->leaves();
  if (leaves.empty()) return found;
  constexpr double kNear = 1.5;  // metres from a leaf's root to its wall
  for (const auto& leaf : leaves) {
    std::optional<ScannedDoor> best;
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      const auto& segment = segments_[i];
      if (i == leaf.segment || segment.length() < kLeastWall) continue;
      if (std::min((segment.first - leaf.root).norm(), (segment.last - leaf.root).norm()) > kNear) continue;
      if (std::abs(segment.offset(leaf.root)) > kMostAxis + 0.2) continue;
      const auto door = closedInto(WallLine(beams_, segment), leaf);
      if (door && (!best || door->evidence > best->evidence)) best = door;
    }
    if (best) found.push_back(*best);
  }
  return found;
}

}  // namespace

std::vector<ScannedDoor> doorsIn(const std::vector<ScanBeam>& beams, double leastWidth) {
  return DoorSearch(beams, leastWidth).doors();
}

}  // namespace prodomos::perception::open_doors

namespace prodomos::perception {

namespace {

constexpr double kMostTilt = 0.1;                     // radians, of a level sensor
constexpr double kMostHeight = 1.8;                   // metres above the floor, of a leaf's edge
constexpr double kOpenFrom = std::numbers::pi / 3.0;  // docs/truth.md
constexpr double kHingeEvidence = 2.0;                // log-odds
constexpr double kAcrossSigma = 0.05;                 // metres; where in the wall the leaf hangs
constexpr double kFloorSigma = 0.03;                  // metres
constexpr double kYawSigma = 0.03;                    // radians
constexpr double kDeepest = 0.25;                     // metres, of walls

bool isLevel(const geometry::Pose3& T_body_sensor) {
  const double tilt = std::acos(std::clamp(T_body_sensor.linear()(2, 2), -1.0, 1.0));
  return tilt < kMostTilt && T_body_sensor.translation().z() < kMostHeight;
}

DoorSighting sightingOf(const open_doors::ScannedDoor& door, const geometry::Pose3& T_submap_sensor) {
  using Eigen::Vector2d;
  const auto inSubmap = [&T_submap_sensor](const Vector2d& point) -> Vector2d {
    return (T_submap_sensor * Eigen::Vector3d(point.x(), point.y(), 0.0)).head<2>();
  };
  const Vector2d hinge = inSubmap(door.hinge);
  const Vector2d jamb = inSubmap(door.jamb);
  const Vector2d along = (jamb - hinge).normalized();
  const Vector2d toSensor = T_submap_sensor.translation().head<2>() - hinge;
  Vector2d normal(-along.y(), along.x());
  const bool isLeft = normal.dot(toSensor) < 0.0;  // seen along this normal, the hinge is
  if (!isLeft) normal = -normal;

  DoorSighting sighting;
  const Vector2d middle = 0.5 * (hinge + jamb) + std::clamp(door.axisBehind, 0.0, kDeepest) * normal;
  sighting.T_submap_door = geometry::toPose3({middle.x(), middle.y(), std::atan2(normal.y(), normal.x())});
  sighting.range = (middle - T_submap_sensor.translation().head<2>()).norm();
  sighting.evidence = door.evidence;
  sighting.door.width = door.width();
  sighting.door.hasLeaf = true;
  sighting.door.state = door.angle < kOpenFrom ? map::DoorState::kAjar : map::DoorState::kOpen;
  sighting.door.hingeSide = isLeft ? map::HingeSide::kLeft : map::HingeSide::kRight;
  sighting.hingeEvidence = isLeft ? kHingeEvidence : -kHingeEvidence;
  sighting.openAngle = door.angle;
  sighting.widthSigma = door.sigma;
  Eigen::Matrix2d axes;
  axes << normal, along;
  const Vector2d variances(kAcrossSigma * kAcrossSigma, 0.5 * door.sigma * door.sigma);
  sighting.covariance.topLeftCorner<2, 2>() = axes * variances.asDiagonal() * axes.transpose();
  sighting.covariance(2, 2) = kFloorSigma * kFloorSigma;
  sighting.covariance(3, 3) = kYawSigma * kYawSigma;
  return sighting;
}

}  // namespace

std::vector<DoorSighting> findOpenDoors(const sensors::LaserScan& scan, const geometry::Pose3& T_submap_body,
                                        double floor_z, base::Time time, const OpenDoorDetectorConfig& config) {
  std::vector<DoorSighting> found;
  if (!config.enabled || !config.fromLaser) return found;
  if (!geometry::isFinite(T_submap_body) || !geometry::isFinite(scan.T_body_sensor) || !isLevel(scan.T_body_sensor)) {
    return found;
  }
  for (const auto& door : open_doors::doorsIn(beamsOf(scan), config.leastWidth)) {
    auto& sighting = found.emplace_back(sightingOf(door, T_submap_body * scan.T_body_sensor));
    sighting.T_submap_door.translation().z() = floor_z;
    sighting.time = time;
  }
  return found;
}

}  // namespace prodomos::perception

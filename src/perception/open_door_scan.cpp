// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/open_door_scan.hpp"

#include "prodomos/perception/open_door_detector.hpp"

#include "perception/numeric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

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
constexpr double kDeeper = 0.2;   // and of what is seen of the leaf
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

std::vector<LeafLine> leavesOf(const std::vector<ScanBeam>& beams, const std::vector<ScanSegment>& segments,
                               double leastWidth) {
  std::vector<LeafLine> leaves;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const auto& segment = segments[i];
    if (segment.length() < (1.0 - kHidden) * leastWidth || segment.length() > kWidestLeaf + kMostAxis) continue;
    if (endsFreely(beams, segment, true)) leaves.push_back({segment.last, segment.first, i});
    if (endsFreely(beams, segment, false)) leaves.push_back({segment.first, segment.last, i});
  }
  return leaves;
}

/// A leaf in a wall's frame, to be closed along the wall's line: onward or back (1, -1).
struct LeafInWall {
  Vector2d root;
  Vector2d tip;
  Vector2d along;
  double closing = 1.0;

  /// From closed, radians.
  double angle() const { return std::acos(std::clamp(closing * along.x(), -1.0, 1.0)); }
  /// Of its line, metres.
  double distanceTo(const Vector2d& point) const {
    const Vector2d offset = point - root;
    return std::abs(along.x() * offset.y() - along.y() * offset.x());
  }
};

/// Between the jamb that the leaf hangs at and the other one, along the wall's line.
struct Gap {
  double hinge = 0.0;
  double jamb = 0.0;
  double closing = 1.0;
  bool hingeIsSeen = false;

  double width() const { return closing * (jamb - hinge); }
};

/// Where the leaf would close to, if it turned about its root along the wall.
std::optional<Gap> gapBeside(const WallLine& wall, const LeafInWall& leaf, double leastWidth) {
  constexpr double kOffJamb = 0.15;  // metres between what begins at a jamb and that jamb
  constexpr double kOffFace = 0.1;   // metres along the wall between a leaf's root and where it meets the wall's face
  Gap gap{.closing = leaf.closing};
  const auto seen = wall.edgeBetween(leaf.root.x() + leaf.closing * kOffJamb, leaf.root.x() - leaf.closing * kOffJamb);
  gap.hingeIsSeen = seen.has_value();
  // Where its jamb is hidden, the leaf begins where its line meets the face of the wall.
  const bool isSteep = std::abs(leaf.along.y()) > 0.3;
  const double meeting = isSteep ? leaf.root.x() - leaf.along.x() * leaf.root.y() / leaf.along.y() : leaf.root.x();
  gap.hinge = seen.value_or(std::clamp(meeting, leaf.root.x() - kOffFace, leaf.root.x() + kOffFace));
  const double reach = std::hypot(leaf.tip.x() - gap.hinge, leaf.tip.y());  // more than the leaf, if it hangs deep
  const double least = std::max(leastWidth, reach - kMostAxis) - kOffJamb;
  const auto jamb = wall.edgeBetween(gap.hinge + gap.closing * least, gap.hinge + gap.closing * (reach + kOffJamb));
  if (!jamb) return std::nullopt;
  gap.jamb = *jamb;
  if (gap.width() < leastWidth || gap.width() > kWidestLeaf) return std::nullopt;
  return gap;
}

/// Behind the wall's face, of a leaf that is as long as the gap is wide and begins at its jamb.
std::optional<double> axisOf(const LeafInWall& leaf, const Gap& gap) {
  constexpr double kLonger = 0.03;  // metres that a leaf may be longer
  constexpr double kOff = 0.05;     // metres between the leaf's line and its axis, or between length and width
  const double length = gap.closing * (leaf.tip.x() - gap.hinge);  // along the wall
  if (length > gap.width() + kLonger) return std::nullopt;
  const double swing = leaf.tip.y() > leaf.root.y() ? 1.0 : -1.0;
  const double byLength = leaf.tip.y() - swing * std::sqrt(std::max(0.0, square(gap.width()) - square(length)));
  const double offLine = leaf.distanceTo({gap.hinge, byLength});
  const double byLine = leaf.tip.y() - (leaf.tip.x() - gap.hinge) * leaf.along.y() / leaf.along.x();
  const double offLength = std::abs(std::hypot(length, leaf.tip.y() - byLine) - gap.width());
  const double axis = offLength < offLine ? byLine : byLength;
  if (std::min(offLine, offLength) > kOff || axis < kLeastAxis || axis > kMostAxis) return std::nullopt;
  if ((leaf.root - Vector2d(gap.hinge, axis)).norm() > kHidden * gap.width()) return std::nullopt;
  return axis;
}

bool isOpen(const WallLine& wall, const Gap& gap) {
  constexpr double kMargin = 0.1;  // metres beside jambs
  constexpr double kMostFilled = 0.1;
  constexpr double kLeastThrough = 0.2;
  const double from = gap.hinge + gap.closing * kMargin;
  const double to = gap.jamb - gap.closing * kMargin;
  return wall.share(Meets::kWall, from, to) <= kMostFilled && wall.share(Meets::kThrough, from, to) >= kLeastThrough;
}

std::optional<ScannedDoor> doorOf(const WallLine& wall, const LeafInWall& leaf, double leastWidth) {
  if (leaf.angle() < kLeastAngle || leaf.angle() > kMostAngle) return std::nullopt;
  const auto gap = gapBeside(wall, leaf, leastWidth);
  if (!gap) return std::nullopt;
  const auto axis = axisOf(leaf, *gap);
  if (!axis || !isOpen(wall, *gap)) return std::nullopt;
  constexpr double kJambSigma = 0.02;  // metres
  ScannedDoor door;
  door.hinge = wall.inSensor({gap->hinge, 0.0});
  door.jamb = wall.inSensor({gap->jamb, 0.0});
  door.axisBehind = *axis;
  door.angle = leaf.angle();
  door.sigma = kJambSigma + 0.5 * std::max(wall.spacingAt(gap->hinge), wall.spacingAt(gap->jamb));
  door.evidence = gap->hingeIsSeen ? kBothJambs : kOneJamb;
  return door;
}

/// With whichever side of the leaf the gap lies on.
std::optional<ScannedDoor> doorOf(const WallLine& wall, const LeafLine& leaf, double leastWidth) {
  const Vector2d root = wall.inWall(leaf.root);
  const Vector2d tip = wall.inWall(leaf.tip);
  if (root.y() < kLeastAxis) return std::nullopt;
  for (const double closing : {1.0, -1.0}) {
    auto door = doorOf(wall, LeafInWall{root, tip, (tip - root).normalized(), closing}, leastWidth);
    if (door) return door;
  }
  return std::nullopt;
}

}  // namespace

std::vector<ScannedDoor> doorsIn(const std::vector<ScanBeam>& beams, double leastWidth) {
  constexpr double kNear = 1.5;  // metres from a leaf's root to its wall
  const auto segments = segmentsOf(beams);
  const auto isWallOf = [](const ScanSegment& wall, const LeafLine& leaf) {
    const double apart = std::min((wall.first - leaf.root).norm(), (wall.last - leaf.root).norm());
    return wall.length() >= kLeastWall && apart <= kNear && std::abs(wall.offset(leaf.root)) <= kMostAxis + kDeeper;
  };
  std::vector<ScannedDoor> found;
  for (const auto& leaf : leavesOf(beams, segments, leastWidth)) {
    std::optional<ScannedDoor> best;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      if (i == leaf.segment || !isWallOf(segments[i], leaf)) continue;
      const auto door = doorOf(WallLine(beams, segments[i]), leaf, leastWidth);
      if (door && (!best || door->evidence > best->evidence)) best = door;
    }
    if (best) found.push_back(*best);
  }
  return found;
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

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/door_detector.hpp"

#include "perception/door_candidates.hpp"
#include "perception/door_handle.hpp"
#include "perception/door_picture.hpp"
#include "perception/door_points.hpp"
#include "perception/door_segments.hpp"
#include "perception/door_verdict.hpp"
#include "perception/rectified_wall.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

namespace prodomos::perception {

using Eigen::Vector3d;

namespace {

constexpr std::size_t kMostWalls = 4;  // a view; the greatest
// Metres, beyond what geometry tells: of a jamb along the wall, for another edge of its frame may be taken for it, and
// of the leaf's plane.
constexpr double kJambSigma = 0.025;
constexpr double kPlaneSigma = 0.015;

bool isUsable(const RgbdView& view, const Surfaces& surfaces) {
  const auto& color = view.frame.color;
  const auto& camera = surfaces.depth.camera();
  return !color.empty() && !surfaces.patches.empty() && color.width() == camera.width() &&
         color.height() == camera.height() && geometry::isFinite(view.T_submap_camera);
}

/// A door as the wall's image and depth give it, with how well they do.
DoorSighting sightingOf(const RgbdView& view, const RectifiedWall& wall, const DoorCandidate& candidate,
                        double evidence) {
  const Handle& handle = candidate.handle;
  DoorSighting sighting;
  sighting.time = view.time;
  const double x = 0.5 * (candidate.left_x + candidate.right_x);
  // The door's axes: x away from the observer, y to the left, z up.
  const geometry::Pose3& T_submap_wall = wall.wall().T_submap_wall;
  const Vector3d along = T_submap_wall.linear().col(0);
  sighting.T_submap_door.linear() << Vector3d::UnitZ().cross(along), -along, Vector3d::UnitZ();
  sighting.T_submap_door.translation() = T_submap_wall * Vector3d(x, candidate.leaf_y, 0.0);
  sighting.door.width = candidate.width();
  sighting.door.height = candidate.top_z;
  sighting.door.state = map::DoorState::kClosed;
  sighting.range = wall.rangeAt(x);
  sighting.evidence = evidence;
  const bool isHidden = candidate.cue(Cue::kHidden) > 0.0;
  sighting.whole = candidate.cue(Cue::kCut) < 0.2 && !isHidden;
  const double sight = std::tan(wall.obliquenessAt(x));
  const double pixel = 1.5 * sighting.range / (500.0 * std::max(0.2, std::cos(wall.obliquenessAt(x))));
  // Of a side that something hides, the jamb may be anywhere beyond.
  const double unseen = isHidden ? 0.2 : 0.0;
  const double alongSigma = std::hypot(std::hypot(kJambSigma, pixel, 0.7 * candidate.leafSigma * sight), unseen);
  sighting.widthSigma = std::hypot(std::hypot(1.4 * kJambSigma, pixel, candidate.leafSigma * sight), unseen);
  const double acrossSigma = std::hypot(kPlaneSigma, candidate.leafSigma);
  const double yawSigma = std::hypot(0.01, 0.5 * sensors::depthSigma(sighting.range));
  Eigen::Matrix2d inDoor = Eigen::Matrix2d::Zero();
  inDoor.diagonal() << acrossSigma * acrossSigma, alongSigma * alongSigma;
  const Eigen::Matrix2d turn = sighting.T_submap_door.linear().topLeftCorner<2, 2>();
  sighting.covariance.topLeftCorner<2, 2>() = turn * inDoor * turn.transpose();
  sighting.covariance(2, 2) = 0.02 * 0.02;
  sighting.covariance(3, 3) = yawSigma * yawSigma;
  if (candidate.leaves == 1 && handle.left > 0.0 && handle.right > 0.0) {
    sighting.hingeEvidence = hingeEvidenceOf(handle);
    sighting.door.hingeSide = sighting.hingeEvidence > 0.0 ? map::HingeSide::kLeft : map::HingeSide::kRight;
  }
  return sighting;
}

/// Whether two pairs stand for the same door, of which one may have the frame's edges for the leaf's.
bool isRival(const DoorCandidate& a, const DoorCandidate& b) {
  constexpr double kFrame = 0.14;  // metres, of a frame and what blur adds
  return a.leaves == b.leaves && std::abs(a.left_x - b.left_x) < kFrame && std::abs(a.right_x - b.right_x) < kFrame;
}

/// Of pairs that overlap, those that most likely are a door; of its rivals the one that fits its jambs best.
void keepStrongest(std::vector<Judged>& pairs) {
  constexpr double kClear = 3.0;      // log-odds by which rivals may be less likely
  constexpr double kTwoLeaves = 2.0;  // log-odds; each leaf of a double door looks like a door
  constexpr double kOverlap = 0.1;    // metres
  const auto rank = [](const Judged& pair) { return pair.evidence + kTwoLeaves * (pair.candidate.leaves - 1); };
  std::ranges::stable_sort(pairs, std::greater{}, rank);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!pairs[i].accepted) continue;
    const double evidence = pairs[i].evidence;
    std::size_t best = i;
    for (std::size_t j = i + 1; j < pairs.size(); ++j) {
      const bool isInReach = pairs[j].accepted && pairs[j].evidence > evidence - kClear;
      if (!isInReach || !isRival(pairs[i].candidate, pairs[j].candidate)) continue;
      if (fitOf(pairs[j].candidate) > fitOf(pairs[best].candidate)) best = j;
    }
    std::swap(pairs[i], pairs[best]);
    pairs[i].evidence = evidence;
    const DoorCandidate& chosen = pairs[i].candidate;
    for (std::size_t j = i + 1; j < pairs.size(); ++j) {
      const DoorCandidate& other = pairs[j].candidate;
      const double common = std::min(chosen.right_x, other.right_x) - std::max(chosen.left_x, other.left_x);
      if (!pairs[j].accepted || common < kOverlap) continue;
      pairs[j].accepted = false;
      pairs[j].word = "less likely";
    }
  }
}

/// The same door may be found in two walls where a patch was split.
void dropDoubles(std::vector<DoorSighting>& sightings) {
  std::ranges::stable_sort(sightings, std::greater{}, &DoorSighting::evidence);
  std::vector<DoorSighting> kept;
  for (const auto& sighting : sightings) {
    const bool isKnown = std::ranges::any_of(kept, [&](const DoorSighting& other) {
      const Vector3d between = other.T_submap_door.inverse() * sighting.T_submap_door.translation();
      return between.head<2>().norm() < 0.45 * (sighting.door.width + other.door.width);
    });
    if (!isKnown) kept.push_back(sighting);
  }
  sightings = std::move(kept);
}

std::vector<Judged> judgeByPoints(const RectifiedWall& wall, const std::vector<cv::Point2f>& points) {
  std::vector<Judged> pairs;
  for (auto& candidate : pairPoints(wall, groupsOf(wall, points))) {
    candidate.handle = countPoints(wall, candidate, points);
    pairs.push_back({candidate, 0.0, true, {}});
  }
  return pairs;
}

std::vector<Judged> judgeByLines(const RectifiedWall& wall, const WallEdges& edges,
                                 const std::vector<UprightLine>& lines, double leastEvidence) {
  std::vector<Judged> pairs;
  for (const auto& candidate : pairLines(wall, edges, lines)) {
    const double evidence = evidenceOf(candidate);
    const bool accepted = evidence > leastEvidence;
    pairs.push_back({candidate, evidence, accepted, accepted ? "" : std::string(weakestPoint(candidate))});
  }
  keepStrongest(pairs);
  return pairs;
}

}  // namespace

void describe(base::ConfigVisitor& visitor, DoorDetectorConfig& config) {
  static constexpr std::array<std::string_view, 2> kMethods{"paper", "segments"};
  visitor.section("doors", "closed doors in RGB-D images");
  visitor.key("enabled", config.enabled, "look for closed doors");
  visitor.choice("method", config.method, kMethods,
                 "pairs of salient points as in paper 002, or lines as jambs and what speaks for a leaf");
  visitor.key("reach", config.reach, "m", {1.0, 15.0}, "walls are looked at up to this range");
  visitor.key("edge_contrast", config.edgeContrast, "", {2.0, 100.0}, "of a jamb, in the channel that differs most");
  visitor.key("tilt", config.tilt, "rad", {0.005, 0.3}, "that a jamb may deviate from the vertical");
  visitor.key("least_evidence", config.leastEvidence, "log-odds", {-20.0, 20.0}, "from which on a door is reported");
  visitor.endSection();
}

std::vector<DoorSighting> findDoors(const RgbdView& view, const Surfaces& surfaces, const DoorDetectorConfig& config,
                                    DebugImages* debug) {
  std::vector<DoorSighting> sightings;
  if (!config.enabled || !isUsable(view, surfaces)) return sightings;
  const bool byPoints = config.method == static_cast<int>(DoorMethod::kPaper);
  const bool draws = debug != nullptr && debug->isWanted();
  auto walls = findWalls(view, surfaces);
  walls.resize(std::min(walls.size(), kMostWalls), Wall{});
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const RectifiedWall wall(view, surfaces, walls[i], config.reach);
    if (wall.empty()) continue;
    const auto points = byPoints || draws ? salientPoints(wall) : std::vector<cv::Point2f>{};
    std::vector<UprightLine> lines;
    std::vector<Judged> pairs;
    if (byPoints) {
      pairs = judgeByPoints(wall, points);
    } else {
      const WallEdges edges(wall, config.edgeContrast);
      lines = edges.uprightLines(config.tilt);
      pairs = judgeByLines(wall, edges, lines, config.leastEvidence);
    }
    for (const auto& judged : pairs) {
      if (judged.accepted) sightings.push_back(sightingOf(view, wall, judged.candidate, judged.evidence));
    }
    if (draws) debug->add("doors_wall_" + std::to_string(i), drawVerdict(wall, points, lines, pairs));
  }
  dropDoubles(sightings);
  return sightings;
}

}  // namespace prodomos::perception

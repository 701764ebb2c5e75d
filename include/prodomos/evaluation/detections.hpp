// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/claims.hpp"
#include "prodomos/evaluation/statistics.hpp"
#include "prodomos/evaluation/truth.hpp"

#include <optional>
#include <vector>

/// Doors, doorways and stairs of a map against the true ones. docs/evaluation.md defines every measure.
namespace prodomos::evaluation {

struct MatchGates {
  double doorDistance = 0.5;    ///< metres between middles, seen from above
  double stairsDistance = 1.0;  ///< metres between middles of flights or between feet: a flight is some metres long
  double angle = 0.523598776;   ///< 30°, of a door's normal either way, of a flight uphill
};

enum class Verdict { kRight, kWrong, kNeither };

/// What became of a claim.
struct ClaimMatch {
  Verdict verdict = Verdict::kWrong;
  /// The true thing of that kind that is there, whether or not the claim names it rightly; none: there is none.
  std::optional<std::size_t> truth;
};

/// Of each claimed door, one to one within kinds for the least sum of distances: doors with leaves with doors,
/// open doorways with doorways. What is left over is wrong, but neither right nor wrong where a doorway is claimed in a
/// door that stood open while it was seen, and at a lift's doors.
std::vector<ClaimMatch> matchDoors(const std::vector<ClaimedDoor>& claims, const Truth& truth,
                                   const MatchGates& gates = {});
std::vector<ClaimMatch> matchStairs(const std::vector<ClaimedStaircase>& claims, const Truth& truth,
                                    const MatchGates& gates = {});

bool isLiftDoor(const Truth& truth, const TrueDoor& door);
/// In the plane: the middle of the opening, and that of the closed leaf in it.
geometry::Pose2 poseOf(const TrueDoor& door);
geometry::Pose2 leafPoseOf(const TrueDoor& door);
/// Before the first change of state as at it; closed where none is known.
map::DoorState stateAt(const TrueDoor& door, base::Time time);

struct FoundCount {
  std::size_t truth = 0;
  std::size_t found = 0;

  std::optional<double> recall() const { return shareOf(found, truth); }
  FoundCount& operator+=(const FoundCount& other);
};

struct DetectionCounts {
  FoundCount all;
  FoundCount visible;
  FoundCount passed;
  std::optional<FoundCount> images;  ///< of true things and images that show them whole; none: the map does not tell
  std::size_t right = 0;             ///< claims
  std::size_t wrong = 0;

  std::optional<double> precision() const { return shareOf(right, right + wrong); }
  DetectionCounts& operator+=(const DetectionCounts& other);
};

/// Of claims that are right. Lists are in no order that means anything.
struct DoorScore {
  DetectionCounts counts;
  std::vector<double> centre;  ///< metres, seen from above
  std::vector<double> normal;  ///< radians
  std::vector<double> width;   ///< metres
  std::vector<double> height;  ///< metres; of those that tell one
  FoundCount hingeSides;       ///< told rightly, of doors with one leaf
  FoundCount states;           ///< right when last seen

  DoorScore& operator+=(const DoorScore& other);
};

struct StairsScore {
  DetectionCounts counts;
  std::vector<double> foot;       ///< metres, seen from above; of those that tell one
  std::vector<double> direction;  ///< radians
  std::vector<double> width;      ///< metres
  std::vector<double> height;     ///< metres, of the new floor

  StairsScore& operator+=(const StairsScore& other);
};

/// `withLeaves`: of doors, else of doorways. `matches` are those of claims.doors.
DoorScore scoreDoors(const Claims& claims, const std::vector<ClaimMatch>& matches, const Truth& truth, bool withLeaves);
StairsScore scoreStairs(const Claims& claims, const std::vector<ClaimMatch>& matches, const Truth& truth);

}  // namespace prodomos::evaluation

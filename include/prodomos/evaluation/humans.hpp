// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/statistics.hpp"
#include "prodomos/evaluation/truth.hpp"
#include "prodomos/map/map_view.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

/// Persons that the map followed against those who were there, after Bernardin and Stiefelhagen 2008, "Evaluating
/// multiple object tracking performance: the CLEAR MOT metrics". docs/evaluation.md defines every measure.
namespace prodomos::evaluation {

struct MappedPersonState {
  base::Time time{};
  geometry::Pose3 T_world_person = geometry::Pose3::Identity();  ///< x-axis: where the torso points
  bool hasHeading = true;
  std::array<std::optional<Eigen::Vector3d>, kJointCount> joints_in_world{};
};

struct MappedPerson {
  std::int64_t id = 0;
  std::vector<MappedPersonState> states;  ///< ascending in time
};

/// The tracks of class "human"; and where the map has none, each human entity with the one state it was last seen in.
std::vector<MappedPerson> peopleOf(const map::MapView& view, const Truth& truth);

struct HumanOptions {
  int leastPixels = 1000;  ///< of a person that the camera must have seen; with fewer it counts neither way
  double range = 5.0;      ///< metres from the robot; farther ones count neither way
  double reach = 0.5;      ///< metres between a person and the map's idea of it
};

struct HumanScore {
  std::size_t frames = 0;          ///< camera frames that were looked at
  std::size_t seen = 0;            ///< persons over frames who should have been found
  std::size_t matches = 0;         ///< of them found
  std::size_t falsePositives = 0;  ///< persons over frames where there was none
  std::size_t identitySwitches = 0;
  std::vector<double> positionErrors;  ///< of matches: metres in the plane
  std::vector<double> headingErrors;   ///< radians, 0 … π
  std::vector<double> jointErrors;     ///< of joints of matches: metres

  std::size_t falseNegatives() const { return seen - matches; }
  std::optional<double> recall() const { return shareOf(matches, seen); }
  std::optional<double> precision() const { return shareOf(matches, matches + falsePositives); }
  /// 1 - (false negatives + false positives + switches) / seen: below 0 where there are more of them than persons.
  std::optional<double> mota() const;
  /// Mean of the position errors, metres.
  std::optional<double> motp() const;
  /// For scores over several maps.
  HumanScore& operator+=(const HumanScore& other);
};

HumanScore scoreHumans(const std::vector<MappedPerson>& mapped, const Truth& truth, const HumanOptions& options = {});

}  // namespace prodomos::evaluation

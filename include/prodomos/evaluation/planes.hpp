// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/statistics.hpp"
#include "prodomos/evaluation/truth.hpp"
#include "prodomos/map/map_view.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

/// Plane patches of the map against the true planes, after Hoover et al. 1996, "An experimental comparison of range
/// image segmentation algorithms" (SegComp), with areas in place of pixels. docs/evaluation.md defines every measure.
namespace prodomos::evaluation {

struct MappedPlane {
  geometry::Pose3 T_world_patch = geometry::Pose3::Identity();  ///< z-axis: normal, towards the side it was seen from
  std::vector<Eigen::Vector2d> outline_in_patch;
};

/// All patches with an outline, brought into the world with their sub-maps.
std::vector<MappedPlane> planesOf(const map::MapView& view, const Truth& truth);

struct PlaneOptions {
  double leastSeen = 0.5;     ///< m² of a true plane that must have been seen
  double widestAngle = 0.35;  ///< radians between normals of what may be the same plane
  double farthest = 0.15;     ///< metres from the true plane to the patch's middle
  std::vector<double> thresholds = {0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95};
  double reported = 0.8;  ///< of the thresholds, the one whose pairs give the errors
};

/// At one threshold of overlap. Every true plane and every patch is in one of them at most.
struct PlaneCounts {
  double threshold = 0.8;
  std::size_t correct = 0;  ///< pairs
  std::size_t over = 0;     ///< true planes that several patches make up
  std::size_t under = 0;    ///< patches that hold several true planes
  std::size_t missed = 0;   ///< true planes in none of these
  std::size_t noise = 0;    ///< patches in none of these
};

struct PlaneScore {
  std::size_t truth = 0;   ///< planes seen well enough
  std::size_t mapped = 0;  ///< patches, but for those on planes barely seen
  std::vector<PlaneCounts> curve;
  std::vector<double> angleErrors;   ///< of the correct pairs at PlaneOptions::reported, radians
  std::vector<double> offsetErrors;  ///< metres along the true normal

  /// Null where the curve does not have it.
  const PlaneCounts* at(double threshold) const;
  /// For scores over several maps of the same options.
  PlaneScore& operator+=(const PlaneScore& other);
};

PlaneScore scorePlanes(const std::vector<MappedPlane>& mapped, const Truth& truth, const PlaneOptions& options = {});

}  // namespace prodomos::evaluation

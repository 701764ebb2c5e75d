// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/time.hpp"
#include "prodomos/evaluation/truth.hpp"
#include "prodomos/simulation/building.hpp"
#include "prodomos/simulation/renderer.hpp"

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace prodomos::simulation {

/// What can be known of the building itself, before anybody has seen any of it. `seed`: of the shell and its looks.
evaluation::Truth truthOf(const Building& building, base::Time begin, std::uint64_t seed);

/// Goes with the robot and keeps account of what its camera has come to see (docs/truth.md says what counts as seen).
class Witness {
 public:
  static constexpr std::size_t kStepParts = 4;  ///< riser, tread, left and right end

  Witness(const Building& building, const CameraModel& camera, evaluation::Truth& truth);

  /// The robot stands there: rooms are entered, doors and stairs passed.
  void walk(base::Time time, const geometry::Pose3& T_world_body);
  /// The camera sees that; `seconds` since the log began.
  void look(base::Time time, double seconds, const geometry::Pose3& T_world_camera, const Rendering& rendering);

 private:
  struct View;  // one image and where it was taken
  struct SampledPlane {
    std::vector<Eigen::Vector3d> points;
    std::vector<bool> isSeen;
    Eigen::AlignedBox3d box;
  };
  using StepIsSeen = std::array<std::vector<bool>, kStepParts>;  ///< by spot of each part

  static SampledPlane samplesOf(const evaluation::TruePlane& plane);
  void lookAtDoor(std::size_t index, base::Time time, double seconds, const View& view);
  void lookAtFlight(std::size_t index, base::Time time, const View& view);
  void lookAtPlanes(const View& view);
  void countPixels(base::Time time, double seconds, const View& view);

  const Building& building_;
  CameraModel camera_;
  evaluation::Truth& truth_;
  sensors::Image<float> pixelArea_;                  ///< m², at one metre and seen straight on
  std::size_t instanceCount_;                        ///< with 0, which is none
  std::vector<std::vector<bool>> leafIsSeen_;        ///< by door, and spot of its leaves or opening
  std::vector<std::vector<StepIsSeen>> stepIsSeen_;  ///< by flight and step
  std::vector<SampledPlane> planes_;                 ///< as many as the truth has
};

}  // namespace prodomos::simulation

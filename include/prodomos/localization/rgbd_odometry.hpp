// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/bytes.hpp"
#include "prodomos/base/config.hpp"
#include "prodomos/map/topological_graph.hpp"
#include "prodomos/sensors/reading.hpp"

#include <memory>
#include <optional>

namespace prodomos::localization {

struct RgbdOdometryConfig {
  int keyPoints = 800;         ///< looked for in each image
  double maxDepth = 8.0;       ///< metres
  int keyFrames = 40;          ///< kept to be recognised again
  int references = 4;          ///< key frames that a frame is aligned with at once
  double assumedHeight = 1.2;  ///< metres of the camera over a floor that was not seen yet
  int levelFrames = 150;       ///< a floor first seen after so many frames no longer levels the world
  std::uint64_t seed = 1;
};

void describe(base::ConfigVisitor& visitor, RgbdOdometryConfig& config);

/// Poses of an RGB-D camera from its images alone, 6 degrees of freedom, each frame aligned with the best earlier key
/// frames by key points and by surfaces (docs/rgbd.md). The world: z up against gravity as the floor shows it, z = 0 on
/// the floor, origin below the first camera, x where the body first headed. Needs no colour where there is structure,
/// and little structure where there is texture. Memory is bounded.
class RgbdOdometry {
 public:
  explicit RgbdOdometry(const RgbdOdometryConfig& config = {});
  ~RgbdOdometry();
  RgbdOdometry(RgbdOdometry&&) noexcept;
  RgbdOdometry& operator=(RgbdOdometry&&) noexcept;

  struct Estimate {
    geometry::Pose3 T_world_body = geometry::Pose3::Identity();
    /// Of the step since the last estimate, in the body's own axes: m, rad. Large along what the images do not show.
    map::Matrix6 covariance = map::Matrix6::Zero();
    /// The images do not tell the pose: it is what was to be expected.
    bool isLost = false;
    /// A floor was seen. If not yet, the first camera was assumed level, at the assumed height.
    bool isLevelled = false;
    /// Set in the one estimate in which the floor showed that the world before was not level, or at the wrong height:
    /// earlier poses of this run are T_world_before * T_before_body in the world from here on.
    std::optional<geometry::Pose3> T_world_before;
  };

  /// Frames in the order of their time. `movers`: pixels not to be used, as many as the frame's, may be null.
  /// `T_last_body`: the body's motion since the last frame, by wheel odometry, where there is any. A frame that is of
  /// no use (empty, unequal images, nothing known) gives an estimate that isLost.
  Estimate track(base::Time time, const sensors::RgbdFrame& frame, const sensors::Mask* movers = nullptr,
                 const std::optional<geometry::Pose3>& T_last_body = std::nullopt);

  /// Bit by bit: after load() a run goes on exactly as the one that was saved.
  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace prodomos::localization

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/geometry/pose.hpp"
#include "prodomos/simulation/camera_model.hpp"
#include "prodomos/simulation/renderer.hpp"

namespace prodomos::simulation {

/// How a small colour camera errs, in levels of 255.
struct ColorNoise {
  double brightnessSigma = 1.8;  ///< of a pixel's three channels together
  double channelSigma = 1.0;     ///< of each for itself
};

/// Draws one number from `random`, so that pictures do not depend on the number of threads (0: as many as the machine
/// has).
sensors::Image<sensors::Rgb> noisyColor(const sensors::Image<sensors::Rgb>& color, const ColorNoise& noise,
                                        base::Random& random, int threads = 0);

/// Colour smeared by what the camera moved while the shutter was open: from `T_end_begin`, its pose at the beginning in
/// the axes of that at the end, which the rendering is of. What moves by itself is not smeared.
sensors::Image<sensors::Rgb> motionBlurred(const Rendering& rendering, const CameraModel& camera,
                                           const geometry::Pose3& T_end_begin, int threads = 0);

}  // namespace prodomos::simulation

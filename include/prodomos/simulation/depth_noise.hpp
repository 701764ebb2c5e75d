// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/simulation/camera_model.hpp"
#include "prodomos/simulation/renderer.hpp"

#include <cstdint>

namespace prodomos::simulation {

/// How a depth camera that projects speckles errs: an Xtion or a Kinect of the first kind. It measures disparities
/// between its camera and its projector, in steps of an eighth of a pixel; all errors are of disparities, so that those
/// of depth grow with the square of the range (Khoshelham & Elberink 2012). docs/sensor-models.md says where the
/// defaults come from.
struct DepthNoise {
  double leastRange = 0.5;       ///< metres; nothing is measured nearer
  double mostRange = 5.0;        ///< metres; nor farther
  double focalLength = 570.3;    ///< of the infrared camera, pixels
  double baseline = 0.075;       ///< from the camera to the projector on its right, metres
  double stepsPerPixel = 8.0;    ///< of disparity
  double stepOffset = -0.33;     ///< of the steps from whole disparities: a step n is a disparity of n + this
  double disparitySigma = 0.38;  ///< of one measurement, steps
  int window = 7;                ///< pixels that share their error: those of the correlation window
  double lateralSigma = 0.8;     ///< of where a pixel looks, pixels (Nguyen et al. 2012)
  double warp = 0.30;            ///< rms of the device's own distortion over a picture, steps
  std::uint64_t device = 1;      ///< seed of that distortion: one device has the same one in all pictures
  double leastSignal = 0.004;    ///< light that must come back: 1 from white paper, straight on, at one metre
  double mostSignal = 6.0;       ///< above it the projector glares
  double leastCosine = 0.10;     ///< of the angle of incidence: flatter surfaces give no depth
};

/// What such a camera measures, metres along z, in millimetres; 0: not known. Draws one number from `random`, so that
/// pictures do not depend on the number of threads (0: as many as the machine has).
sensors::Image<float> noisyDepth(const Rendering& rendering, const CameraModel& camera, const DepthNoise& noise,
                                 base::Random& random, int threads = 0);

}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/sensors/reading.hpp"

namespace prodomos::simulation {

/// How a segmentation errs.
struct LabelDegradation {
  double boundaryNoise = 3.0;  ///< standard deviation of how far outlines are off, pixels
  double flips = 0.03;         ///< share of the image in patches of a wrong class
  double missed = 0.05;        ///< probability that a thing is not told from what is around it, a frame
  double falseThings = 0.1;    ///< things a frame that are not there
};

/// Of true labels those of a segmentation: outlines wander smoothly, patches are of another class that the image has,
/// things are missed (they take the class to the left of them) or invented. Instances follow; of an invented thing it
/// is 0. Without any degradation the labels come back unchanged.
sensors::LabelImage degraded(const sensors::LabelImage& labels, const LabelDegradation& degradation,
                             base::Random& random);

}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/reading.hpp"

#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose2D.h>

namespace prodomos::io {

/// The reading as MRPT holds it. Throws base::Error where MRPT has nothing to hold it in.
mrpt::obs::CObservation::Ptr toMrpt(const sensors::Reading& reading, const sensors::ClassTable& classes);

/// Throws base::Error where the body is not in the plane: MRPT's odometry is.
mrpt::poses::CPose2D planarPose(const sensors::Odometry& odometry);

}  // namespace prodomos::io

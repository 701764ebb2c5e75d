// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/mrpt_readings.hpp"
#include "io/mrpt_values.hpp"
#include "io/scan_ranges.hpp"

#include <mrpt/obs/CObservation2DRangeScan.h>

#include <cmath>

namespace prodomos::io {

Conversion convertScan(const mrpt::obs::CObservation2DRangeScan& observation) {
  sensors::LaserScan scan;
  scan.T_body_sensor = toPose3(observation.sensorPose);
  scan.maxRange = observation.maxRange;
  const std::size_t count = observation.getScanSize();
  if (!geometry::isFinite(scan.T_body_sensor) || !std::isfinite(observation.aperture) || !(scan.maxRange > 0.0)) {
    return NotConverted{"damaged scan", "expected a finite pose, aperture and range, found NaN or infinity"};
  }
  if (count > 1) {
    const double aperture = observation.rightToLeft ? observation.aperture : -observation.aperture;
    scan.firstAngle = -aperture / 2.0;
    scan.angleStep = aperture / static_cast<double>(count - 1);
  }

  RangeCheck check(observation.maxRange);
  scan.ranges.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    scan.ranges.push_back(check(observation.getScanRange(i), observation.getScanRangeValidity(i)));
  }
  return Converted{std::move(scan), check.damage()};
}

}  // namespace prodomos::io

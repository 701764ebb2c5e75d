// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/source.hpp"

#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/obs_frwds.h>

#include <optional>
#include <string>
#include <variant>

/// What MRPT's observations say, as our readings. Each conversion leaves time and sensor label to the caller.
namespace prodomos::io {

/// What an observation turns into: data, and where part of it was damaged, what is wrong ("expected …, found …").
struct Converted {
  sensors::ReadingData data;
  std::string damage{};
};

/// Why an observation gives no reading. `damage` as above: empty where the observation is sound but of no use.
struct NotConverted {
  std::string reason;
  std::string damage{};
};

using Conversion = std::variant<Converted, NotConverted>;

Conversion convertScan(const mrpt::obs::CObservation2DRangeScan& observation);
Conversion convertRangeImage(const mrpt::obs::CObservation3DRangeScan& observation);
Conversion convertStereo(const mrpt::obs::CObservationStereoImages& observation);
Conversion convertVelodyne(const mrpt::obs::CObservationVelodyneScan& observation);
Conversion convertPointCloud(const mrpt::obs::CObservation& observation);

/// Names of the classes in the observation's pixel labels; empty where it has none.
sensors::ClassTable classTable(const mrpt::obs::CObservation& observation);

/// The class's name without its namespaces: "CObservationGPS".
std::string className(const mrpt::rtti::CObject& object);

/// The reading, or why there is none. `place` begins the line of a fault. External images must have been loaded.
sensors::SourceItem toItem(const mrpt::obs::CObservation& observation, base::Time time, const std::string& place);

}  // namespace prodomos::io

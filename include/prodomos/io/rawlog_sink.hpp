// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/source.hpp"

#include <filesystem>
#include <memory>

namespace prodomos::io {

/// The two ways in which MRPT lays out a log.
enum class RawlogFlavour { kObservations, kActionsAndSensoryFrames };

/// Writes a gzip'd MRPT rawlog. In the action flavour each odometry reading becomes the increment since the one before,
/// and the readings up to the next one its sensory frame. `classes` names the classes of label images, whose ids may go
/// up to 64. Depth is kept to the millimetre, up to 65.5 m; points keep their colour or else their intensity; faults
/// are not written. The sink throws base::FileError where the file cannot be written, and base::Error for detections,
/// key points and odometry out of the plane, for which MRPT has no place.
std::unique_ptr<sensors::SensorSink> createRawlog(const std::filesystem::path& path,
                                                  RawlogFlavour flavour = RawlogFlavour::kObservations,
                                                  const sensors::ClassTable& classes = {});

}  // namespace prodomos::io

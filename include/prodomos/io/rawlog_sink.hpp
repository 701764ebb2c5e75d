// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "prodomos/sensors/source.hpp"

namespace prodomos::io {

/// The two ways in which MRPT lays out a log.
enum class RawlogFlavour { kObservations, kActionsAndSensoryFrames };

/// Writes a gzip'd MRPT rawlog. In the action flavour each odometry reading becomes the increment since the one before,
/// and the readings up to the next one its sensory frame. Throws base::FileError where the file cannot be written.
std::unique_ptr<sensors::SensorSink> createRawlog(const std::filesystem::path& path,
                                                  RawlogFlavour flavour = RawlogFlavour::kObservations);

}  // namespace prodomos::io

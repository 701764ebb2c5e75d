// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/progress.hpp"
#include "prodomos/mapper/mapper.hpp"

namespace prodomos::mapper {

/// The source as the configuration wants it: sensors, start and end. Throws base::UsageError on malformed ones.
std::unique_ptr<sensors::SensorSource> selectInput(std::unique_ptr<sensors::SensorSource> source,
                                                   const InputConfig& config);

/// Feeds a log to a mapper, from where an interrupted session left it, and finishes the session. Damage of the log
/// is in the mapper's report.
void replay(sensors::SensorSource& source, Mapper& mapper, const base::ProgressListener& listener = {});

}  // namespace prodomos::mapper

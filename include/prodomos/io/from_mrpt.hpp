// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/source.hpp"

#include <mrpt/obs/CObservation.h>

namespace prodomos::io {

/// A reading from an MRPT observation that a program holds; Skipped where its class is not one of those that prodomos
/// reads, or its content is damaged. The one public header that names MRPT: link `prodomos::mrpt`.
sensors::SourceItem fromMrpt(const ::mrpt::obs::CObservation& observation);

}  // namespace prodomos::io

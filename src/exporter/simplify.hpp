// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exporter/footprint.hpp"

namespace prodomos::exporter {

/// Fewer points of the same line: none of those left out lies further than `tolerance` from it (Douglas and Peucker).
Polyline simplified(const Polyline& line, double tolerance);

}  // namespace prodomos::exporter

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/exporter/html.hpp"

#include "exporter/json.hpp"

namespace prodomos::exporter {

/// Everything that the web page shows; src/exporter/web/data.js takes it from there. Lengths to a millimetre, angles to
/// 1e-4 rad.
Json htmlData(const map::MapView& view, const HtmlOptions& options);

}  // namespace prodomos::exporter

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exporter/footprint.hpp"
#include "exporter/html_images.hpp"
#include "exporter/json.hpp"

namespace prodomos::exporter {

/// To the nearest `unit`; null where not finite.
Json rounded(double value, double unit = 1e-3);
/// [[x, y], …], to a millimetre.
Json pointsJson(const Polyline& points);
/// {"png": base64, "pixel": metres, "corner": [x, y], "size": [x, y]}.
Json imageJson(const PlacedImage& image);

/// What lies below the graph: for each floor the plan and what its layers look like from above.
struct HtmlFloors {
  Json json;
  double freeArea = 0.0;  ///< m², of all floors
};
HtmlFloors htmlFloors(const map::MapView& view);

}  // namespace prodomos::exporter

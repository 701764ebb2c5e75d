// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/query/query.hpp"

namespace prodomos::query {

/// A spot, and the sub-map that knows or predicts it.
struct KnownSpot {
  Position position;
  base::SubMapId submap;
};

/// To each of them, in their order.
std::vector<std::optional<Route>> routesBetween(const map::MapView& view, const KnownSpot& from,
                                                const std::vector<KnownSpot>& to);

}  // namespace prodomos::query

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/map_view.hpp"
#include "prodomos/map/occupancy_grid.hpp"

#include <optional>

namespace prodomos::map {

/// All observed sub-maps' grids of one floor (or of all, where none is given) in the map frame, merged in the order of
/// their ids. Observed cells alone: nothing predicted is in it. Floorless sub-maps count to every floor.
OccupancyGrid fuseGrids(const MapView& view, std::optional<int> floor = std::nullopt);

}  // namespace prodomos::map

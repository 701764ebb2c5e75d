// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/cells.hpp"
#include "prodomos/map/map_view.hpp"
#include "prodomos/map/occupancy_grid.hpp"

#include <optional>

namespace prodomos::exporter {

/// The social level of 002, for each cell of the floor's fused grid that is known: how much of somebody's own space it
/// is, f_h / max f_h where each person was last seen, 0 … 1; of several the greatest. It ends at walls.
geometry::CellMap<float> socialCosts(const map::MapView& view, std::optional<int> floor,
                                     const map::OccupancyGrid& grid);

}  // namespace prodomos::exporter

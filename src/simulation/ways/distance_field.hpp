// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace prodomos::simulation {

/// Distance of each cell of a grid, row by row, to the nearest one that is an obstacle, between their middles, in
/// cells. There is to be one. Exact, in linear time: Felzenszwalb and Huttenlocher, Distance Transforms of Sampled
/// Functions.
std::vector<float> distancesTo(int width, int height, const std::function<bool(std::size_t cell)>& isObstacle);

}  // namespace prodomos::simulation

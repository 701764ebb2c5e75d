// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/config.hpp"

namespace prodomos::map {

void describe(base::ConfigVisitor& visitor, LayersConfig& config) {
  auto& grid = config.grid;
  visitor.section("grid", "occupancy grid of each sub-map");
  visitor.key("resolution", grid.resolution, "m", {0.005, 1.0}, "edge length of a cell");
  visitor.key("max_range", grid.maxRange, "m", {0.5, 500.0}, "beams are used up to here");
  visitor.key("no_return", grid.noReturn, "m", {0.0, 500.0},
              "a beam without a return passes so far; beyond, dark and shiny things swallow too many to trust it");
  visitor.key("hit", grid.hit, "", {0.51, 0.95}, "probability of being occupied that an end point stands for");
  visitor.key("miss", grid.miss, "", {0.10, 0.49}, "probability of being occupied that a passing beam stands for");
  visitor.key("clamp_low", grid.clampLow, "", {0.05, 0.49}, "least probability a cell can take");
  visitor.key("clamp_high", grid.clampHigh, "", {0.51, 0.99}, "greatest probability a cell can take");
  visitor.key("band_least", grid.heightBand.least, "m", {-1.0, 10.0},
              "things of 3D sensors from this height over the floor on are obstacles");
  visitor.key("band_most", grid.heightBand.most, "m", {0.0, 10.0}, "… and up to this height");
  visitor.endSection();

  auto& surface = config.surface;
  visitor.section("surface", "means of end points in cells, which scans and sub-maps are matched with");
  visitor.key("resolution", surface.resolution, "m", {0.01, 1.0}, "edge length of a cell");
  visitor.key("max_range", surface.maxRange, "m", {0.5, 500.0}, "beams are used up to here");
  visitor.endSection();

  auto& points = config.points;
  visitor.section("points", "thinned points of each sub-map");
  visitor.key("voxel", points.voxel, "m", {0.005, 5.0}, "one point is kept in each cube of this edge length");
  visitor.key("max_range", points.maxRange, "m", {0.5, 500.0}, "points are kept up to here");
  visitor.endSection();
}

}  // namespace prodomos::map

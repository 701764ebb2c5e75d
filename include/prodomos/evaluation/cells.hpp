// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/cells.hpp"

/// Shapes are scored as sets of cells.
namespace prodomos::evaluation {

using geometry::boxOf;
using geometry::CellMap;
using geometry::cellsIn;
using geometry::centreOf;
using geometry::kCell;
using geometry::Polygon;

/// Row by row.
template <typename Visit>
void visitCells(const geometry::CellBox& box, const Visit& visit) {
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) visit(geometry::CellIndex{x, y});
  }
}

/// `least` … `most` ahead (x), from `right` (negative) to `left` across (y), in the frame of the door.
Polygon boxBehind(const geometry::Pose2& T_world_door, double left, double right, double least, double most);

}  // namespace prodomos::evaluation

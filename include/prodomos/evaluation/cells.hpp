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

/// `least` … `most` ahead (x), from `right` (negative) to `left` across (y), in the frame of the door.
Polygon boxBehind(const geometry::Pose2& T_world_door, double left, double right, double least, double most);

}  // namespace prodomos::evaluation

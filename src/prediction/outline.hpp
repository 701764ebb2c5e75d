// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pieces.hpp"

#include <vector>

/// Polygons that go round pieces of cells.
namespace prodomos::prediction {

using geometry::CellSet;
using geometry::Piece;
using geometry::piecesOf;
using geometry::takePiece;

/// Without the cells that lie to one side of a hole, so that the way from each hole to the outside is open and one
/// outline tells the rest; of the rest, its greatest piece.
Piece withoutHoles(const Piece& piece);

/// Round the cells of a piece without holes, counter-clockwise; metres.
geometry::Polygon outlineOf(const Piece& piece, double resolution);

}  // namespace prodomos::prediction

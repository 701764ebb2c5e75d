// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/cells.hpp"

#include <cstdint>
#include <vector>

/// Sets of cells, and the polygons that go round them.
namespace prodomos::prediction {

using CellSet = geometry::CellMap<std::uint8_t>;

/// One 4-connected set of cells, row by row.
using Piece = std::vector<geometry::CellIndex>;

/// Takes out of `cells` what hangs together with `start`, by edges and, if wanted, by corners.
Piece takePiece(CellSet& cells, geometry::CellIndex start, bool byCorners = false);

/// The greatest first; of equal ones that which begins nearest to the first corner of the box.
std::vector<Piece> piecesOf(const CellSet& cells);

/// Without the cells that lie to one side of a hole, so that the way from each hole to the outside is open and one
/// outline tells the rest; of the rest, its greatest piece.
Piece withoutHoles(const Piece& piece);

/// Round the cells of a piece without holes, counter-clockwise; metres.
geometry::Polygon outlineOf(const Piece& piece, double resolution);

}  // namespace prodomos::prediction

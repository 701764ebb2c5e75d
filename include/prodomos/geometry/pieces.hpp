// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/cells.hpp"

#include <cstdint>
#include <vector>

/// Sets of cells, and what of them hangs together.
namespace prodomos::geometry {

using CellSet = CellMap<std::uint8_t>;

/// One 4-connected set of cells.
using Piece = std::vector<CellIndex>;

/// Takes out of `cells` what hangs together with `start`, by edges and, if wanted, by corners.
Piece takePiece(CellSet& cells, CellIndex start, bool byCorners = false);

/// Each row by row; the greatest first; of equal ones that which begins nearest to the first corner of the box.
std::vector<Piece> piecesOf(const CellSet& cells);

}  // namespace prodomos::geometry

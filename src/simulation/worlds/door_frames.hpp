// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include "simulation/surface_tools.hpp"

#include <optional>

namespace prodomos::simulation {

/// What a frame's mesh says of its door.
struct FramedOpening {
  geometry::Pose2 pose;  ///< of the middle of the clear opening; x-axis: through it
  double bottom = 0.0;   ///< where its jambs begin
  double width = 0.0;    ///< clear, between the jambs
  double height = 0.0;   ///< clear, below the lintel
  Polygon footprint;     ///< of the whole frame, counter-clockwise
};

/// The opening between two jambs and below a lintel; none where the piece is no such frame. Its wall may stand at any
/// angle.
std::optional<FramedOpening> openingOf(const Surface& frame);

}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simulation/worlds/storey_mesh.hpp"

#include <optional>

namespace prodomos::simulation {

/// An opening in a wall behind which a lift's cabin stands.
struct LiftPortal {
  geometry::Pose2 pose;  ///< of the middle of the opening in the middle of the wall; x-axis: into the cabin
  double width = 0.0;    ///< clear
  double height = 0.0;
  double wallThickness = 0.0;
};

/// The portal at a lift door's model, its wall along the model's x- or y-axis: its jambs and lintel are sought in the
/// walls' meshes, and the cabin lies on the side without floor. None where no opening is found within 1 m.
std::optional<LiftPortal> portalAt(const StoreyMesh& mesh, const geometry::Pose2& door);

/// The cabin's floor, counter-clockwise.
Polygon cabinOf(const LiftPortal& portal);
/// Adds the cabin's walls, floor and ceiling, and the door frame on the outside.
void addCabin(StoreyMesh& mesh, const LiftPortal& portal);

}  // namespace prodomos::simulation

// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/entity.hpp"
#include "prodomos/prediction/surroundings.hpp"

#include <optional>

/// Where a robot stands to go through a door, or up or down the stairs.
namespace prodomos::prediction {

/// T_submap_near: the frame of what is known around the side of an opening that was seen. Of a door that of
/// T_submap_here(); of a staircase its end on the sub-map's floor. The x-axis points the way that one walks. The
/// identity where extrapolate() has something against the entity.
geometry::Pose3 T_submap_near(const map::Entity& entity);

/// Facing the opening, 0.8 m before its middle or as near to that as a robot of that radius (metres) has room on floor
/// that was seen free; in the part of that floor where it has the most room to come from. None where there is no such
/// spot within 2 m. In the frame of T_submap_near(), which `near` is told in.
std::optional<geometry::Pose2> viewpointBefore(const Surroundings& near, double robotRadius);

}  // namespace prodomos::prediction

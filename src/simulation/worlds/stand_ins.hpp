// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include "simulation/surface_tools.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace prodomos::simulation {

/// Where the front of a model is, since its mesh is not there to tell.
enum class Front {
  kX,         ///< its x-axis
  kMinusY,    ///< its y-axis reversed
  kXOffWall,  ///< along its x-axis, away from the nearer wall
  kOffWall    ///< along any of its axes, away from the nearest wall
};

enum class Posture { kNone, kStands, kSits };

/// What stands for a model of a world whose mesh is not there.
struct StandIn {
  std::string_view model;
  std::string_view kind;  ///< of thingKinds(); empty: a person alone
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  Front front = Front::kMinusY;
  double forward = 0.0;             ///< from the model's origin to the middle
  Posture person = Posture::kNone;  ///< who is there as well
  double personHeight = 1.72;
};

std::span<const StandIn> standIns();
const StandIn* findStandIn(std::string_view model);

/// Adds the thing or person to the building: on its storey's floor or, of kinds that hang, at the pose's height with
/// its back on the wall. `walls`: of the storey.
void addStandIn(const StandIn& standIn, int storey, const geometry::Pose3& T_world_model,
                const std::vector<Segment>& walls, Building& building);

/// What a room is called by the things in it: "WARD" where a bed stands; "ROOM" where nothing tells.
std::string_view labelByThings(const Building& building, int room);

}  // namespace prodomos::simulation
